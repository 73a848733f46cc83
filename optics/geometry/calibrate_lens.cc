#include "optics/geometry/calibrate_lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "Eigen/Core"
#include "Eigen/SVD"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "opencv2/calib3d.hpp"
#include "opencv2/core.hpp"
#include "optics/geometry/refine_lens.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestViews = 3;
constexpr size_t kFewestPoints = 6;
constexpr double kNotedViewExcess = 3;
constexpr double kNotedCoverage = 0.6;

absl::Status CheckView(const ViewPoints& view) {
  if (view.points.size() < kFewestPoints) {
    return BadInput(view.source, absl::StrCat("shows ", view.points.size(), " points"),
                    absl::StrCat("a view needs ", kFewestPoints));
  }
  Eigen::MatrixXd places(static_cast<Eigen::Index>(view.points.size()), 2);
  for (size_t i = 0; i < view.points.size(); ++i) {
    const TargetPoint& point = view.points[i];
    if (!std::isfinite(point.x_mm + point.y_mm + point.pixel.x_px + point.pixel.y_px)) {
      return BadInput(view.source, absl::StrCat("point ", i + 1, " is not finite"),
                      "give four numbers a point");
    }
    places.row(static_cast<Eigen::Index>(i)) << point.x_mm, point.y_mm;
  }
  places.rowwise() -= places.colwise().mean().eval();
  const Eigen::VectorXd spread = places.jacobiSvd().singularValues();
  if (!(spread(1) > 1e-6 * spread(0))) {
    return BadInput(view.source, "all of its points lie on a line", "show more of the target");
  }
  return absl::OkStatus();
}

absl::Status Check(std::span<const ViewPoints> views, ImageSize size,
                   const LensCalibrationOptions& options) {
  if (size.width_px < 1 || size.height_px < 1) {
    return BadInput("camera calibration", "the sensor has no size", "give it in pixels");
  }
  const int most = options.lens == LensModel::kPinhole ? 5 : 4;
  if (options.distortion_terms < 0 || options.distortion_terms > most) {
    return BadInput("distortion terms", absl::StrCat("are ", options.distortion_terms),
                    absl::StrCat("give 0 to ", most));
  }
  if (views.size() < kFewestViews) {
    return BadInput(
        "camera calibration",
        absl::StrCat(views.size(), " view", views.size() == 1 ? "" : "s", " of the target"),
        "take at least 3, better 10, with the target tilted differently in each");
  }
  for (const ViewPoints& view : views) EYEBOX_RETURN_IF_ERROR(CheckView(view));
  return absl::OkStatus();
}

CameraModel Guess(LensModel lens, ImageSize size, double focal_length_px) {
  return {.lens = lens,
          .size = size,
          .focal_length_x_px = focal_length_px,
          .focal_length_y_px = focal_length_px,
          .principal_x_px = (size.width_px - 1) / 2.0,
          .principal_y_px = (size.height_px - 1) / 2.0};
}

// The poses that go with a lens, from what an ideal perspective camera would see of the points.
std::optional<LensEstimate> WithPoses(std::span<const ViewPoints> views, const CameraModel& model) {
  constexpr double kLeastForward = 0.05;  // a perspective image of wider angles says little
  LensEstimate estimate{model, {}};
  for (const ViewPoints& view : views) {
    std::vector<TargetPoint> points;
    std::vector<std::array<double, 2>> image;
    for (const TargetPoint& point : view.points) {
      const auto direction = model.DirectionOf(point.pixel);
      if (!direction || (*direction)[2] < kLeastForward) continue;
      points.push_back(point);
      image.push_back({(*direction)[0] / (*direction)[2], -(*direction)[1] / (*direction)[2]});
    }
    Pose pose;
    if (points.size() < 4 || !PoseOf(points, image, pose)) return std::nullopt;
    estimate.poses.push_back(pose);
  }
  return estimate;
}

