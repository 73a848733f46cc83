// What a V4L2 device delivers: pixel format, size, rate. Asked for, then compared with the answer.
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_FORMAT_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_FORMAT_H_

#include <cstddef>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "capture/camera/v4l2/v4l2_format.h"
#include "capture/camera/v4l2/v4l2_uri.h"
#include "capture/camera/v4l2/video_node.h"

namespace eyebox::capture {

struct VideoFormat {
  V4l2Format pixel;
  ImageSize size;
  size_t stride_bytes = 0;  // between the starts of two rows
  size_t image_bytes = 0;   // of which a whole frame consists at least
};

// The raw formats that the device offers itself (none that a library would emulate).
// Errors: Unavailable.
absl::StatusOr<std::vector<V4l2Format>> OfferedFormats(const VideoNode& node);

// The format of the options, else the offered one with the most bits, monochrome first; the size of
// the options, else the largest.
// Errors: InvalidArgument (not offered: lists what is), Unavailable (the driver answers with
// another format, size, with interlaced fields or rows that overlap: names both).
absl::StatusOr<VideoFormat> SetVideoFormat(const VideoNode& node, const V4l2Options& options);

// Frame intervals that the device offers for the format, s, ascending; a continuous range is given
// by its ends. Errors: Unavailable (it tells none: then nobody knows which frame saw a change).
struct FrameIntervals {
  std::vector<double> interval_s;
  bool continuous = false;
  double LongestS() const { return interval_s.back(); }
};
absl::StatusOr<FrameIntervals> OfferedIntervals(const VideoNode& node, const VideoFormat& format);

// Sets the shortest interval into which the exposure fits and returns what the driver made of it.
// Errors: InvalidArgument (none is long enough), Unavailable (it set a shorter one).
absl::StatusOr<double> SetFrameInterval(const VideoNode& node, const FrameIntervals& offered,
                                        double exposure_s);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_FORMAT_H_
