// v4l2:/dev/videoN[?key=value[&key=value]...], for example
// v4l2:/dev/video0?format=Y12&size=1280x800&gain_db_per_step=0.1
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_URI_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_URI_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "capture/base/image.h"

namespace eyebox::capture {

struct V4l2Options {
  std::string uri;
  std::string path;                  // /dev/videoN
  std::string format;                // a name of V4l2Formats(); empty: the one with the most bits
  std::optional<ImageSize> size_px;  // empty: the largest
  // V4L2 gives gain no unit. From the camera's data sheet: dB per step of the gain control, counted
  // from its minimum. Empty: gain stays at the minimum, 0 dB by definition, and is not reported.
  std::optional<double> gain_db_per_step;
  // The value of the gamma control that means linear, where the driver does not define it.
  std::optional<int32_t> gamma;
};

// Errors: InvalidArgument (names the key and what it may be).
absl::StatusOr<V4l2Options> ParseV4l2Uri(std::string_view uri);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_URI_H_
