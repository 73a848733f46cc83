// Strict TIFF: a strip or tile that does not decode to its full length is an error. (OpenCV reads
// 8-bit TIFF by a call that goes on after errors and leaves the rest black.)
#ifndef EYEBOX_CAPTURE_BASE_TIFF_H_
#define EYEBOX_CAPTURE_BASE_TIFF_H_

#include <string>

#include "absl/status/statusor.h"
#include "capture/base/image_file.h"

namespace eyebox {

bool LooksLikeTiff(const std::string& bytes);

// Greyscale (black is zero), one sample of 8 or 16 bits, strips, one page; any compression that
// libtiff decodes without loss. Errors: InvalidArgument (another kind), DataLoss; name `file`.
absl::StatusOr<StillImage> DecodeTiff(const std::string& file, const std::string& bytes);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_TIFF_H_
