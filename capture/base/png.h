// Strict PNG by libpng itself: samples as stored, no gamma, no conversion, nothing of a damaged
// file.
#ifndef EYEBOX_CAPTURE_BASE_PNG_H_
#define EYEBOX_CAPTURE_BASE_PNG_H_

#include <string>

#include "absl/status/statusor.h"
#include "capture/base/image_file.h"

namespace eyebox {

bool LooksLikePng(const std::string& bytes);

// Greyscale, 8 or 16 bits, no palette, no transparency.
// Errors: InvalidArgument (another kind), DataLoss (truncated or damaged); name `file`.
absl::StatusOr<StillImage> DecodeGreyPng(const std::string& file, const std::string& bytes);

// RGB, 8 bits, no palette, no transparency. Errors: as DecodeGreyPng.
absl::StatusOr<Image<Rgb8>> DecodeRgbPng(const std::string& file, const std::string& bytes);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_PNG_H_
