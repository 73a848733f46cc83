// Maps on disk: NPY version 1.0, little-endian float32, axes [y, x]; numpy.load() reads it.
#ifndef EYEBOX_CAPTURE_BASE_NPY_H_
#define EYEBOX_CAPTURE_BASE_NPY_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"

namespace eyebox {

// The whole file as bytes.
std::string EncodeNpy(const Image<float>& map);

// Reads what EncodeNpy wrote: any other dtype, order or rank is refused.
// Errors: NotFound, InvalidArgument (not such a file), DataLoss (shorter than its header says).
absl::StatusOr<Image<float>> ReadNpy(const std::filesystem::path& file);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_NPY_H_
