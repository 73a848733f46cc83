// Baseline TIFF, written without a library: one page, one strip, uncompressed.
#ifndef EYEBOX_CAPTURE_RECORDING_GREY_TIFF_H_
#define EYEBOX_CAPTURE_RECORDING_GREY_TIFF_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "capture/base/image.h"

namespace eyebox::capture {

// 16-bit greyscale, black is zero, little-endian (TIFF 6.0, sections 2 and 4).
// Errors: InvalidArgument (no pixels, or more than 4 GiB of them).
absl::StatusOr<std::string> EncodeGreyTiff16(const FrameView& frame);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_GREY_TIFF_H_
