// What an interrupted recording still lacks of its plan.
#ifndef EYEBOX_CAPTURE_RECORDING_REMAINING_H_
#define EYEBOX_CAPTURE_RECORDING_REMAINING_H_

#include <span>

#include "capture/base/capture_spec.h"
#include "capture/recording/reader.h"

namespace eyebox::capture {

// The captures of `plan` without a published one of equal specification and full length that is not
// suspect, in the order of the plan. A capture that stopped early is taken again whole, so that its
// frames stand close together in time; the frames that it has stay in the recording.
CapturePlan RemainingCaptures(const CapturePlan& plan, std::span<const CaptureEntry> published);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_REMAINING_H_
