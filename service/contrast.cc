#include "service/contrast.h"

#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "service/results/scatter.h"
#include "service/steps/calibrate.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

absl::StatusOr<MeasuredGlare> Measure(const ContrastRequest& request,
                                      const std::optional<optics::KnownGlare>& instrument,
                                      const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const auto recording, capture::RecordingReader::Open(request.recording));
  EYEBOX_ASSIGN_OR_RETURN(const optics::Calibration calibration,
                          CalibrateCamera(*recording, watcher.Part(0, 0.5)));
  return MeasureGlare(*recording, request.series, calibration, request.glare, instrument,
                      watcher.Part(0.5, 1));
}

}  // namespace

absl::StatusOr<v1::ContrastResult> MeasureContrast(const ContrastRequest& request,
                                                   const Watcher& watcher) {
  std::optional<optics::KnownGlare> instrument;
  bool alone = false;
  if (!request.scatter.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(instrument, ReadKnownGlare(request.scatter));
    EYEBOX_ASSIGN_OR_RETURN(alone, IsOfInstrumentAlone(request.scatter));
  }
  const auto glare = Measure(request, instrument, watcher);
  if (!glare.ok()) return Within(request.recording, glare.status());
  v1::ContrastResult result;
  AddGlareFigures(*glare, *result.mutable_figures());
  if (result.figures().empty()) {
    return Rejected(request.recording.string(), "it shows neither contrast nor glare",
                    "record with --checkerboards or --black-disks, which bring the full fields");
  }
  result.set_luminance_unit(glare->series.luminance_unit);
  result.set_source(glare->series.source);
  result.mutable_warnings()->Add(glare->warnings.begin(), glare->warnings.end());
  if (!instrument) {
    result.add_warnings(
        "the instrument's scatter is not known: it is part of every contrast and glare here; "
        "measure it on a flat display (eyebox scatter) and give it as --scatter");
  }
  if (instrument && !alone) {
    result.add_warnings(
        "the scatter that was taken out was fitted without a reference: if a headset stood before "
        "the camera then, its own glare is taken out too");
  }
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

}  // namespace eyebox::service
