// How light scatters: a glare series to w, what a photometer would read, and a figure of it.
#ifndef EYEBOX_SERVICE_SCATTER_H_
#define EYEBOX_SERVICE_SCATTER_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/scatter.pb.h"
#include "fit/scatter/fit_scatter.h"
#include "service/steps/glare_readings.h"
#include "service/watcher.h"

namespace eyebox::service {

struct ScatterRequest {
  ScatterRequest() { fit.find_reach = true; }

  // Each the folder of a recording, or a CSV of readings (see fit/scatter/glare_csv.h).
  std::filesystem::path source;
  std::optional<std::string> series;
  // The same series seen with the instrument alone, on a flat display. With it the fit is of the
  // headset's own glare.
  std::filesystem::path reference;
  std::optional<std::string> reference_series;
  fit::ScatterFitOptions fit;
  GlareOptions glare;
  bool joint = true;                // g of the bright field and w together, where there is one
  std::vector<double> predict_deg;  // diameters to predict; empty: over the field
  std::filesystem::path out;        // for scatter.json and scatter.svg, unless empty
};

// Errors: those of MeasureGlare, ReadGlareCsv, FitScatter and PredictReadings; the errno of the
// disk.
absl::StatusOr<v1::ScatterResult> MeasureScatter(const ScatterRequest& request,
                                                 const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SCATTER_H_
