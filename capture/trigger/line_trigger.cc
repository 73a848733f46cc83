#include "capture/trigger/line_trigger.h"

#include <thread>
#include <utility>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

class LineTrigger final : public Trigger {
 public:
  LineTrigger(std::string uri, std::unique_ptr<OutputLine> line, const Clock* clock)
      : uri_(std::move(uri)), line_(std::move(line)), clock_(clock) {}

  absl::StatusOr<Pulse> Fire(std::chrono::nanoseconds width) override {
    if (width <= std::chrono::nanoseconds(0) || width > std::chrono::seconds(1)) {
      return BadInput(uri_ + ", width of the pulse", "is " + std::to_string(width.count()) + " ns",
                      "give one above 0, up to 1 s");
    }
    Pulse pulse = {.number = fired_};
    EYEBOX_ASSIGN_OR_RETURN(pulse.on, Switch(true));
    std::this_thread::sleep_for(width);
    EYEBOX_ASSIGN_OR_RETURN(pulse.off, Switch(false));
    ++fired_;
    return pulse;
  }

 private:
  absl::StatusOr<SwitchTime> Switch(bool on) {
    SwitchTime time = {.before_ns = clock_->MonotonicNs()};
    EYEBOX_RETURN_IF_ERROR(line_->Set(on));
    time.after_ns = clock_->MonotonicNs();
    return time;
  }

  const std::string uri_;
  const std::unique_ptr<OutputLine> line_;
  const Clock* const clock_;
  uint64_t fired_ = 0;
};

}  // namespace

std::unique_ptr<Trigger> MakeLineTrigger(std::string uri, std::unique_ptr<OutputLine> line,
                                         const Clock* clock) {
  return std::make_unique<LineTrigger>(std::move(uri), std::move(line), clock);
}

}  // namespace eyebox::capture
