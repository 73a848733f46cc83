#include "service/preflight/fisher_test.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eyebox::service {

SpectralPeak LargestPeak(std::span<const double> powers) {
  SpectralPeak peak;
  if (powers.size() < 2) return peak;
  const double sum = std::accumulate(powers.begin(), powers.end(), 0.0);
  if (!(sum > 0) || !std::isfinite(sum)) return peak;
  const auto largest = std::max_element(powers.begin(), powers.end());
  const auto n = static_cast<double>(powers.size());
  peak.index = static_cast<size_t>(largest - powers.begin());
  peak.share = *largest / sum;
  peak.false_alarm_probability = std::min(1.0, n * std::pow(std::max(1 - peak.share, 0.0), n - 1));
  return peak;
}

double ShareAt(double false_alarm_probability, size_t n) {
  const auto count = static_cast<double>(n);
  return 1 - std::pow(false_alarm_probability / count, 1 / (count - 1));
}

}  // namespace eyebox::service
