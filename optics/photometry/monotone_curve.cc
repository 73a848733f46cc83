#include "optics/photometry/monotone_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

// One-sided slope at an end from three points, held to what keeps the piece monotone.
double EndSlope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  return std::clamp(slope, 0.0, 3 * d0);
}

std::vector<double> Slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const size_t n = x.size();
  std::vector<double> step;
  std::vector<double> secant;
  for (size_t i = 0; i + 1 < n; ++i) {
    step.push_back(x[i + 1] - x[i]);
    secant.push_back((y[i + 1] - y[i]) / step[i]);
  }
  std::vector<double> slope(n, secant[0]);
  if (n == 2) return slope;
  for (size_t i = 1; i + 1 < n; ++i) {
    const double w0 = 2 * step[i] + step[i - 1];
    const double w1 = step[i] + 2 * step[i - 1];
    slope[i] = (w0 + w1) / (w0 / secant[i - 1] + w1 / secant[i]);
  }
  slope[0] = EndSlope(step[0], step[1], secant[0], secant[1]);
  slope[n - 1] = EndSlope(step[n - 2], step[n - 3], secant[n - 2], secant[n - 3]);
  return slope;
}

size_t PieceOf(const std::vector<double>& knots, double value) {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, value);
  return static_cast<size_t>(above - knots.begin()) - 1;
}

}  // namespace

absl::StatusOr<MonotoneCurve> MonotoneCurve::Through(std::vector<double> x, std::vector<double> y) {
  if (x.size() < 2 || x.size() != y.size()) {
    return BadInput("monotone curve", absl::StrCat(x.size(), " and ", y.size(), " knots"),
                    "give at least 2 of both");
  }
  for (size_t i = 1; i < x.size(); ++i) {
    if (!(x[i] > x[i - 1]) || !(y[i] > y[i - 1]) || !std::isfinite(x[i] - x[i - 1]) ||
        !std::isfinite(y[i] - y[i - 1])) {
      return BadInput("monotone curve", absl::StrCat("knot ", i + 1, " does not rise"),
                      "give knots that rise in both");
    }
  }
  MonotoneCurve curve;
  curve.slope_ = Slopes(x, y);
  curve.x_ = std::move(x);
  curve.y_ = std::move(y);
  return curve;
}

MonotoneCurve::Value MonotoneCurve::In(size_t piece, double x) const {
  const double h = x_[piece + 1] - x_[piece];
  const double rise = y_[piece + 1] - y_[piece];
  const double t = (x - x_[piece]) / h;
  const double m0 = slope_[piece] * h;
  const double m1 = slope_[piece + 1] * h;
  const double c2 = 3 * rise - 2 * m0 - m1;
  const double c3 = m0 + m1 - 2 * rise;
  return {.y = t < 1 ? y_[piece] + t * (m0 + t * (c2 + t * c3)) : y_[piece + 1],
          .slope = (m0 + t * (2 * c2 + 3 * t * c3)) / h};
}

std::optional<double> MonotoneCurve::At(double x) const {
  if (!(x >= x_.front() && x <= x_.back())) return std::nullopt;
  return In(PieceOf(x_, x), x).y;
}

std::optional<double> MonotoneCurve::SlopeAt(double x) const {
  if (!(x >= x_.front() && x <= x_.back())) return std::nullopt;
  return In(PieceOf(x_, x), x).slope;
}

std::optional<double> MonotoneCurve::InverseAt(double y) const {
  if (!(y >= y_.front() && y <= y_.back())) return std::nullopt;
  const size_t piece = PieceOf(y_, y);
  double low = x_[piece];
  double high = x_[piece + 1];
  double x = low + (high - low) * (y - y_[piece]) / (y_[piece + 1] - y_[piece]);
  for (int step = 0; step < 200; ++step) {
    const Value at = In(piece, x);
    if (at.y == y) return x;
    (at.y > y ? high : low) = x;
    double next = at.slope > 0 ? x - (at.y - y) / at.slope : (low + high) / 2;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (next == x || !(next > low && next < high)) break;  // neighbouring numbers
    x = next;
  }
  return x;
}

std::vector<double> Isotonic(std::span<const double> value, std::span<const double> weight) {
  struct Pool {
    double mean, weight;
    size_t count;
  };
  std::vector<Pool> pools;
  for (size_t i = 0; i < value.size(); ++i) {
    pools.push_back({value[i], weight[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean >= pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& pool = pools.back();
      pool.mean = (pool.mean * pool.weight + last.mean * last.weight) / (pool.weight + last.weight);
      pool.weight += last.weight;
      pool.count += last.count;
    }
  }
  std::vector<double> fitted;
  for (const Pool& pool : pools) fitted.insert(fitted.end(), pool.count, pool.mean);
  return fitted;
}

}  // namespace eyebox::optics
