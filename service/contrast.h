// Contrast and veiling glare of a display, each with what the instrument itself allows to be seen.
#ifndef EYEBOX_SERVICE_CONTRAST_H_
#define EYEBOX_SERVICE_CONTRAST_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/scatter.pb.h"
#include "service/steps/glare_readings.h"
#include "service/watcher.h"

namespace eyebox::service {

struct ContrastRequest {
  std::filesystem::path recording;
  std::optional<std::string> series;
  // Scatter of the instrument, what `eyebox scatter --json` printed; empty: not known. Then the
  // floors count noise alone, and no checkerboard is corrected.
  std::filesystem::path scatter;
  GlareOptions glare;
};

// Full-field and checkerboard contrast and the glare in black spots, as far as the recording shows
// them. Errors: those of MeasureGlare and ReadKnownGlare; FailedPrecondition (it shows none).
absl::StatusOr<v1::ContrastResult> MeasureContrast(const ContrastRequest& request,
                                                   const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_CONTRAST_H_
