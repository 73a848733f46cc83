#include "capture/recording/remaining.h"

#include <algorithm>
#include <vector>

namespace eyebox::capture {

CapturePlan RemainingCaptures(const CapturePlan& plan, std::span<const CaptureEntry> published) {
  std::vector<const CaptureEntry*> unclaimed;
  for (const CaptureEntry& capture : published) {
    const bool whole = capture.frame_count == capture.spec.repeats;
    if (whole && capture.suspect.empty()) unclaimed.push_back(&capture);
  }
  CapturePlan remaining;
  for (const CaptureSpec& spec : plan.captures) {
    const auto taken = std::ranges::find_if(
        unclaimed, [&spec](const CaptureEntry* capture) { return capture->spec == spec; });
    if (taken == unclaimed.end()) {
      remaining.captures.push_back(spec);
    } else {
      unclaimed.erase(taken);  // a plan may ask for the same twice
    }
  }
  return remaining;
}

}  // namespace eyebox::capture
