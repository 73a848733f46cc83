// The raw pixel formats of V4L2: counts of the sensor, neither compressed nor interpolated.
// Source: Linux kernel documentation, userspace-api/media/v4l, "Image formats".
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_FORMAT_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_FORMAT_H_

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "capture/base/pixel_format.h"

namespace eyebox::capture {

struct V4l2Format {
  uint32_t fourcc;
  std::string_view name;  // the four characters without trailing spaces
  int significant_bits;
  PixelPacking packing;
  BayerMosaic mosaic;
};

std::span<const V4l2Format> V4l2Formats();
// Null where the format is not one of them.
const V4l2Format* FindV4l2Format(uint32_t fourcc);
const V4l2Format* FindV4l2Format(std::string_view name);
// The characters of any fourcc, trailing spaces dropped.
std::string FourccName(uint32_t fourcc);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_FORMAT_H_
