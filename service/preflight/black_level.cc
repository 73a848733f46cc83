#include "service/preflight/black_level.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

constexpr double kSigmaPerMad = 1.4826;

using Histogram = std::vector<size_t>;

Histogram HistogramOf(std::span<const uint16_t> counts_dn) {
  Histogram histogram(size_t{1} << 16);
  for (const uint16_t count : counts_dn) ++histogram[count];
  return histogram;
}

int Median(const Histogram& histogram, size_t total) {
  size_t below = 0;
  for (size_t count = 0; count < histogram.size(); ++count) {
    below += histogram[count];
    if (2 * below >= total) return static_cast<int>(count);
  }
  return 0;
}

// Half of the counts lie no farther from `centre` than this.
int MedianDistance(const Histogram& histogram, size_t total, int centre) {
  const auto last = static_cast<int>(histogram.size()) - 1;
  size_t within = histogram[static_cast<size_t>(centre)];
  int distance = 0;
  while (2 * within < total && distance < last) {
    ++distance;
    if (centre - distance >= 0) within += histogram[static_cast<size_t>(centre - distance)];
    if (centre + distance <= last) within += histogram[static_cast<size_t>(centre + distance)];
  }
  return distance;
}

struct Shape {
  double noise_dn = 0;
  double skewness = 0;
  double skewness_sigma = 0;
};

// Moments without hot and dead pixels.
Shape ShapeAround(const Histogram& histogram, int median, int reach) {
  const int first = std::max(median - reach, 0);
  const int last = std::min(median + reach, static_cast<int>(histogram.size()) - 1);
  double n = 0, mean = 0, second = 0, third = 0;
  const auto each = [&](auto visit) {
    for (int count = first; count <= last; ++count) {
      visit(static_cast<double>(count), static_cast<double>(histogram[static_cast<size_t>(count)]));
    }
  };
  each([&](double count, double pixels) { n += pixels, mean += pixels * count; });
  mean /= n;
  each([&](double count, double pixels) {
    second += pixels * std::pow(count - mean, 2);
    third += pixels * std::pow(count - mean, 3);
  });
  Shape shape;
  shape.noise_dn = std::sqrt(second / n);
  if (shape.noise_dn > 0) shape.skewness = third / n / std::pow(shape.noise_dn, 3);
  shape.skewness_sigma = std::sqrt(6 / n);
  return shape;
}

Check Judge(Check check, const Shape& shape, const BlackLevelOptions& options) {
  const char* remedy =
      "raise the black level (offset, brightness) until no dark pixel is at the wall, or switch "
      "off what subtracts it";
  if (check.measured->value > options.largest_share_at_zero) {
    return std::move(check).Failed(
        absl::StrFormat("the black level is clamped: %.3g %% of the dark pixels stand at 0",
                        100 * check.measured->value),
        remedy);
  }
  const bool lopsided = shape.skewness > options.largest_skewness + 3 * shape.skewness_sigma;
  if (shape.noise_dn >= options.least_noise_dn && lopsided) {
    return std::move(check).Failed(
        absl::StrFormat("the black level is clamped above 0: the noise of the dark is cut off on "
                        "its lower side (skewness %.2f)",
                        shape.skewness),
        remedy);
  }
  return check;
}

}  // namespace

Check CheckBlackLevel(std::span<const uint16_t> counts_dn, int significant_bits,
                      const BlackLevelOptions& options) {
  Check check = {.name = "black_level",
                 .wanted = absl::StrFormat("at most %g of the dark pixels at 0, symmetric noise",
                                           options.largest_share_at_zero),
                 .threshold = options.largest_share_at_zero};
  if (counts_dn.empty()) {
    return std::move(check).Failed("there is no dark frame", "cover the lens and take one");
  }
  const Histogram histogram = HistogramOf(counts_dn);
  const auto total = static_cast<double>(counts_dn.size());
  const double at_zero = static_cast<double>(histogram[0]) / total;
  const int median = Median(histogram, counts_dn.size());
  const int mad = MedianDistance(histogram, counts_dn.size(), median);
  const Shape shape =
      ShapeAround(histogram, median, std::max(static_cast<int>(6 * kSigmaPerMad * mad), 5));
  check.measured =
      Figure{"share_at_zero", at_zero, std::sqrt(at_zero * (1 - at_zero) / total), "1"};
  check.figures = {{"skewness", shape.skewness, shape.skewness_sigma, "1"},
                   {"noise", shape.noise_dn, 0, "DN"},
                   {"median", static_cast<double>(median), 0, "DN"}};
  const double full_scale_dn = std::pow(2, significant_bits) - 1;
  if (median > 0.5 * full_scale_dn) {
    return std::move(check).Failed(
        absl::StrFormat("the dark frames are not dark: their median is %d DN of %g", median,
                        full_scale_dn),
        "cover the lens, or lower the black level");
  }
  return Judge(std::move(check), shape, options);
}

}  // namespace eyebox::service
