#include "service/steps/take_scatter_out.h"

#include <utility>

#include "capture/base/status.h"
#include "optics/scatter/remove_glare.h"
#include "service/results/scatter.h"
#include "service/steps/glare_readings.h"

namespace eyebox::service {

absl::StatusOr<KnownGlare> GlareOf(const ScatterChoice& choice,
                                   const capture::RecordingHeader& header) {
  if (choice.file.empty()) return std::nullopt;
  EYEBOX_ASSIGN_OR_RETURN(optics::KnownGlare glare, ReadKnownGlare(choice.file));
  EYEBOX_ASSIGN_OR_RETURN(glare.pitch_deg, PitchDeg(header));
  glare.surround = choice.surround;
  return glare;
}

absl::StatusOr<std::optional<optics::GlareRemovalFigures>> TakeScatterOut(
    const KnownGlare& glare, optics::ReducedLevel& level) {
  if (!glare) return std::nullopt;
  EYEBOX_ASSIGN_OR_RETURN(optics::GlareRemoval removal,
                          optics::RemoveGlare(level.luminance, *glare));
  level.luminance = std::move(removal.luminance);
  optics::VarianceBudget& budget = level.report.budget;
  const double rest = 1 - removal.figures.variance_share;
  for (double* term : {&budget.photon, &budget.read, &budget.quantisation, &budget.dark,
                       &budget.flat, &budget.linearity, &budget.scale}) {
    *term *= rest;
  }
  budget.scatter = removal.figures.variance_share;
  budget.scatter_common = removal.figures.common_share;
  return removal.figures;
}

}  // namespace eyebox::service
