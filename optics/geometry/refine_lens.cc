#include "optics/geometry/refine_lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "Eigen/Cholesky"
#include "Eigen/Core"
#include "Eigen/Eigenvalues"
#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr int kSteps = 200;
constexpr int kPoseParameters = 6;
constexpr double kSettled = 1e-13;   // relative fall of the sum of squares
constexpr double kSingular = 1e-15;  // of the scaled normal matrix: least over largest eigenvalue
constexpr double kExactPx2 = 1e-20;  // per point: the data are exact, nothing can fall further
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using LensBlock = Eigen::Matrix<double, 2, kLensParameters, Eigen::RowMajor>;
using PointBlock = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
using PoseBlock = Eigen::Matrix<double, 2, kPoseParameters>;

struct NormalEquations {
  Eigen::MatrixXd matrix;  // J^T J: the lens first, then the poses
  Eigen::VectorXd right;   // J^T r, r = seen - predicted
};

std::array<double*, kLensParameters> ParametersOf(CameraModel& model) {
  return {&model.focal_length_x_px, &model.focal_length_y_px, &model.principal_x_px,
          &model.principal_y_px,    &model.distortion[0],     &model.distortion[1],
          &model.distortion[2],     &model.distortion[3],     &model.distortion[4]};
}

PoseBlock ByPose(const PointBlock& by_point, const Direction& from_origin) {
  const auto [x, y, z] = from_origin;
  Eigen::Matrix3d by_turn;  // d (w x p) / dw
  by_turn << 0, z, -y, -z, 0, x, y, -x, 0;
  PoseBlock block;
  block << by_point * by_turn, by_point;
  return block;
}

NormalEquations Assemble(std::span<const ViewPoints> views, const LensEstimate& at) {
  const auto size = kLensParameters + kPoseParameters * static_cast<Eigen::Index>(views.size());
  NormalEquations normal{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (size_t v = 0; v < views.size(); ++v) {
    const auto begin = kLensParameters + kPoseParameters * static_cast<Eigen::Index>(v);
    for (const TargetPoint& point : views[v].points) {
      const Direction turned =
          Rotate(at.poses[v].rotation_camera_target, {point.x_mm, point.y_mm, 0});
      const auto projection = Project(at.model, at.poses[v].PointOf(point));
      const Eigen::Vector2d residual(point.pixel.x_px - projection->pixel.x_px,
                                     point.pixel.y_px - projection->pixel.y_px);
      const Eigen::Map<const LensBlock> by_lens(projection->by_parameter.data());
      const PoseBlock by_pose =
          ByPose(Eigen::Map<const PointBlock>(projection->by_point.data()), turned);
      normal.matrix.topLeftCorner<kLensParameters, kLensParameters>() +=
          by_lens.transpose() * by_lens;
      normal.matrix.block<kLensParameters, kPoseParameters>(0, begin) +=
          by_lens.transpose() * by_pose;
      normal.matrix.block<kPoseParameters, kPoseParameters>(begin, begin) +=
          by_pose.transpose() * by_pose;
      normal.right.head<kLensParameters>() += by_lens.transpose() * residual;
      normal.right.segment<kPoseParameters>(begin) += by_pose.transpose() * residual;
    }
  }
  normal.matrix.triangularView<Eigen::StrictlyLower>() = normal.matrix.transpose();
  return normal;
}

// A held parameter becomes an equation of its own, "does not move".
void Hold(const std::array<bool, kLensParameters>& is_free, NormalEquations& normal) {
  for (int i = 0; i < kLensParameters; ++i) {
    if (is_free[i]) continue;
    normal.matrix.row(i).setZero();
    normal.matrix.col(i).setZero();
    normal.matrix(i, i) = 1;
    normal.right(i) = 0;
  }
}

LensEstimate Stepped(const LensEstimate& from, const Eigen::VectorXd& step) {
  LensEstimate to = from;
  const auto parameters = ParametersOf(to.model);
  for (int i = 0; i < kLensParameters; ++i) *parameters[i] += step(i);
  for (size_t v = 0; v < to.poses.size(); ++v) {
    const auto begin = kLensParameters + kPoseParameters * static_cast<Eigen::Index>(v);
    to.poses[v] = Moved(from.poses[v], {step(begin), step(begin + 1), step(begin + 2)},
                        {step(begin + 3), step(begin + 4), step(begin + 5)});
  }
  return to;
}

absl::Status Undetermined() {
  return Rejected("camera calibration", "the views do not determine the lens",
                  "take views of the target tilted by 20 to 40 deg in several directions");
}

size_t CountPoints(std::span<const ViewPoints> views) {
  size_t points = 0;
  for (const ViewPoints& view : views) points += view.points.size();
  return points;
}

absl::StatusOr<std::vector<double>> Covariance(std::span<const ViewPoints> views,
                                               const RefinedLens& refined,
                                               const std::array<bool, kLensParameters>& is_free) {
  NormalEquations normal = Assemble(views, refined.estimate);
  Hold(is_free, normal);
  const Eigen::VectorXd scale = normal.matrix.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return Undetermined();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal.matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  if (solver.info() != Eigen::Success ||
      !(solver.eigenvalues().minCoeff() > kSingular * solver.eigenvalues().maxCoeff())) {
    return Undetermined();
  }
  const Eigen::MatrixXd inverse = solver.eigenvectors() *
                                  solver.eigenvalues().cwiseInverse().asDiagonal() *
                                  solver.eigenvectors().transpose();
  const auto free_count = std::count(is_free.begin(), is_free.end(), true);
  const double freedom = 2.0 * static_cast<double>(CountPoints(views)) -
                         static_cast<double>(free_count) -
                         static_cast<double>(kPoseParameters * views.size());
  if (!(freedom > 0)) return Undetermined();
  const double variance_px2 = refined.sum_of_squares_px2 / freedom;
  std::vector<double> covariance;
  for (int i = 0; i < kLensParameters; ++i) {
    for (int j = 0; j < kLensParameters; ++j) {
      const bool both = is_free[i] && is_free[j];
      covariance.push_back(both ? variance_px2 * inverse(i, j) * scale(i) * scale(j) : 0);
    }
  }
  return covariance;
}

}  // namespace