absl::StatusOr<LensEstimate> StartEquidistant(std::span<const ViewPoints> views, ImageSize size) {
  constexpr int kTrials = 40;
  constexpr double kNarrowest = 4;  // focal length in units of the sensor's larger side
  constexpr double kWidest = 0.12;
  std::optional<LensEstimate> best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTrials; ++i) {
    const double share = kWidest * std::pow(kNarrowest / kWidest, i / (kTrials - 1.0));
    const double focal_length_px = share * std::max(size.width_px, size.height_px);
    auto estimate = WithPoses(views, Guess(LensModel::kEquidistant, size, focal_length_px));
    if (!estimate) continue;
    const double sum = SumOfSquaresPx2(views, *estimate);
    if (sum < least) {
      least = sum;
      best = std::move(estimate);
    }
  }
  if (!best) {
    return Rejected("camera calibration", "no focal length explains the views",
                    "check the target's dimensions");
  }
  return *best;
}

int FlagsOf(int distortion_terms) {
  int flags = cv::CALIB_FIX_K3;
  if (distortion_terms >= 5) flags = 0;
  if (distortion_terms < 3) flags |= cv::CALIB_ZERO_TANGENT_DIST;
  if (distortion_terms < 2) flags |= cv::CALIB_FIX_K2;
  if (distortion_terms < 1) flags |= cv::CALIB_FIX_K1;
  return flags;
}

absl::StatusOr<LensEstimate> StartPinhole(std::span<const ViewPoints> views, ImageSize size,
                                          int distortion_terms) {
  std::vector<std::vector<cv::Point3f>> target;
  std::vector<std::vector<cv::Point2f>> image;
  for (const ViewPoints& view : views) {
    target.emplace_back();
    image.emplace_back();
    for (const TargetPoint& point : view.points) {
      target.back().emplace_back(static_cast<float>(point.x_mm), static_cast<float>(point.y_mm),
                                 0.0F);
      image.back().emplace_back(static_cast<float>(point.pixel.x_px),
                                static_cast<float>(point.pixel.y_px));
    }
  }
  cv::Mat matrix;
  cv::Mat terms;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> steps;
  try {
    cv::calibrateCamera(target, image, {size.width_px, size.height_px}, matrix, terms, turns, steps,
                        FlagsOf(distortion_terms));
  } catch (const cv::Exception& error) {
    return Rejected("camera calibration", absl::StrCat("OpenCV found no start (", error.err, ")"),
                    "take views of the target tilted differently");
  }
  CameraModel model = Guess(LensModel::kPinhole, size, matrix.at<double>(0, 0));
  model.focal_length_y_px = matrix.at<double>(1, 1);
  model.principal_x_px = matrix.at<double>(0, 2);
  model.principal_y_px = matrix.at<double>(1, 2);
  for (int i = 0; i < 5; ++i) model.distortion[i] = terms.at<double>(i);
  EYEBOX_RETURN_IF_ERROR(model.Validate());
  auto estimate = WithPoses(views, model);
  if (!estimate) {
    return Rejected("camera calibration", "OpenCV's start does not explain the views",
                    "check the target's dimensions, or use the equidistant lens for wide fields");
  }
  return *estimate;
}

absl::StatusOr<RefinedLens> Solve(std::span<const ViewPoints> views, ImageSize size,
                                  const LensCalibrationOptions& options) {
  std::array<bool, kLensParameters> is_free = {true, true, true, true};
  LensEstimate start;
  if (options.lens == LensModel::kPinhole) {
    EYEBOX_ASSIGN_OR_RETURN(start, StartPinhole(views, size, options.distortion_terms));
  } else {
    EYEBOX_ASSIGN_OR_RETURN(start, StartEquidistant(views, size));
    EYEBOX_ASSIGN_OR_RETURN(const RefinedLens undistorted, RefineLens(views, start, is_free));
    start = undistorted.estimate;
  }
  for (int i = 0; i < options.distortion_terms; ++i) is_free[4 + i] = true;
  return RefineLens(views, start, is_free);
}

