// Views of a target, one after the other, from a folder of images or from a recording.
#ifndef EYEBOX_SERVICE_STEPS_VIEWS_H_
#define EYEBOX_SERVICE_STEPS_VIEWS_H_

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"

namespace eyebox::service {

using ViewVisitor = std::function<absl::Status(const std::string& source, const Image<double>&)>;

// Calls `visit` with every *.png, *.tif and *.tiff of a folder by name, or with the mean frame of
// every light capture of a recording's series (the main or only one unless given); counts in DN.
// Errors: NotFound (no such folder or series, no image in it), those of reading, the visitor's.
absl::Status VisitViews(const std::filesystem::path& source,
                        const std::optional<std::string>& series, const ViewVisitor& visit);

// One image. Errors: those of ReadGreyImage().
absl::StatusOr<Image<double>> ReadView(const std::filesystem::path& file);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_VIEWS_H_
