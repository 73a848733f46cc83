#include "fit/base/monotone_warp.h"

#include <algorithm>
#include <cmath>

namespace eyebox::fit {
namespace {

constexpr double kLargestLogSlope = 300;

using Knot = MonotoneWarp::Knot;

// Area under the straight slope of a piece from its beginning to `t`.
double Rise(const Knot& from, const Knot& to, double t) {
  return t * (from.slope + (to.slope - from.slope) * t / (2 * (to.x - from.x)));
}

// Area from 0 to x under the hat that is 1 at knot j and 0 at its neighbours.
double HatArea(const std::vector<Knot>& knots, size_t j, double x) {
  double area = 0;
  if (j > 0 && x > knots[j - 1].x) {
    const double width = knots[j].x - knots[j - 1].x;
    const double t = std::min(x, knots[j].x) - knots[j - 1].x;
    area += t * t / (2 * width);
  }
  if (j + 1 < knots.size() && x > knots[j].x) {
    const double width = knots[j + 1].x - knots[j].x;
    const double t = std::min(x, knots[j + 1].x) - knots[j].x;
    area += t * (1 - t / (2 * width));
  }
  return area;
}

}  // namespace

bool MonotoneWarp::IsValid(std::span<const double> x, std::span<const double> log_slopes) {
  if (x.size() < 2 || x.size() != log_slopes.size()) return false;
  if (x.front() != 0 || x.back() != 1) return false;
  for (size_t i = 1; i < x.size(); ++i) {
    if (!(x[i] > x[i - 1])) return false;
  }
  return std::all_of(log_slopes.begin(), log_slopes.end(),
                     [](double log_slope) { return std::abs(log_slope) < kLargestLogSlope; });
}

MonotoneWarp MonotoneWarp::FromLogSlopes(std::span<const double> x,
                                         std::span<const double> log_slopes) {
  MonotoneWarp warp;
  const double largest = *std::max_element(log_slopes.begin(), log_slopes.end());
  for (size_t i = 0; i < x.size(); ++i) {
    warp.knots_.push_back({x[i], 0, std::exp(log_slopes[i] - largest)});
    if (i == 0) continue;
    const Knot& before = warp.knots_[i - 1];
    warp.knots_[i].y = before.y + Rise(before, warp.knots_[i], x[i] - before.x);
  }
  for (size_t i = warp.knots_.size() - 1; i-- > 0;) {
    const Knot& after = warp.knots_[i + 1];
    warp.knots_[i].rest = after.rest + Rise(warp.knots_[i], after, after.x - warp.knots_[i].x);
  }
  const double total = warp.knots_.back().y;
  for (Knot& knot : warp.knots_) {
    knot.y /= total;
    knot.slope /= total;
    knot.rest /= total;
  }
  return warp;
}

size_t MonotoneWarp::PieceOf(double x) const {
  size_t piece = 0;
  while (piece + 2 < knots_.size() && x >= knots_[piece + 1].x) ++piece;
  return piece;
}

double MonotoneWarp::At(double x) const {
  x = std::clamp(x, 0.0, 1.0);
  if (IsIdentity() || x == 1) return x;
  const size_t piece = PieceOf(x);
  return knots_[piece].y + Rise(knots_[piece], knots_[piece + 1], x - knots_[piece].x);
}

double MonotoneWarp::OneMinusAt(double one_minus_x) const {
  const double u = std::clamp(one_minus_x, 0.0, 1.0);
  if (IsIdentity()) return u;
  // Counted from white, piece by piece: a sum of positive areas loses no digits.
  const size_t piece = PieceOf(1 - u);
  const Knot& from = knots_[piece];
  const Knot& to = knots_[piece + 1];
  const double below = std::max((to.x - 1) + u, 0.0);
  return to.rest + below * (to.slope + (from.slope - to.slope) * below / (2 * (to.x - from.x)));
}

double MonotoneWarp::SlopeAt(double x) const {
  if (IsIdentity()) return 1;
  x = std::clamp(x, 0.0, 1.0);
  const size_t piece = PieceOf(x);
  const Knot& from = knots_[piece];
  const Knot& to = knots_[piece + 1];
  const double share = (x - from.x) / (to.x - from.x);
  return from.slope * (1 - share) + to.slope * share;
}

double MonotoneWarp::InverseAt(double y) const {
  y = std::clamp(y, 0.0, 1.0);
  if (IsIdentity() || y == 1) return y;
  size_t piece = 0;
  while (piece + 2 < knots_.size() && y >= knots_[piece + 1].y) ++piece;
  const Knot& from = knots_[piece];
  const Knot& to = knots_[piece + 1];
  const double rise = y - from.y;
  // The slope at the place sought; it never cancels, unlike the textbook's root.
  const double bend = (to.slope - from.slope) / (to.x - from.x);
  const double slope = std::sqrt(std::max(from.slope * from.slope + 2 * bend * rise, 0.0));
  return std::min(from.x + 2 * rise / (from.slope + slope), 1.0);
}

std::vector<double> MonotoneWarp::ByLogSlopes(double x) const {
  x = std::clamp(x, 0.0, 1.0);
  const double y = At(x);
  std::vector<double> derivatives;
  for (size_t j = 0; j < knots_.size(); ++j) {
    derivatives.push_back(knots_[j].slope * (HatArea(knots_, j, x) - y * HatArea(knots_, j, 1)));
  }
  return derivatives;
}

}  // namespace eyebox::fit
