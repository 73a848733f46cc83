// Whether a frame counts: complete, the next one, taken with what was asked for.
#ifndef EYEBOX_CAPTURE_RUN_FRAME_CHECK_H_
#define EYEBOX_CAPTURE_RUN_FRAME_CHECK_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "capture/base/capture_spec.h"
#include "capture/base/frame.h"
#include "capture/camera/camera.h"

namespace eyebox::capture {

// Aborted means throughout capture/run: this attempt is spoilt, another one may succeed.
absl::Status Spoilt(const std::string& what);

// `tolerance`: largest |reported / asked - 1| of an exposure.
// Errors: Aborted (names the frame and what is wrong with it).
absl::Status CheckFrame(const FrameMetadata& metadata, const CaptureSpec& spec,
                        std::optional<uint64_t> previous_id, double tolerance);

// What the camera read back after Configure(). Errors: Unavailable (it cannot hold what was asked).
absl::Status CheckReadBack(const CameraSettings& asked, const CameraSettings& set,
                           const std::string& uri, double tolerance);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_FRAME_CHECK_H_
