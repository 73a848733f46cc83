#include "capture/trigger/match_edges.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

absl::Status CheckAscending(std::span<const int64_t> times_ns, const char* where) {
  for (size_t i = 1; i < times_ns.size(); ++i) {
    if (times_ns[i] > times_ns[i - 1]) continue;
    return BadInput(std::string(where) + " " + std::to_string(i),
                    "is not later than the one before", "give them in order of time");
  }
  return absl::OkStatus();
}

absl::Status CheckWindow(std::span<const int64_t> expected_ns, const MatchWindow& window) {
  if (window.latest_ns < window.earliest_ns) {
    return BadInput("MatchWindow", "ends before it begins", "give the earlier time first");
  }
  const int64_t length_ns = window.latest_ns - window.earliest_ns;
  for (size_t i = 1; i < expected_ns.size(); ++i) {
    if (expected_ns[i] - expected_ns[i - 1] > length_ns) continue;
    return BadInput("MatchWindow",
                    "of " + std::to_string(length_ns) + " ns is no shorter than the distance of " +
                        "expected times " + std::to_string(i - 1) + " and " + std::to_string(i),
                    "give a shorter window");
  }
  return absl::OkStatus();
}

void MeasureDelay(std::span<const int64_t> expected_ns, std::span<const int64_t> edges_ns,
                  EdgeMatch& match) {
  std::vector<double> delays_ns;
  for (size_t i = 0; i < expected_ns.size(); ++i) {
    if (!match.edge_of[i]) continue;
    delays_ns.push_back(static_cast<double>(edges_ns[*match.edge_of[i]] - expected_ns[i]));
  }
  if (delays_ns.empty()) return;
  const auto count = static_cast<double>(delays_ns.size());
  for (const double delay_ns : delays_ns) match.mean_delay_ns += delay_ns / count;
  double sum = 0;
  for (const double delay_ns : delays_ns) sum += std::pow(delay_ns - match.mean_delay_ns, 2);
  match.delay_sigma_ns = std::sqrt(sum / std::max(count - 1, 1.0));
}

std::string First(std::span<const size_t> numbers) {
  constexpr size_t kShown = 5;
  std::string text;
  for (size_t i = 0; i < std::min(numbers.size(), kShown); ++i) {
    text.append(i == 0 ? "" : ", ").append(std::to_string(numbers[i]));
  }
  return numbers.size() > kShown ? text + ", ..." : text;
}

}  // namespace

absl::StatusOr<EdgeMatch> MatchEdges(std::span<const int64_t> expected_ns,
                                     std::span<const int64_t> edges_ns, const MatchWindow& window) {
  EYEBOX_RETURN_IF_ERROR(CheckAscending(expected_ns, "expected time"));
  EYEBOX_RETURN_IF_ERROR(CheckAscending(edges_ns, "edge"));
  EYEBOX_RETURN_IF_ERROR(CheckWindow(expected_ns, window));
  EdgeMatch match;
  size_t next = 0;
  for (size_t i = 0; i < expected_ns.size(); ++i) {
    while (next < edges_ns.size() && edges_ns[next] < expected_ns[i] + window.earliest_ns) {
      match.unexpected.push_back(next++);
    }
    const bool found =
        next < edges_ns.size() && edges_ns[next] <= expected_ns[i] + window.latest_ns;
    match.edge_of.push_back(found ? std::optional<size_t>(next++) : std::nullopt);
    if (!found) match.lost.push_back(i);
  }
  while (next < edges_ns.size()) match.unexpected.push_back(next++);
  MeasureDelay(expected_ns, edges_ns, match);
  return match;
}

absl::Status CheckComplete(const EdgeMatch& match, std::string_view what) {
  if (match.lost.empty() && match.unexpected.empty()) return absl::OkStatus();
  std::string found;
  if (!match.lost.empty()) {
    found = std::to_string(match.lost.size()) + " of " + std::to_string(match.edge_of.size()) +
            " were lost (" + First(match.lost) + ")";
  }
  if (!match.unexpected.empty()) {
    found += (found.empty() ? "" : " and ") + std::to_string(match.unexpected.size()) +
             " edges belong to none (" + First(match.unexpected) + ")";
  }
  return Corrupt(what, found, "lower the rate, or check the wiring for bouncing edges");
}

}  // namespace eyebox::capture
