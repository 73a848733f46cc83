#include "optics/photometry/photodiode_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestReadings = 4;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool LogOfCounts(PhotodiodeAxes axes) { return axes == PhotodiodeAxes::kLogLog; }
bool LogOfLuminance(PhotodiodeAxes axes) { return axes != PhotodiodeAxes::kLinear; }

double Onto(bool logarithmic, double value) { return logarithmic ? std::log(value) : value; }
double From(bool logarithmic, double value) { return logarithmic ? std::exp(value) : value; }

struct Knots {
  std::vector<double> counts, luminance_cd_m2;
};

// By rising luminance, counts brought into order; what is pooled becomes one knot.
Knots Pool(std::vector<ScaleReading> readings, bool falls) {
  std::ranges::sort(readings, {}, &ScaleReading::luminance_cd_m2);
  const bool weighted = std::ranges::all_of(readings, [](auto& r) { return r.reading_sigma > 0; });
  std::vector<double> counts;
  std::vector<double> weight;
  for (const ScaleReading& r : readings) {
    counts.push_back(falls ? -r.reading : r.reading);
    weight.push_back(weighted ? 1 / (r.reading_sigma * r.reading_sigma) : 1);
  }
  const std::vector<double> ordered = Isotonic(counts, weight);
  Knots knots;
  for (size_t i = 0; i < ordered.size();) {
    size_t end = i;
    double sum = 0;
    double weights = 0;
    for (; end < ordered.size() && ordered[end] == ordered[i]; ++end) {
      sum += weight[end] * readings[end].luminance_cd_m2;
      weights += weight[end];
    }
    const double luminance = sum / weights;
    // Two readings of one luminance that stayed apart in counts are one knot too.
    if (!knots.counts.empty() && !(luminance > knots.luminance_cd_m2.back())) {
      knots.counts.back() = (knots.counts.back() + (falls ? -ordered[i] : ordered[i])) / 2;
    } else {
      knots.counts.push_back(falls ? -ordered[i] : ordered[i]);
      knots.luminance_cd_m2.push_back(luminance);
    }
    i = end;
  }
  if (falls) {
    std::ranges::reverse(knots.counts);
    std::ranges::reverse(knots.luminance_cd_m2);
  }
  return knots;
}

struct LeftOut {
  std::vector<double> relative;
  double rms = std::numeric_limits<double>::infinity();
};

absl::StatusOr<LeftOut> LeaveOneOut(PhotodiodeAxes axes, const Knots& knots) {
  LeftOut left{std::vector<double>(knots.counts.size(), kNaN)};
  double sum = 0;
  int tried = 0;
  for (size_t i = 1; i + 1 < knots.counts.size(); ++i) {
    if (!(knots.luminance_cd_m2[i] > 0)) continue;
    Knots others = knots;
    others.counts.erase(others.counts.begin() + static_cast<std::ptrdiff_t>(i));
    others.luminance_cd_m2.erase(others.luminance_cd_m2.begin() + static_cast<std::ptrdiff_t>(i));
    EYEBOX_ASSIGN_OR_RETURN(const PhotodiodeScale scale,
                            PhotodiodeScale::Through(axes, others.counts, others.luminance_cd_m2));
    EYEBOX_ASSIGN_OR_RETURN(const double luminance, scale.LuminanceOf(knots.counts[i]));
    left.relative[i] = luminance / knots.luminance_cd_m2[i] - 1;
    sum += left.relative[i] * left.relative[i];
    ++tried;
  }
  if (tried > 0) left.rms = std::sqrt(sum / tried);
  return left;
}

absl::Status Check(std::span<const ScaleReading> readings, double meter_relative_sigma) {
  if (readings.size() < kFewestReadings) {
    return BadInput("photodiode", absl::StrCat(readings.size(), " readings"),
                    "give at least 4 known luminances, better 3 a decade");
  }
  if (!(meter_relative_sigma >= 0 && meter_relative_sigma < 1)) {
    return BadInput("meter", absl::StrCat("relative sigma ", meter_relative_sigma),
                    "give its relative standard uncertainty, at least 0 and below 1");
  }
  for (size_t i = 0; i < readings.size(); ++i) {
    const ScaleReading& r = readings[i];
    if (!std::isfinite(r.luminance_cd_m2 + r.reading + r.reading_sigma) || r.luminance_cd_m2 < 0 ||
        r.reading_sigma < 0) {
      return BadInput(absl::StrCat("reading ", i + 1), "is not finite, or below 0",
                      "give a luminance of at least 0, counts and their sigma");
    }
  }
  return absl::OkStatus();
}

// Whether counts fall as luminance rises: the sign of their covariance by rank.
bool Falls(std::span<const ScaleReading> readings) {
  int sign = 0;
  for (const ScaleReading& a : readings) {
    for (const ScaleReading& b : readings) {
      if (a.luminance_cd_m2 < b.luminance_cd_m2) sign += a.reading < b.reading ? 1 : -1;
    }
  }
  return sign < 0;
}

}  // namespace

const char* NameOf(PhotodiodeAxes axes) {
  switch (axes) {
    case PhotodiodeAxes::kLinear:
      return "linear";
    case PhotodiodeAxes::kLogLog:
      return "log_log";
    case PhotodiodeAxes::kLinearLog:
      return "linear_log";
  }
  return "unknown";
}

