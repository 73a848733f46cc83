#include "optics/photometry/drift.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestReadings = 3;
constexpr size_t kFewestForCurve = 5;
constexpr double kHourS = 3600;

// t of 99.73 % by degrees of freedom, from 1 (GUM, table G.2).
constexpr std::array kStudent = {235.80, 19.21, 9.22, 6.62, 5.51, 4.90, 4.53, 4.28, 4.09, 3.96,
                                 3.85,   3.76,  3.69, 3.64, 3.59, 3.54, 3.51, 3.48, 3.45, 3.42};
constexpr double kStudentBeyond = 3.42;  // no less than any t of more degrees of freedom

double StudentFor(size_t degrees) {
  return degrees <= kStudent.size() ? kStudent.at(degrees - 1) : kStudentBeyond;
}

absl::Status CheckReadings(std::span<const DriftReading> readings) {
  if (readings.size() < kFewestReadings) {
    return BadInput("drift", absl::StrCat("has ", readings.size(), " readings"),
                    "read the reference patch 3 times or more");
  }
  for (size_t i = 0; i < readings.size(); ++i) {
    const DriftReading& reading = readings[i];
    if (std::isfinite(reading.time_s) && reading.value > 0 && std::isfinite(reading.value) &&
        reading.sigma > 0 && std::isfinite(reading.sigma)) {
      continue;
    }
    return BadInput(
        absl::StrCat("drift, reading ", i + 1),
        absl::StrCat("is ", reading.value, " +- ", reading.sigma, " at ", reading.time_s, " s"),
        "give finite times, values and sigmas above 0");
  }
  return absl::OkStatus();
}

struct TimeAxis {
  double middle_s = 0;
  double half_span_s = 0;
};

absl::StatusOr<TimeAxis> AxisOf(std::span<const DriftReading> readings) {
  const auto [first, last] = std::ranges::minmax_element(readings, {}, &DriftReading::time_s);
  const double half_span_s = 0.5 * (last->time_s - first->time_s);
  if (half_span_s <= 0) {
    return BadInput("drift", "all readings are of one time", "spread them over the recording");
  }
  double sum_s = 0;  // from the first, lest large times lose digits
  for (const DriftReading& reading : readings) sum_s += reading.time_s - first->time_s;
  return TimeAxis{first->time_s + sum_s / static_cast<double>(readings.size()), half_span_s};
}

// b[0] + b[1] x + ...
struct Polynomial {
  Eigen::VectorXd b;
  Eigen::MatrixXd covariance;
  double reduced_chi2 = 0;
  bool borne_out = false;
};

Polynomial FitPolynomial(std::span<const DriftReading> readings, const TimeAxis& axis, int order) {
  const auto rows = static_cast<Eigen::Index>(readings.size());
  Eigen::MatrixXd design(rows, order + 1);
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const DriftReading& reading = readings[static_cast<size_t>(i)];
    const double x = (reading.time_s - axis.middle_s) / axis.half_span_s;
    for (int k = 0; k <= order; ++k) design(i, k) = std::pow(x, k) / reading.sigma;
    values(i) = reading.value / reading.sigma;
  }
  const Eigen::MatrixXd inverse = (design.transpose() * design).inverse();
  Polynomial fit;
  fit.b = design.colPivHouseholderQr().solve(values);
  const size_t degrees = readings.size() - static_cast<size_t>(order) - 1;
  fit.reduced_chi2 = (design * fit.b - values).squaredNorm() / static_cast<double>(degrees);
  fit.covariance = inverse * std::max(fit.reduced_chi2, 1.0);
  fit.borne_out =
      std::abs(fit.b(order)) > StudentFor(degrees) * std::sqrt(fit.covariance(order, order));
  return fit;
}

void TakeOver(const Polynomial& fit, int order, Drift& drift) {
  const double level = fit.b(0);
  drift.order = order;
  drift.reduced_chi2 = fit.reduced_chi2;
  drift.linear = fit.b(1) / level;
  drift.linear_variance = fit.covariance(1, 1) / (level * level);
  if (order < 2) return;
  drift.quadratic = fit.b(2) / level;
  drift.quadratic_variance = fit.covariance(2, 2) / (level * level);
  drift.covariance = fit.covariance(1, 2) / (level * level);
}

}  // namespace

double Drift::FactorAt(double time_s) const {
  const double x = (time_s - middle_s) / half_span_s;
  return 1 + x * (linear + x * quadratic);
}

double Drift::SigmaAt(double time_s) const {
  if (order == 0) return 0;
  const double x = (time_s - middle_s) / half_span_s;
  return std::sqrt(
      std::max(x * x * (linear_variance + 2 * x * covariance + x * x * quadratic_variance), 0.0));
}

double Drift::Span() const {
  double lowest = 1;
  double highest = 1;
  for (int i = -20; i <= 20; ++i) {
    const double factor = FactorAt(middle_s + i / 20.0 * half_span_s);
    lowest = std::min(lowest, factor);
    highest = std::max(highest, factor);
  }
  return highest - lowest;
}

absl::StatusOr<Drift> FitDrift(std::span<const DriftReading> readings) {
  EYEBOX_RETURN_IF_ERROR(CheckReadings(readings));
  EYEBOX_ASSIGN_OR_RETURN(const TimeAxis axis, AxisOf(readings));
  Drift drift;
  drift.middle_s = axis.middle_s;
  drift.half_span_s = axis.half_span_s;
  drift.readings = static_cast<int>(readings.size());
  const Polynomial line = FitPolynomial(readings, axis, 1);
  TakeOver(line, 1, drift);
  drift.per_hour = drift.linear / axis.half_span_s * kHourS;
  drift.per_hour_sigma = std::sqrt(drift.linear_variance) / axis.half_span_s * kHourS;
  if (readings.size() >= kFewestForCurve) {
    const Polynomial curve = FitPolynomial(readings, axis, 2);
    if (curve.borne_out) {
      TakeOver(curve, 2, drift);
      return drift;
    }
  }
  if (line.borne_out) return drift;
  drift.order = 0;
  drift.linear = 0;
  return drift;
}

void CorrectDrift(const Drift& drift, double time_s, LuminanceImage& image) {
  if (drift.order == 0) return;
  const double factor = drift.FactorAt(time_s);
  const auto inverse = static_cast<float>(1 / factor);
  for (float& value : image.image.value.pixels()) value *= inverse;
  for (float& variance : image.image.variance.pixels()) variance *= inverse * inverse;
  const double relative_sigma = drift.SigmaAt(time_s) / factor;
  image.scale_relative_sigma = std::hypot(image.scale_relative_sigma, relative_sigma);
  image.image.history.push_back(
      absl::StrFormat("CorrectDrift(order %d, factor %.6g, relative sigma %.2g)", drift.order,
                      factor, relative_sigma));
}

}  // namespace eyebox::optics
