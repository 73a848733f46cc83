#include "capture/base/image_file.h"

#include "capture/base/file.h"
#include "capture/base/png.h"
#include "capture/base/status.h"
#include "capture/base/tiff.h"

namespace eyebox {
namespace {

constexpr size_t kLargestFile = size_t{1} << 30;

}  // namespace

absl::StatusOr<StillImage> ReadGreyImage(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, kLargestFile));
  if (LooksLikeTiff(bytes)) return DecodeTiff(file.string(), bytes);
  if (LooksLikePng(bytes)) return DecodeGreyPng(file.string(), bytes);
  return BadInput(file.string(), "is neither TIFF nor PNG",
                  "give frames as 8- or 16-bit greyscale TIFF or PNG");
}

absl::Status WritePng(const std::filesystem::path& file, const Image<Rgb8>& image) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, EncodePng(image));
  return WriteFileAtomically(file, bytes);
}

absl::StatusOr<Image<Rgb8>> ReadPngRgb8(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, kLargestFile));
  if (LooksLikePng(bytes)) return DecodeRgbPng(file.string(), bytes);
  return BadInput(file.string(), "is not a PNG", "give an 8-bit RGB PNG");
}

}  // namespace eyebox