absl::StatusOr<PhotodiodeScale> PhotodiodeScale::Through(PhotodiodeAxes axes,
                                                         std::span<const double> counts,
                                                         std::span<const double> luminance_cd_m2) {
  if (counts.size() < 2 || counts.size() != luminance_cd_m2.size()) {
    return BadInput("photodiode scale",
                    absl::StrCat(counts.size(), " counts, ", luminance_cd_m2.size(), " luminances"),
                    "give at least 2 of both");
  }
  const bool falls = luminance_cd_m2.back() < luminance_cd_m2.front();
  std::vector<double> x;
  std::vector<double> y;
  for (size_t i = 0; i < counts.size(); ++i) {
    if ((LogOfCounts(axes) && !(counts[i] > 0)) ||
        (LogOfLuminance(axes) && !(luminance_cd_m2[i] > 0))) {
      return BadInput("photodiode scale", absl::StrCat("knot ", i + 1, " has no logarithm"),
                      "use linear axes");
    }
    x.push_back(Onto(LogOfCounts(axes), counts[i]));
    y.push_back((falls ? -1 : 1) * Onto(LogOfLuminance(axes), luminance_cd_m2[i]));
  }
  EYEBOX_ASSIGN_OR_RETURN(MonotoneCurve curve, MonotoneCurve::Through(std::move(x), std::move(y)));
  PhotodiodeScale scale(axes, falls, std::move(curve));
  scale.counts_.assign(counts.begin(), counts.end());
  scale.luminance_cd_m2_.assign(luminance_cd_m2.begin(), luminance_cd_m2.end());
  return scale;
}

absl::StatusOr<double> PhotodiodeScale::LuminanceOf(double counts) const {
  // The logarithm must not push the outermost knots out of the range.
  if (counts == counts_.front()) return luminance_cd_m2_.front();
  if (counts == counts_.back()) return luminance_cd_m2_.back();
  const auto y = curve_.At(Onto(LogOfCounts(axes_), counts));
  if (!y) {
    return absl::OutOfRangeError(Complaint(
        absl::StrCat("photodiode reading ", counts),
        absl::StrCat("outside the calibrated ", counts_.front(), " to ", counts_.back(), " counts"),
        "calibrate over the whole range that is measured"));
  }
  return From(LogOfLuminance(axes_), falls_ ? -*y : *y);
}

absl::StatusOr<double> PhotodiodeScale::CountsOf(double luminance_cd_m2) const {
  if (luminance_cd_m2 == luminance_cd_m2_.front()) return counts_.front();
  if (luminance_cd_m2 == luminance_cd_m2_.back()) return counts_.back();
  const double y = Onto(LogOfLuminance(axes_), luminance_cd_m2);
  const auto x = curve_.InverseAt(falls_ ? -y : y);
  if (!x) {
    const auto [low, high] = std::ranges::minmax(luminance_cd_m2_);
    return absl::OutOfRangeError(
        Complaint(absl::StrCat("luminance ", luminance_cd_m2, " cd/m2"),
                  absl::StrCat("outside the calibrated ", low, " to ", high, " cd/m2"),
                  "calibrate over the whole range that is measured"));
  }
  return From(LogOfCounts(axes_), *x);
}

absl::StatusOr<PhotodiodeFit> FitPhotodiode(std::span<const ScaleReading> readings,
                                            double meter_relative_sigma) {
  EYEBOX_RETURN_IF_ERROR(Check(readings, meter_relative_sigma));
  const Knots knots = Pool({readings.begin(), readings.end()}, Falls(readings));
  const size_t pooled = readings.size() - knots.counts.size();
  if (2 * pooled > readings.size()) {
    return Rejected(
        "photodiode", absl::StrCat(pooled, " of ", readings.size(), " readings are out of order"),
        "counts do not follow luminance: check the wiring, the range, the ambient light");
  }
  if (knots.counts.size() < kFewestReadings) {
    return BadInput("photodiode", absl::StrCat(knots.counts.size(), " readings that differ"),
                    "give at least 4 known luminances that are told apart");
  }
  std::optional<PhotodiodeAxes> best;
  LeftOut least;
  for (const auto axes :
       {PhotodiodeAxes::kLinear, PhotodiodeAxes::kLogLog, PhotodiodeAxes::kLinearLog}) {
    const auto left = LeaveOneOut(axes, knots);
    if (!left.ok() || !(left->rms < least.rms)) continue;
    // With an end that has no logarithm the others may still have had one.
    if (!PhotodiodeScale::Through(axes, knots.counts, knots.luminance_cd_m2).ok()) continue;
    best = axes;
    least = *left;
  }
  if (!best) {
    return BadInput("photodiode", "no inner reading has a luminance above 0",
                    "give more known luminances");
  }
  EYEBOX_ASSIGN_OR_RETURN(PhotodiodeScale scale,
                          PhotodiodeScale::Through(*best, knots.counts, knots.luminance_cd_m2));
  PhotodiodeFit fit{.scale = std::move(scale),
                    .leave_one_out_rms_relative = least.rms,
                    .relative_sigma = std::hypot(least.rms, meter_relative_sigma),
                    .pooled = static_cast<int>(pooled),
                    .leave_one_out_relative = std::move(least.relative)};
  if (pooled > 0) {
    fit.warnings.push_back(
        absl::StrCat(pooled, " of ", readings.size(),
                     " readings were out of order, or of one luminance, and were "
                     "pooled with their neighbours"));
  }
  return fit;
}

}  // namespace eyebox::optics
