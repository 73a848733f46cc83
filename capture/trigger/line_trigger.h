// Pulses and edges over a line, whatever it is.
#ifndef EYEBOX_CAPTURE_TRIGGER_LINE_TRIGGER_H_
#define EYEBOX_CAPTURE_TRIGGER_LINE_TRIGGER_H_

#include <memory>
#include <string>

#include "capture/trigger/line.h"
#include "capture/trigger/trigger.h"

namespace eyebox::capture {

std::unique_ptr<Trigger> MakeLineTrigger(std::string uri, std::unique_ptr<OutputLine> line,
                                         const Clock* clock);

// Starts the thread that drains the line. At most 2^20 edges wait; then Take() fails.
std::unique_ptr<EdgeSource> MakeEdgeReader(std::string uri, std::unique_ptr<InputLine> line,
                                           EdgeKind kind, const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_TRIGGER_LINE_TRIGGER_H_
