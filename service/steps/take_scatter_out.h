// Takes the camera's known scatter out of a level.
#ifndef EYEBOX_SERVICE_STEPS_TAKE_SCATTER_OUT_H_
#define EYEBOX_SERVICE_STEPS_TAKE_SCATTER_OUT_H_

#include <filesystem>
#include <optional>

#include "absl/status/statusor.h"
#include "capture/recording/header.h"
#include "optics/reduce/reduce_level.h"
#include "optics/scatter/known_glare.h"

namespace eyebox::service {

struct ScatterChoice {
  std::filesystem::path file;  // what `eyebox scatter --json` printed; empty: none is taken out
  optics::Surround surround = optics::Surround::kUnknown;
};

using KnownGlare = std::optional<optics::KnownGlare>;  // none: scatter stays in

// Errors: those of ReadKnownGlare and PitchDeg.
absl::StatusOr<KnownGlare> GlareOf(const ScatterChoice& choice,
                                   const capture::RecordingHeader& header);

// The budget of the level counts what that adds to the variance. Errors: those of
// optics::RemoveGlare.
absl::StatusOr<std::optional<optics::GlareRemovalFigures>> TakeScatterOut(
    const KnownGlare& glare, optics::ReducedLevel& level);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_TAKE_SCATTER_OUT_H_
