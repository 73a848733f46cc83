#include "capture/base/status.h"
#include "capture/trigger/line.h"
#include "capture/trigger/line_trigger.h"
#include "capture/trigger/trigger.h"

namespace eyebox::capture {

absl::StatusOr<LineAddress> ParseLineUri(const std::string& uri) {
  const size_t colon = uri.find(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == uri.size()) {
    return BadInput("trigger '" + uri + "'", "does not name chip and line",
                    "give one like gpiochip0:17 or sim:NAME");
  }
  LineAddress address = {.chip = uri.substr(0, colon), .line = uri.substr(colon + 1)};
  if (address.chip == "sim") {
    address.chip.clear();
  } else if (!address.chip.starts_with("gpiochip")) {
    return BadInput("trigger '" + uri + "'", "has no scheme that is known here",
                    "start it with gpiochipN: or sim:");
  }
  return address;
}

absl::StatusOr<std::unique_ptr<Trigger>> OpenTrigger(const std::string& uri, const Clock* clock,
                                                     bool active_low) {
  EYEBOX_ASSIGN_OR_RETURN(const LineAddress address, ParseLineUri(uri));
  if (address.chip.empty()) {
    return MakeLineTrigger(uri, OpenSimOutput(address.line, clock), clock);
  }
  EYEBOX_ASSIGN_OR_RETURN(auto line, OpenGpioOutput(address, active_low));
  return MakeLineTrigger(uri, std::move(line), clock);
}

absl::StatusOr<std::unique_ptr<EdgeSource>> OpenEdgeSource(const std::string& uri, EdgeKind kind,
                                                           const Clock* clock, bool active_low) {
  EYEBOX_ASSIGN_OR_RETURN(const LineAddress address, ParseLineUri(uri));
  if (address.chip.empty()) {
    return MakeEdgeReader(uri, OpenSimInput(address.line, kind), kind, clock);
  }
  EYEBOX_ASSIGN_OR_RETURN(auto line, OpenGpioInput(address, kind, active_low));
  return MakeEdgeReader(uri, std::move(line), kind, clock);
}

}  // namespace eyebox::capture