void AddViews(std::span<const ViewPoints> views, const LensEstimate& estimate,
              LensCalibration& result) {
  for (size_t v = 0; v < views.size(); ++v) {
    const LensEstimate alone{estimate.model, {estimate.poses[v]}};
    const auto points = static_cast<int>(views[v].points.size());
    result.views.push_back(
        {.source = views[v].source,
         .points = points,
         .rms_px = std::sqrt(SumOfSquaresPx2(views.subspan(v, 1), alone) / points),
         .tilt_deg = estimate.poses[v].TiltDeg()});
    result.points += points;
  }
}

void Judge(const LensCalibrationOptions& options, LensCalibration& result) {
  if (!(result.rms_px <= options.largest_rms_px)) {
    result.reasons.push_back(absl::StrFormat(
        "points lie %.3g px rms from where the lens puts them, more than %.3g px: the target's "
        "dimensions are wrong, or the lens needs another model",
        result.rms_px, options.largest_rms_px));
  }
  const double relative = std::max(result.sigma[0] / result.model.focal_length_x_px,
                                   result.sigma[1] / result.model.focal_length_y_px);
  if (!(relative <= options.largest_focal_length_sigma_relative)) {
    result.reasons.push_back(
        absl::StrFormat("the focal length is known to %.2g %% only: take views of the target "
                        "tilted by 20 to 40 deg",
                        100 * relative));
  }
  result.accepted = result.reasons.empty();
}

void WarnOfViews(std::span<const ViewPoints> views, LensCalibration& result) {
  std::vector<double> rms;
  for (const ViewResidual& view : result.views) rms.push_back(view.rms_px);
  std::nth_element(rms.begin(), rms.begin() + rms.size() / 2, rms.end());
  const double median = rms[rms.size() / 2];
  for (const ViewResidual& view : result.views) {
    if (view.rms_px <= kNotedViewExcess * median) continue;
    result.warnings.push_back(
        absl::StrFormat("%s: leaves %.3g px rms where others leave %.3g px: look at it, or leave "
                        "it out",
                        view.source, view.rms_px, median));
  }
  double left = result.model.size.width_px;
  double right = 0;
  double top = result.model.size.height_px;
  double bottom = 0;
  for (const ViewPoints& view : views) {
    for (const TargetPoint& point : view.points) {
      left = std::min(left, point.pixel.x_px);
      right = std::max(right, point.pixel.x_px);
      top = std::min(top, point.pixel.y_px);
      bottom = std::max(bottom, point.pixel.y_px);
    }
  }
  const double covered = std::min((right - left) / result.model.size.width_px,
                                  (bottom - top) / result.model.size.height_px);
  if (covered < kNotedCoverage) {
    result.warnings.push_back(absl::StrFormat(
        "the points reach over %.0f %% of the sensor: beyond them the distortion is extrapolated",
        100 * covered));
  }
}

}  // namespace

absl::StatusOr<LensCalibration> CalibrateLens(std::span<const ViewPoints> views, ImageSize size,
                                              const LensCalibrationOptions& options) {
  EYEBOX_RETURN_IF_ERROR(Check(views, size, options));
  EYEBOX_ASSIGN_OR_RETURN(RefinedLens refined, Solve(views, size, options));
  LensCalibration result;
  result.model = refined.estimate.model;
  AddViews(views, refined.estimate, result);
  result.rms_px = std::sqrt(refined.sum_of_squares_px2 / result.points);
  for (size_t i = 0; i < kLensParameters; ++i) {
    result.sigma[i] = std::sqrt(refined.covariance[i * kLensParameters + i]);
  }
  result.covariance = std::move(refined.covariance);
  result.iterations = refined.iterations;
  result.termination = std::move(refined.termination);
  Judge(options, result);
  WarnOfViews(views, result);
  return result;
}

}  // namespace eyebox::optics
