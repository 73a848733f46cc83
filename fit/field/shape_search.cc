#include "fit/field/shape_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "fit/base/activation.h"

namespace eyebox::fit {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kGammaSteps = 24;
constexpr int kCutoffSteps = 8;
constexpr int kMostIterations = 200;
constexpr double kStill = 1e-13;  // relative step at which the search ends
constexpr double kFirstDamping = 1e-3;
constexpr double kMostDamping = 1e12;

// One group as the search sees it.
struct GroupRows {
  std::vector<int> levels;
  Eigen::VectorXd root_weights;  // [valid levels], of the levels
  Eigen::VectorXd constant;      // root_weights scaled to length 1
  // [rows, valid levels]: sqrt(level weight location weight) times luminance, less its part along
  // `constant`; rows are locations or stand for them.
  Eigen::MatrixXd rows;
};

Eigen::MatrixXd RowsOf(const MaskedStack& stack, const FieldWeights& weights,
                       const MaskGroup& group, const VectorXd& root_weights) {
  Eigen::MatrixXd rows(group.members.size(), group.levels.size());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const size_t location = group.members[i];
    const double root_weight = std::sqrt(weights.locations[location]);
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      const size_t place = group.levels[k] * stack.LocationCount() + location;
      rows(i, k) = root_weight * root_weights[k] * stack.luminance[place];
    }
  }
  return rows;
}

GroupRows Reduced(const MaskedStack& stack, const FieldWeights& weights, const MaskGroup& group) {
  const auto levels = static_cast<Eigen::Index>(group.levels.size());
  GroupRows reduced{group.levels, VectorXd(levels), {}, {}};
  for (Eigen::Index k = 0; k < levels; ++k) {
    reduced.root_weights[k] = std::sqrt(weights.levels[group.levels[k]]);
  }
  reduced.constant = reduced.root_weights.normalized();
  reduced.rows = RowsOf(stack, weights, group, reduced.root_weights);
  reduced.rows -= (reduced.rows * reduced.constant) * reduced.constant.transpose();
  if (reduced.rows.rows() > levels) {
    const Eigen::HouseholderQR<MatrixXd> qr(reduced.rows);
    reduced.rows = MatrixXd(qr.matrixQR().topRows(levels).triangularView<Eigen::Upper>());
  }
  return reduced;
}

struct Shape {
  double gamma = 0;
  double cutoff = 0;
};

// dL/d(parameter) at every level of the stack, by LuminanceGradient's order: h, by v0, by gamma.
struct Columns {
  VectorXd h, by_cutoff, by_gamma;
};

Columns ColumnsAt(std::span<const double> drives, const Shape& shape) {
  const auto levels = static_cast<Eigen::Index>(drives.size());
  Columns columns{VectorXd(levels), VectorXd(levels), VectorXd(levels)};
  const Activation activation{0, 1, shape.cutoff, shape.gamma};
  for (Eigen::Index i = 0; i < levels; ++i) {
    const std::array<double, 4> gradient = activation.LuminanceGradient(drives[i]);
    columns.h[i] = gradient[1];
    columns.by_cutoff[i] = gradient[2];
    columns.by_gamma[i] = gradient[3];
  }
  return columns;
}

// Of one group's levels, weighted, orthogonal to the constant.
VectorXd Centred(const GroupRows& group, const VectorXd& column) {
  VectorXd weighted(group.root_weights.size());
  for (Eigen::Index k = 0; k < weighted.size(); ++k) {
    weighted[k] = group.root_weights[k] * column[group.levels[k]];
  }
  return weighted - group.constant * group.constant.dot(weighted);
}

// 0 where the valid levels all lie below the cutoff: no gain can be told there.
VectorXd UnitOf(const VectorXd& centred) {
  const double length = centred.norm();
  return length > 0 ? VectorXd(centred / length) : VectorXd::Zero(centred.size());
}

double SumOfSquares(const std::vector<GroupRows>& groups, std::span<const double> drives,
                    const Shape& shape) {
  const Columns columns = ColumnsAt(drives, shape);
  double sum = 0;
  for (const GroupRows& group : groups) {
    const VectorXd unit = UnitOf(Centred(group, columns.h));
    // From the residuals: a difference of two sums would lose the digits that steps are judged by.
    sum += (group.rows - (group.rows * unit) * unit.transpose()).squaredNorm();
  }
  return sum;
}

struct Normal {
  Matrix2d curvature = Matrix2d::Zero();
  Vector2d downhill = Vector2d::Zero();  // minus the slope of half the sum of squares
};

