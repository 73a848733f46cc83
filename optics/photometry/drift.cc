#include "optics/photometry/drift.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

// Degrees of freedom that a straight line leaves.
constexpr size_t kFewestForLine = 1;
constexpr size_t kFewestForCurve = 3;
constexpr double kHourS = 3600;

// t of 99.73 % by degrees of freedom, from 1 (GUM, table G.2).
constexpr std::array kStudent = {235.80, 19.21, 9.22, 6.62, 5.51, 4.90, 4.53, 4.28, 4.09, 3.96,
                                 3.85,   3.76,  3.69, 3.64, 3.59, 3.54, 3.51, 3.48, 3.45, 3.42};
constexpr double kStudentBeyond = 3.42;  // no less than any t of more degrees of freedom

double StudentFor(size_t degrees) {
  return degrees <= kStudent.size() ? kStudent.at(degrees - 1) : kStudentBeyond;
}

// Readings less a level for each series and a slope.
size_t DegreesOfLine(std::span<const DriftReading> readings) {
  std::set<int> series;
  for (const DriftReading& reading : readings) series.insert(reading.series);
  return readings.size() < series.size() + 1 ? 0 : readings.size() - series.size() - 1;
}

absl::Status CheckReadings(std::span<const DriftReading> readings) {
  if (DegreesOfLine(readings) < kFewestForLine) {
    return BadInput("drift", absl::StrCat("has ", readings.size(), " readings"),
                    "read one and the same patch 3 times or more");
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
  double first_s = 0;
  double middle_s = 0;
  double half_span_s = 0;
};

bool IsReadAtTwoTimes(std::span<const DriftReading> readings) {
  std::map<int, double> first_s;
  return std::ranges::any_of(readings, [&](const DriftReading& reading) {
    return first_s.try_emplace(reading.series, reading.time_s).first->second != reading.time_s;
  });
}

absl::StatusOr<TimeAxis> AxisOf(std::span<const DriftReading> readings) {
  const auto [first, last] = std::ranges::minmax_element(readings, {}, &DriftReading::time_s);
  const double half_span_s = 0.5 * (last->time_s - first->time_s);
  if (!IsReadAtTwoTimes(readings)) {
    return BadInput("drift", "all readings of a patch are of one time",
                    "spread them over the recording");
  }
  double sum_s = 0;  // from the first, lest large times lose digits
  for (const DriftReading& reading : readings) sum_s += reading.time_s - first->time_s;
  return TimeAxis{first->time_s, first->time_s + sum_s / static_cast<double>(readings.size()),
                  half_span_s};
}

// factor(x) = 1 + c[0] x + ..., with a level for every series.
struct Polynomial {
  Eigen::VectorXd c;
  Eigen::MatrixXd covariance;  // of c
  double reduced_chi2 = 0;
  bool borne_out = false;
};

// The series' levels enter as the factors by which they depart from their weighted means, so that
// all columns of the design are of one magnitude whatever the units.
class SeriesFit {
 public:
  SeriesFit(std::span<const DriftReading> readings, const TimeAxis& axis, int order)
      : readings_(readings), order_(order) {
    for (const DriftReading& reading : readings) {
      x_.push_back((reading.time_s - axis.middle_s) / axis.half_span_s);
      levels_[reading.series] = {};
    }
    for (const DriftReading& reading : readings) {
      Level& level = levels_[reading.series];
      const double weight = 1 / (reading.sigma * reading.sigma);
      level.sum += weight * reading.value;
      level.weight += weight;
    }
    int column = 0;
    for (auto& [series, level] : levels_) level.column = column++;
    parameters_ = Eigen::VectorXd::Ones(column + order);
    parameters_.tail(order).setZero();
  }

  // Gauss-Newton: the model is a product, hence nearly linear.
  Polynomial Solve() {
    constexpr int kMostSteps = 50;
    constexpr double kSmallStep = 1e-13;
    for (int i = 0; i < kMostSteps; ++i) {
      Linearise();
      const Eigen::VectorXd step = design_.colPivHouseholderQr().solve(residuals_);
      parameters_ += step;
      if (step.lpNorm<Eigen::Infinity>() < kSmallStep) break;
    }
    Linearise();
    Polynomial fit;
    fit.c = parameters_.tail(order_);
    const size_t degrees = readings_.size() - static_cast<size_t>(parameters_.size());
    fit.reduced_chi2 = residuals_.squaredNorm() / static_cast<double>(degrees);
    const Eigen::MatrixXd inverse = (design_.transpose() * design_).inverse();
    fit.covariance = inverse.bottomRightCorner(order_, order_) * std::max(fit.reduced_chi2, 1.0);
    const Eigen::Index last = order_ - 1;
    fit.borne_out =
        std::abs(fit.c(last)) > StudentFor(degrees) * std::sqrt(fit.covariance(last, last));
    return fit;
  }

 private:
  struct Level {
    double sum = 0;
    double weight = 0;
    Eigen::Index column = 0;
  };

  void Linearise() {
    const auto rows = static_cast<Eigen::Index>(readings_.size());
    design_ = Eigen::MatrixXd::Zero(rows, parameters_.size());
    residuals_.resize(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const DriftReading& reading = readings_[static_cast<size_t>(i)];
      const Level& level = levels_.at(reading.series);
      const double mean = level.sum / level.weight / reading.sigma;
      const double x = x_[static_cast<size_t>(i)];
      double factor = 1;
      for (int k = 0; k < order_; ++k) {
        const double power = std::pow(x, k + 1);
        factor += parameters_(parameters_.size() - order_ + k) * power;
        design_(i, parameters_.size() - order_ + k) = mean * parameters_(level.column) * power;
      }
      design_(i, level.column) = mean * factor;
      residuals_(i) = reading.value / reading.sigma - mean * parameters_(level.column) * factor;
    }
  }

  std::span<const DriftReading> readings_;
  int order_;
  std::vector<double> x_;
  std::map<int, Level> levels_;
  Eigen::VectorXd parameters_;  // levels, then coefficients
  Eigen::MatrixXd design_;
  Eigen::VectorXd residuals_;
};

Polynomial FitPolynomial(std::span<const DriftReading> readings, const TimeAxis& axis, int order) {
  return SeriesFit(readings, axis, order).Solve();
}

void TakeOver(const Polynomial& fit, int order, Drift& drift) {
  drift.order = order;
  drift.reduced_chi2 = fit.reduced_chi2;
  drift.linear = fit.c(0);
  drift.linear_variance = fit.covariance(0, 0);
  if (order < 2) return;
  drift.quadratic = fit.c(1);
  drift.quadratic_variance = fit.covariance(1, 1);
  drift.covariance = fit.covariance(0, 1);
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
  drift.first_s = axis.first_s;
  drift.middle_s = axis.middle_s;
  drift.half_span_s = axis.half_span_s;
  drift.readings = static_cast<int>(readings.size());
  const Polynomial line = FitPolynomial(readings, axis, 1);
  TakeOver(line, 1, drift);
  drift.per_hour = drift.linear / axis.half_span_s * kHourS;
  drift.per_hour_sigma = std::sqrt(drift.linear_variance) / axis.half_span_s * kHourS;
  if (DegreesOfLine(readings) >= kFewestForCurve) {
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
  for (float& sigma : image.scatter_sigma.pixels()) sigma *= inverse;
  const double relative_sigma = drift.SigmaAt(time_s) / factor;
  image.scale_relative_sigma = std::hypot(image.scale_relative_sigma, relative_sigma);
  image.image.history.push_back(
      absl::StrFormat("CorrectDrift(order %d, factor %.6g, relative sigma %.2g)", drift.order,
                      factor, relative_sigma));
}

}  // namespace eyebox::optics
