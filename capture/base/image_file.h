// Still images on disk, decoded by libtiff and libpng: counts as stored, or an error.
#ifndef EYEBOX_CAPTURE_BASE_IMAGE_FILE_H_
#define EYEBOX_CAPTURE_BASE_IMAGE_FILE_H_

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"

namespace eyebox {

struct StillImage {
  Image<uint16_t> pixels_dn;  // single channel; 8-bit files are widened, never rescaled
  int bits_per_sample = 0;    // 8 or 16, as stored in the file
};

// Reads a single-channel 8- or 16-bit TIFF or PNG without conversion.
// Errors: NotFound (no such file), InvalidArgument (not TIFF/PNG, colour, other depth),
// DataLoss (truncated or damaged); each names the file.
absl::StatusOr<StillImage> ReadGreyImage(const std::filesystem::path& file);

using Rgb8 = std::array<uint8_t, 3>;

// Writes an 8-bit RGB PNG, through a temporary file and a rename. Errors: the errno of the file
// system.
absl::Status WritePng(const std::filesystem::path& file, const Image<Rgb8>& image);
// The same bytes in memory. Errors: Internal (the encoder refused).
absl::StatusOr<std::string> EncodePng(const Image<Rgb8>& image);
absl::StatusOr<Image<Rgb8>> ReadPngRgb8(const std::filesystem::path& file);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_IMAGE_FILE_H_
