// How often stated 95 % intervals cover the truth, row by row.
#ifndef EYEBOX_TESTS_TOOLS_COVERAGE_COVERAGE_TABLE_H_
#define EYEBOX_TESTS_TOOLS_COVERAGE_COVERAGE_TABLE_H_

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace eyebox {

inline constexpr double kInterval = 1.959964;  // standard deviations on either side

// The mean over a recording's own samples counts once: what they share makes them cover together.
struct CoverageRow {
  double recordings = 0;
  double share = 0;
  double share_square = 0;
  double pull_sum = 0;
  double pull_square = 0;
  double samples = 0;
  int without = 0;  // recordings for which no interval is stated

  // (value - truth) / sigma.
  void Add(const std::vector<double>& pulls);
  double Mean() const { return share / recordings; }
  double StandardError() const;
};

using CoverageTable = std::map<std::string, CoverageRow>;

// Prints it. False where a row lies further from 95 % than 2 % and chance (3 standard errors)
// allow.
bool PrintCoverage(const CoverageTable& table);

}  // namespace eyebox

#endif  // EYEBOX_TESTS_TOOLS_COVERAGE_COVERAGE_TABLE_H_
