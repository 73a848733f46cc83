// Files beside a result: written whole or not at all, named with their SHA-256.
#ifndef EYEBOX_SERVICE_ARTIFACTS_H_
#define EYEBOX_SERVICE_ARTIFACTS_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "eyebox/v1/results.pb.h"

namespace eyebox::service {

// Lower-case hexadecimal.
std::string Sha256(std::string_view bytes);

// Describes `map` and, if `folder` is not empty, writes folder/file as NPY.
absl::StatusOr<v1::MapFile> WriteMap(const std::filesystem::path& folder, std::string_view file,
                                     std::string_view name, std::string_view unit,
                                     const Image<float>& map);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_ARTIFACTS_H_
