// w and what follows from it, as a message, and back.
#ifndef EYEBOX_SERVICE_RESULTS_SCATTER_H_
#define EYEBOX_SERVICE_RESULTS_SCATTER_H_

#include <filesystem>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/scatter.pb.h"
#include "fit/scatter/fit_scatter.h"
#include "fit/scatter/predict_readings.h"
#include "optics/scatter/known_glare.h"
#include "service/steps/glare_readings.h"

namespace eyebox::service {

v1::ScatterKernel ToProto(const fit::KnownScatter& scatter, double glare_relative_sigma);

struct ScatterFindings {
  const fit::ScatterFit& fit;
  const fit::GlareSeries& series;
  const std::optional<fit::ScatterFit>& instrument;
  const std::vector<fit::PredictedReading>& predicted;
};
v1::ScatterResult DescribeScatter(const ScatterFindings& findings);

// Those that the recording held the stimuli for.
void AddGlareFigures(const MeasuredGlare& glare,
                     google::protobuf::RepeatedPtrField<v1::GlareFigure>& figures);

// scatter_removed_share, scatter_floor_median, scatter_below_floor_share among the parameters.
void AddScatterRemoval(const optics::GlareRemovalFigures& figures, v1::ReduceResult& result);

// Whether the kernel that ReadKnownGlare() takes was told apart from the headset's by a reference
// series. Errors: those of reading.
absl::StatusOr<bool> IsOfInstrumentAlone(const std::filesystem::path& file);

// The kernel to take out of a camera's images, from what `eyebox scatter --json` printed: the
// instrument's where a reference told it, else that of headset and instrument together.
// `pitch_deg` and `surround` are left to the caller.
// Errors: NotFound, InvalidArgument (not a ScatterResult, no kernel, names the field).
absl::StatusOr<optics::KnownGlare> ReadKnownGlare(const std::filesystem::path& file);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_SCATTER_H_