Normal NormalAt(const std::vector<GroupRows>& groups, std::span<const double> drives,
                const Shape& shape) {
  const Columns columns = ColumnsAt(drives, shape);
  Normal normal;
  for (const GroupRows& group : groups) {
    const VectorXd centred = Centred(group, columns.h);
    const double length = centred.norm();
    if (!(length > 0)) continue;
    const VectorXd unit = centred / length;
    MatrixXd by_shape(centred.size(), 2);
    by_shape.col(0) = Centred(group, columns.by_gamma);
    by_shape.col(1) = Centred(group, columns.by_cutoff);
    by_shape -= unit * (unit.transpose() * by_shape);
    const VectorXd gains = group.rows * unit / length;
    normal.curvature += gains.squaredNorm() * by_shape.transpose() * by_shape;
    normal.downhill += by_shape.transpose() * (group.rows.transpose() * gains);
  }
  return normal;
}

class Limits {
 public:
  Limits(std::span<const double> drives, const SharedExponentOptions& options)
      : gamma_min_(options.gamma_min), gamma_max_(options.gamma_max) {
    std::vector<double> sorted(drives.begin(), drives.end());
    std::sort(sorted.begin(), sorted.end());
    if (options.with_cutoff) cutoff_max_ = sorted[sorted.size() - 3];
  }
  Shape Clamp(const Shape& shape) const {
    return {std::clamp(shape.gamma, gamma_min_, gamma_max_),
            std::clamp(shape.cutoff, 0.0, cutoff_max_)};
  }
  double cutoff_max() const { return cutoff_max_; }

 private:
  double gamma_min_;
  double gamma_max_;
  double cutoff_max_ = 0;
};

Shape Scan(const std::vector<GroupRows>& groups, std::span<const double> drives,
           const SharedExponentOptions& options, const Limits& limits) {
  Shape best;
  double least = -1;
  const int cutoff_steps = options.with_cutoff ? kCutoffSteps : 0;
  for (int c = 0; c <= cutoff_steps; ++c) {
    const double cutoff =
        c == 0 ? 0 : limits.cutoff_max() * std::pow(static_cast<double>(c) / cutoff_steps, 2);
    for (int g = 0; g <= kGammaSteps; ++g) {
      const double share = static_cast<double>(g) / kGammaSteps;
      const Shape shape{options.gamma_min * std::pow(options.gamma_max / options.gamma_min, share),
                        cutoff};
      const double sum = SumOfSquares(groups, drives, shape);
      if (least >= 0 && sum >= least) continue;
      least = sum;
      best = shape;
    }
  }
  return best;
}

// A parameter that is held, or that the slope drives against its bound, takes no step.
Vector2d StepFrom(const Normal& normal, const Shape& shape, bool with_cutoff, double damping) {
  const bool free_cutoff = with_cutoff && !(shape.cutoff == 0 && normal.downhill[1] <= 0);
  Vector2d step = Vector2d::Zero();
  if (!free_cutoff) {
    step[0] = normal.downhill[0] / (normal.curvature(0, 0) * (1 + damping));
    return step;
  }
  Matrix2d damped = normal.curvature;
  damped.diagonal() *= 1 + damping;
  return damped.fullPivLu().solve(normal.downhill);
}

}  // namespace

ShapeOptimum SearchShape(const MaskedStack& stack, const FieldWeights& weights,
                         std::span<const MaskGroup> mask_groups,
                         const SharedExponentOptions& options) {
  const std::span<const double> drives = stack.drives;
  std::vector<GroupRows> groups;
  for (const MaskGroup& group : mask_groups) groups.push_back(Reduced(stack, weights, group));
  const Limits limits(drives, options);
  Shape shape = Scan(groups, drives, options, limits);
  double sum = SumOfSquares(groups, drives, shape);
  double damping = kFirstDamping;
  ShapeOptimum optimum;
  Normal normal = NormalAt(groups, drives, shape);
  for (; optimum.iterations < kMostIterations && damping < kMostDamping; ++optimum.iterations) {
    const Vector2d step = StepFrom(normal, shape, options.with_cutoff, damping);
    const Shape next = limits.Clamp({shape.gamma + step[0], shape.cutoff + step[1]});
    const double moved = std::max(std::abs(next.gamma - shape.gamma) / shape.gamma,
                                  std::abs(next.cutoff - shape.cutoff));
    const double next_sum = SumOfSquares(groups, drives, next);
    // Near the optimum the sums are equal to their last digits: small steps are trusted.
    if (next_sum <= sum || moved < 1e-6) {
      shape = next;
      sum = next_sum;
      normal = NormalAt(groups, drives, shape);
      damping = std::max(damping / 10, 1e-15);
      optimum.converged = moved < kStill * 100;
      if (moved < kStill) break;
    } else {
      damping *= 10;
    }
  }
  optimum.gamma = shape.gamma;
  optimum.cutoff_drive = shape.cutoff;
  Eigen::Map<Matrix2d>(optimum.curvature.data()) = normal.curvature;
  return optimum;
}

}  // namespace eyebox::fit
