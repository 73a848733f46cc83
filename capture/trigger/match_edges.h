// Which edge belongs to which pulse or frame, and which are missing: the kernel's queue of edges
// drops silently, so that only comparison shows a loss.
#ifndef EYEBOX_CAPTURE_TRIGGER_MATCH_EDGES_H_
#define EYEBOX_CAPTURE_TRIGGER_MATCH_EDGES_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::capture {

// An edge belongs to an expected time if it comes this much later (may be negative).
struct MatchWindow {
  int64_t earliest_ns = 0;
  int64_t latest_ns = 1'000'000;
};

struct EdgeMatch {
  std::vector<std::optional<size_t>> edge_of;  // one for each expected time: index of its edge
  std::vector<size_t> lost;                    // expected times without an edge
  std::vector<size_t> unexpected;              // edges without an expected time, repeats included
  // Of edge minus expected, over what matched; 0 where nothing did.
  double mean_delay_ns = 0;
  double delay_sigma_ns = 0;  // of one delay
};

// Both series ascend, nanoseconds of one clock. Of several edges in a window the first is taken.
// Errors: InvalidArgument (a series does not ascend, the window is empty or as long as the shortest
// distance between expected times, so that edges could belong to either).
absl::StatusOr<EdgeMatch> MatchEdges(std::span<const int64_t> expected_ns,
                                     std::span<const int64_t> edges_ns, const MatchWindow& window);

// OK if nothing is lost and nothing unexpected; else DataLoss that counts and names the first ones.
// `what` is what was expected, like "strobe of frame".
absl::Status CheckComplete(const EdgeMatch& match, std::string_view what);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_TRIGGER_MATCH_EDGES_H_
