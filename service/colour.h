// The steps for colour: a series of tristimulus values is fitted, a table made from the fit.
#ifndef EYEBOX_SERVICE_COLOUR_H_
#define EYEBOX_SERVICE_COLOUR_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "eyebox/v1/color.pb.h"
#include "fit/color/colour_table.h"
#include "fit/color/fit_colour.h"

namespace eyebox::service {

// Errors: those of ReadColourSeriesCsv and ChooseColour.
absl::StatusOr<v1::ColourResult> FitColourCsv(const std::filesystem::path& file,
                                              const fit::ColourOptions& options);

// True if `json` is a ColourResult rather than another result of a fit.
bool IsColourFit(std::string_view json);

struct ColourCubeRequest {
  v1::ColourResult fit;
  std::string fit_source;  // where it came from, for messages
  fit::TableTarget target = fit::TableTarget::kHdrp;
  int size = 32;
  std::filesystem::path out;
  fit::ColourTableOptions design;
};
// Designs, certifies and writes `out`. Errors: NotFound, InvalidArgument, FailedPrecondition (a
// white point that cannot be shown), the errno of the disk.
absl::StatusOr<v1::ColourCubeResult> DesignColourCube(const ColourCubeRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_COLOUR_H_
