#include "service/scatter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "fit/scatter/fit_with_field.h"
#include "fit/scatter/glare_csv.h"
#include "fit/scatter/predict_readings.h"
#include "service/report/glare_figure.h"
#include "service/result_json.h"
#include "service/results/scatter.h"
#include "service/steps/calibrate.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

constexpr int kPredictedPatches = 40;
constexpr double kSmallestPatch = 0.5;  // of the core's radius
constexpr double kNotedMisfit = 3;      // reduced chi-square

bool IsRecording(const std::filesystem::path& source) {
  return std::filesystem::is_directory(source);
}

absl::StatusOr<MeasuredGlare> ReadTable(const std::filesystem::path& file,
                                        const GlareOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_ASSIGN_OR_RETURN(fit::GlareTable table, fit::ReadGlareCsv(file, options.field_radius_deg));
  MeasuredGlare glare;
  glare.series = std::move(table.series);
  glare.warnings = std::move(table.warnings);
  return glare;
}

absl::StatusOr<MeasuredGlare> ReadRecording(const std::filesystem::path& folder,
                                            const std::optional<std::string>& series,
                                            const GlareOptions& options,
                                            const std::optional<optics::KnownGlare>& instrument,
                                            const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const auto recording, capture::RecordingReader::Open(folder));
  const auto measure = [&]() -> absl::StatusOr<MeasuredGlare> {
    EYEBOX_ASSIGN_OR_RETURN(const optics::Calibration calibration,
                            CalibrateCamera(*recording, watcher.Part(0, 0.5)));
    return MeasureGlare(*recording, series, calibration, options, instrument, watcher.Part(0.5, 1));
  };
  auto glare = measure();
  if (!glare.ok()) return Within(folder, glare.status());
  return glare;
}

absl::StatusOr<MeasuredGlare> Read(const std::filesystem::path& source,
                                   const std::optional<std::string>& series,
                                   const GlareOptions& options,
                                   const std::optional<optics::KnownGlare>& instrument,
                                   const Watcher& watcher) {
  if (!IsRecording(source)) return ReadTable(source, options);
  return ReadRecording(source, series, options, instrument, watcher);
}

// Jointly with g where the bright field was recorded. With an instrument taken apart, g is that of
// the field as it was read: its own glare is the headset's and the instrument's together.
absl::StatusOr<fit::ScatterFit> Fit(const MeasuredGlare& glare, const ScatterRequest& request,
                                    const fit::ScatterFitOptions& options) {
  if (!request.joint || !glare.bright_field) return fit::FitScatter(glare.series, options);
  fit::FieldFitOptions joint;
  joint.fit = options;
  if (options.instrument) joint.most_rounds = 1;
  const fit::BrightField field{*glare.bright_field, glare.aim.axis, glare.aim.pitch_deg,
                               request.glare.reading.spot_radius_px, request.glare.surround};
  EYEBOX_ASSIGN_OR_RETURN(fit::FieldFit fitted,
                          fit::FitScatterWithField(glare.series, field, joint));
  fitted.fit.termination += absl::StrCat("; g and w settled in ", fitted.rounds, " rounds",
                                         fitted.settled ? "" : " (the most allowed)");
  return std::move(fitted.fit);
}

// Even steps of the logarithm, from within the core to the field.
std::vector<double> PatchesOver(const fit::ScatterFit& fit, double field_radius_deg) {
  const double first = kSmallestPatch * fit.kernel.core_radius_deg;
  const double last = 2 * field_radius_deg;
  std::vector<double> diameters;
  for (int i = 0; i < kPredictedPatches; ++i) {
    diameters.push_back(first * std::pow(last / first, (i + 0.5) / kPredictedPatches));
  }
  return diameters;
}

report::GlareFigureInput FigureOf(const v1::ScatterResult& result) {
  report::GlareFigureInput figure;
  figure.luminance_unit = result.luminance_unit();
  for (const v1::FittedGlareReading& reading : result.readings()) {
    if (reading.pattern() != "disk" || !(reading.diameter_deg() > 0)) continue;
    figure.readings.push_back({reading.diameter_deg(), reading.offset_deg(), reading.luminance(),
                               reading.luminance_sigma()});
  }
  for (const v1::PredictedPatch& patch : result.predicted()) {
    figure.curve.push_back({patch.diameter_deg(), patch.reading(), patch.reading_sigma()});
  }
  return figure;
}

// The covariance was widened by the misfit, but what lies beyond the readings can be off by more.
void WarnOfMisfit(const fit::ScatterFit& fit, v1::ScatterResult& result) {
  const double reduced = fit.chi_square / std::max(fit.degrees_of_freedom, 1);
  if (reduced <= kNotedMisfit) return;
  result.add_warnings(absl::StrFormat(
      "w does not follow the readings (reduced chi-square %.3g): its sigmas were widened, yet what "
      "is taken out of other scenes may be off by more; try another --tail, --pedestal or "
      "--reach-deg",
      reduced));
}

absl::Status Write(const std::filesystem::path& out, v1::ScatterResult& result) {
  if (out.empty()) return absl::OkStatus();
  result.set_figure_file("scatter.svg");
  EYEBOX_RETURN_IF_ERROR(
      WriteFileAtomically(out / "scatter.svg", report::DrawGlareAlone(FigureOf(result))));
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(result));
  return WriteFileAtomically(out / "scatter.json", json);
}

}  // namespace

absl::StatusOr<v1::ScatterResult> MeasureScatter(const ScatterRequest& request,
                                                 const Watcher& watcher) {
  ScatterRequest asked = request;
  std::vector<std::string> warnings;
  std::optional<fit::ScatterFit> instrument;
  if (!request.reference.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(const MeasuredGlare flat,
                            Read(request.reference, request.reference_series, request.glare,
                                 std::nullopt, watcher.Part(0, 0.4)));
    EYEBOX_ASSIGN_OR_RETURN(instrument, Fit(flat, request, request.fit));
    asked.fit.instrument = instrument->AsInstrument();
    warnings.insert(warnings.end(), flat.warnings.begin(), flat.warnings.end());
  }
  std::optional<optics::KnownGlare> known;
  if (instrument) known = {instrument->kernel, instrument->glare_relative_sigma};
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredGlare glare,
                          Read(request.source, request.series, request.glare, known,
                               watcher.Part(instrument ? 0.4 : 0, 0.8)));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.8, "fitting w"));
  EYEBOX_ASSIGN_OR_RETURN(const fit::ScatterFit fit, Fit(glare, asked, asked.fit));
  const double field_radius_deg = glare.series.field_radius_deg;
  EYEBOX_ASSIGN_OR_RETURN(
      const auto predicted,
      fit::PredictReadings(
          fit, asked.fit, field_radius_deg,
          request.predict_deg.empty() ? PatchesOver(fit, field_radius_deg) : request.predict_deg));
  v1::ScatterResult result = DescribeScatter({fit, glare.series, instrument, predicted});
  AddGlareFigures(glare, *result.mutable_figures());
  warnings.insert(warnings.end(), glare.warnings.begin(), glare.warnings.end());
  if (!instrument) {
    warnings.emplace_back(
        "w is of headset and instrument together: record the series on a flat display too and give "
        "it as --reference to tell them apart");
  }
  result.mutable_warnings()->Add(warnings.begin(), warnings.end());
  WarnOfMisfit(fit, result);
  EYEBOX_RETURN_IF_ERROR(Write(request.out, result));
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

}  // namespace eyebox::service
