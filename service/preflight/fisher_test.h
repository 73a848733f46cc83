// Whether the largest of some spectral powers is more than noise.
#ifndef EYEBOX_SERVICE_PREFLIGHT_FISHER_TEST_H_
#define EYEBOX_SERVICE_PREFLIGHT_FISHER_TEST_H_

#include <cstddef>
#include <span>

namespace eyebox::service {

struct SpectralPeak {
  size_t index = 0;  // of the largest power
  double share = 0;  // of the sum of all
  // Bound of the probability that white Gaussian noise of any variance gives this share or more:
  // n (1 - share)^(n - 1), the first term of Fisher's series (Proc. R. Soc. A 125, 1929), at
  // most 1.
  double false_alarm_probability = 1;
};

// Powers >= 0 of independent frequencies. Fewer than 2, or none above 0, are never a peak.
SpectralPeak LargestPeak(std::span<const double> powers);

// The share at which the probability is `false_alarm_probability`, for n >= 2 powers.
double ShareAt(double false_alarm_probability, size_t n);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_FISHER_TEST_H_
