#include "fit/cube/proportionality.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

constexpr double kFalseAlarms = 0.01;

absl::Status CheckReadings(std::span<const RenderedReading> readings, const std::string& source) {
  if (readings.empty()) return BadInput(source, "holds no reading", "measure some");
  const size_t inputs = readings.front().rendered.size();
  for (size_t i = 0; i < readings.size(); ++i) {
    const RenderedReading& reading = readings[i];
    const std::string where = absl::StrCat(source, ", reading ", i + 1);
    if (reading.rendered.size() != inputs) {
      return BadInput(where, "has another number of inputs than the first", "give each the same");
    }
    const auto finite = [](double value) { return std::isfinite(value); };
    if (!std::ranges::all_of(reading.rendered, finite) || !finite(reading.luminance) ||
        !(reading.luminance_sigma >= 0) || !finite(reading.luminance_sigma)) {
      return BadInput(where, "is not finite or has a negative uncertainty", "measure it again");
    }
  }
  if (readings.size() > inputs) return absl::OkStatus();
  return Rejected(source,
                  absl::StrCat("holds ", readings.size(), " readings for ", inputs,
                               " slopes and nothing to see a departure by"),
                  "measure more stimuli");
}

// Quantile of |normal| that is exceeded with `probability`.
double TwoSidedQuantile(double probability) {
  double low = 0;
  double high = 40;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (std::erfc(middle / std::sqrt(2.0)) > probability ? low : high) = middle;
  }
  return low;
}

}  // namespace

absl::StatusOr<LineThroughOrigin> FitLineThroughOrigin(std::span<const RenderedReading> readings,
                                                       const std::string& source) {
  EYEBOX_RETURN_IF_ERROR(CheckReadings(readings, source));
  const auto count = static_cast<Eigen::Index>(readings.size());
  const auto inputs = static_cast<Eigen::Index>(readings.front().rendered.size());
  Eigen::MatrixXd rendered(count, inputs);
  Eigen::VectorXd luminance(count);
  Eigen::VectorXd variance(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const RenderedReading& reading = readings[static_cast<size_t>(i)];
    for (Eigen::Index k = 0; k < inputs; ++k) rendered(i, k) = reading.rendered[k];
    luminance(i) = reading.luminance;
    variance(i) = reading.luminance_sigma * reading.luminance_sigma;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition(rendered);
  if (decomposition.rank() < inputs) {
    return Rejected(source, "some input is never rendered apart from the others",
                    "measure each primary alone as well");
  }
  const double largest = luminance.maxCoeff();
  if (!(largest > 0)) return Rejected(source, "shows no light", "check display and instrument");
  const Eigen::MatrixXd solve = decomposition.solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::MatrixXd residual = Eigen::MatrixXd::Identity(count, count) - rendered * solve;
  const Eigen::VectorXd slopes = solve * luminance;
  const Eigen::VectorXd slope_variance = solve.cwiseAbs2() * variance;
  const Eigen::VectorXd departure_variance = residual.cwiseAbs2() * variance;
  const Eigen::VectorXd line = rendered * slopes;
  LineThroughOrigin result;
  for (Eigen::Index k = 0; k < inputs; ++k) {
    result.slopes.push_back(slopes(k));
    result.slope_sigmas.push_back(std::sqrt(slope_variance(k)));
  }
  double squares = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double departure = luminance(i) - line(i);
    const LineDeparture point{line(i), line(i) > 0 ? departure / line(i) : 0, departure / largest,
                              std::sqrt(departure_variance(i)) / largest};
    squares += point.departure_of_maximum * point.departure_of_maximum;
    result.worst_of_value = std::max(result.worst_of_value, std::abs(point.departure_of_value));
    if (std::abs(point.departure_of_maximum) > result.worst_of_maximum) {
      result.worst_of_maximum = std::abs(point.departure_of_maximum);
      result.worst_of_maximum_sigma = point.departure_of_maximum_sigma;
    }
    result.departures.push_back(point);
  }
  result.rms_of_maximum = std::sqrt(squares / static_cast<double>(count));
  return result;
}

Judgement JudgeProportional(std::span<const JudgedReading> readings, size_t family) {
  Judgement judgement;
  judgement.coverage_factor =
      TwoSidedQuantile(kFalseAlarms / static_cast<double>(std::max<size_t>(family, 1)));
  // A slope is possible for a reading between L (1 -+ noise) / (x (1 +- allowed)).
  double slope_from = 0;
  double slope_to = std::numeric_limits<double>::infinity();
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (size_t i = 0; i < readings.size(); ++i) {
    const JudgedReading& reading = readings[i];
    const double noise = judgement.coverage_factor * reading.luminance_sigma;
    const double least = (reading.luminance - noise) / (reading.x * (1 + reading.allowed));
    const double most = (reading.luminance + noise) / (reading.x * (1 - reading.allowed));
    if (least > slope_from) {
      slope_from = least;
      judgement.highest = i;
    }
    if (most < slope_to) {
      slope_to = most;
      judgement.lowest = i;
    }
    smallest = std::min(smallest, reading.luminance / reading.x);
    largest = std::max(largest, reading.luminance / reading.x);
  }
  judgement.passes = slope_from <= slope_to;
  judgement.proportionality_error =
      largest + smallest > 0 ? (largest - smallest) / (largest + smallest) : 0;
  return judgement;
}

}  // namespace eyebox::fit
