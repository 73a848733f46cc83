// The only file that knows libgpiod (1.6; 2.x has another API).
#include <gpiod.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <utility>

#include "capture/base/status.h"
#include "capture/trigger/line.h"

namespace eyebox::capture {
namespace {

constexpr char kConsumer[] = "eyebox";

struct ChipCloser {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }  // releases its lines too
};
using Chip = std::unique_ptr<gpiod_chip, ChipCloser>;

std::string NameOf(const LineAddress& address) { return address.chip + ":" + address.line; }

absl::Status Failed(const LineAddress& address, int error_number) {
  return DeviceFailed(NameOf(address), std::strerror(error_number),
                      error_number == EBUSY ? "close the program that uses the line (see gpioinfo)"
                                            : "check that you may use /dev/gpiochip*");
}

struct OpenLine {
  Chip chip;
  gpiod_line* line = nullptr;  // belongs to the chip
};

absl::StatusOr<OpenLine> Find(const LineAddress& address) {
  OpenLine open;
  open.chip.reset(gpiod_chip_open_lookup(address.chip.c_str()));
  if (open.chip == nullptr && errno == ENOENT) {
    return Missing("GPIO chip '" + address.chip + "'", "is not there", "list them with gpiodetect");
  }
  if (open.chip == nullptr) return Failed(address, errno);
  unsigned offset = 0;
  const char* const end = address.line.data() + address.line.size();
  const auto [rest, error] = std::from_chars(address.line.data(), end, offset);
  const bool is_number = error == std::errc() && rest == end;
  open.line = is_number ? gpiod_chip_get_line(open.chip.get(), offset)
                        : gpiod_chip_find_line(open.chip.get(), address.line.c_str());
  if (open.line == nullptr) {
    return Missing("GPIO line " + NameOf(address), "is not there", "list them with gpioinfo");
  }
  return open;
}

int FlagsOf(bool active_low) { return active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0; }

class GpioOutput final : public OutputLine {
 public:
  GpioOutput(LineAddress address, OpenLine open)
      : address_(std::move(address)), open_(std::move(open)) {}
  ~GpioOutput() override { gpiod_line_set_value(open_.line, 0); }

  absl::Status Set(bool on) override {
    if (gpiod_line_set_value(open_.line, on ? 1 : 0) == 0) return absl::OkStatus();
    return Failed(address_, errno);
  }

 private:
  const LineAddress address_;
  OpenLine open_;
};

class GpioInput final : public InputLine {
 public:
  GpioInput(LineAddress address, OpenLine open)
      : address_(std::move(address)), open_(std::move(open)) {}

  absl::StatusOr<std::vector<Edge>> Read(std::chrono::milliseconds timeout) override {
    const timespec wait = {.tv_sec = timeout.count() / 1000,
                           .tv_nsec = timeout.count() % 1000 * 1'000'000};
    const int ready = gpiod_line_event_wait(open_.line, &wait);
    if (ready < 0 && errno != EINTR) return Failed(address_, errno);
    if (ready <= 0) return std::vector<Edge>();
    std::array<gpiod_line_event, kKernelQueue> events;
    const int count = gpiod_line_event_read_multiple(open_.line, events.data(), events.size());
    if (count < 0) return Failed(address_, errno);
    std::vector<Edge> edges;
    for (int i = 0; i < count; ++i) {
      const gpiod_line_event& event = events[i];
      edges.push_back({.monotonic_ns = int64_t{event.ts.tv_sec} * 1'000'000'000 + event.ts.tv_nsec,
                       .rising = event.event_type == GPIOD_LINE_EVENT_RISING_EDGE});
    }
    return edges;
  }

 private:
  const LineAddress address_;
  OpenLine open_;
};

int RequestTypeOf(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::kRising:
      return GPIOD_LINE_REQUEST_EVENT_RISING_EDGE;
    case EdgeKind::kFalling:
      return GPIOD_LINE_REQUEST_EVENT_FALLING_EDGE;
    case EdgeKind::kBoth:
      break;
  }
  return GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES;
}

}  // namespace

absl::StatusOr<std::unique_ptr<OutputLine>> OpenGpioOutput(const LineAddress& address,
                                                           bool active_low) {
  EYEBOX_ASSIGN_OR_RETURN(OpenLine open, Find(address));
  if (gpiod_line_request_output_flags(open.line, kConsumer, FlagsOf(active_low), 0) != 0) {
    return Failed(address, errno);
  }
  return std::make_unique<GpioOutput>(address, std::move(open));
}

absl::StatusOr<std::unique_ptr<InputLine>> OpenGpioInput(const LineAddress& address, EdgeKind kind,
                                                         bool active_low) {
  EYEBOX_ASSIGN_OR_RETURN(OpenLine open, Find(address));
  const gpiod_line_request_config request = {
      .consumer = kConsumer, .request_type = RequestTypeOf(kind), .flags = FlagsOf(active_low)};
  if (gpiod_line_request(open.line, &request, 0) != 0) return Failed(address, errno);
  return std::make_unique<GpioInput>(address, std::move(open));
}

}  // namespace eyebox::capture