double SumOfSquaresPx2(std::span<const ViewPoints> views, const LensEstimate& estimate) {
  double sum = 0;
  for (size_t v = 0; v < views.size(); ++v) {
    for (const TargetPoint& point : views[v].points) {
      const auto pixel = estimate.model.PixelOf(estimate.poses[v].PointOf(point));
      if (!pixel) return kInfinity;
      const double dx = point.pixel.x_px - pixel->x_px;
      const double dy = point.pixel.y_px - pixel->y_px;
      sum += dx * dx + dy * dy;
    }
  }
  return std::isnan(sum) ? kInfinity : sum;
}

absl::StatusOr<RefinedLens> RefineLens(std::span<const ViewPoints> views, LensEstimate start,
                                       const std::array<bool, kLensParameters>& is_free) {
  RefinedLens refined;
  refined.estimate = std::move(start);
  refined.sum_of_squares_px2 = SumOfSquaresPx2(views, refined.estimate);
  if (!std::isfinite(refined.sum_of_squares_px2)) {
    return Rejected("camera calibration", "no start was found from which all points are seen",
                    "check the target's dimensions, and use the equidistant lens for wide fields");
  }
  const double exact = kExactPx2 * static_cast<double>(CountPoints(views));
  double damping = 1e-4;
  NormalEquations normal = Assemble(views, refined.estimate);
  Hold(is_free, normal);
  while (refined.iterations < kSteps) {
    ++refined.iterations;
    NormalEquations damped = normal;
    damped.matrix.diagonal() *= 1 + damping;
    const Eigen::VectorXd step = damped.matrix.ldlt().solve(damped.right);
    if (!step.allFinite()) return Undetermined();
    LensEstimate next = Stepped(refined.estimate, step);
    const double sum = next.model.Validate().ok() ? SumOfSquaresPx2(views, next) : kInfinity;
    const double fall = refined.sum_of_squares_px2 - sum;
    if (fall >= 0) {
      const bool settled = fall <= kSettled * refined.sum_of_squares_px2 || sum <= exact;
      refined.estimate = std::move(next);
      refined.sum_of_squares_px2 = sum;
      damping = std::max(damping / 10, 1e-15);
      if (settled) break;
      normal = Assemble(views, refined.estimate);
      Hold(is_free, normal);
    } else {
      damping *= 10;
      if (damping > 1e12) break;  // the least that rounding lets one see
    }
  }
  if (refined.iterations >= kSteps) {
    return Rejected("camera calibration", absl::StrCat("did not settle in ", kSteps, " steps"),
                    "free fewer distortion terms, or take more views");
  }
  refined.termination = absl::StrCat("settled after ", refined.iterations, " steps");
  EYEBOX_ASSIGN_OR_RETURN(refined.covariance, Covariance(views, refined, is_free));
  return refined;
}

}  // namespace eyebox::optics
