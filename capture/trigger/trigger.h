// A pulse out that starts the ADC and, wired, the camera; edges in from a camera's strobe output or
// a display's vsync. All times are CLOCK_MONOTONIC.
#ifndef EYEBOX_CAPTURE_TRIGGER_TRIGGER_H_
#define EYEBOX_CAPTURE_TRIGGER_TRIGGER_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"

namespace eyebox::capture {

// The line changed at some time between `before_ns` and `after_ns`.
struct SwitchTime {
  int64_t before_ns = 0;
  int64_t after_ns = 0;
};

struct Pulse {
  uint64_t number = 0;  // from 0, counted since opening
  SwitchTime on = {};
  SwitchTime off = {};
};

// Not thread-safe.
class Trigger {
 public:
  virtual ~Trigger() = default;
  // Switches the line on, waits, and switches it off again: `width` is the least, the scheduler may
  // add to it. Errors: InvalidArgument (width not above 0 or above 1 s), Unavailable.
  virtual absl::StatusOr<Pulse> Fire(std::chrono::nanoseconds width) = 0;
};

struct Edge {
  int64_t monotonic_ns = 0;  // when the kernel handled the interrupt
  bool rising = true;
  friend bool operator==(const Edge&, const Edge&) = default;
};

enum class EdgeKind { kRising, kFalling, kBoth };

// Drained by a thread of its own from opening on. Not thread-safe itself.
class EdgeSource {
 public:
  virtual ~EdgeSource() = default;

  struct Edges {
    std::vector<Edge> edges;  // in order; those since the last call
    // The kernel queues 16 edges and drops silently what comes then. How often one edge followed
    // another of its own direction (kBoth only), so that one was lost between, and how often the
    // queue was found full. That both are 0 proves nothing: MatchEdges() with what must have come
    // does.
    uint64_t known_losses = 0;
    uint64_t full_queues = 0;
  };
  // Waits until there is one, or `timeout` has passed: then there are none.
  // Errors: Unavailable (the chip is gone, its clock is not CLOCK_MONOTONIC).
  virtual absl::StatusOr<Edges> Take(std::chrono::milliseconds timeout) = 0;
};

// "gpiochipN:LINE" (LINE a number or a name) or "sim:NAME", which leads from every Trigger to every
// EdgeSource of this name in this process. `active_low`: the pulse is a low one; edges are
// inverted. `clock` must outlive what is opened and be thread-safe. Errors: InvalidArgument (no
// such scheme), NotFound (chip, line), Unavailable (line in use).
absl::StatusOr<std::unique_ptr<Trigger>> OpenTrigger(const std::string& uri, const Clock* clock,
                                                     bool active_low = false);
absl::StatusOr<std::unique_ptr<EdgeSource>> OpenEdgeSource(const std::string& uri, EdgeKind kind,
                                                           const Clock* clock,
                                                           bool active_low = false);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_TRIGGER_TRIGGER_H_
