#include "optics/geometry/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>

#include "optics/geometry/lens.h"
#include "optics/geometry/solid_angle.h"
#include "tests/optics/geometry/views.h"

namespace eyebox::optics {
namespace {

TEST(CameraModel, PixelsGoToFieldAnglesAndBack) {
  for (const CameraModel& lens : {NarrowLens(), WideLens()}) {
    for (int y = 0; y < lens.size.height_px; y += 7) {
      for (int x = 0; x < lens.size.width_px; x += 7) {
        const auto angle = lens.FieldAngleOf({1.0 * x, 1.0 * y});
        ASSERT_TRUE(angle.has_value()) << x << ' ' << y;
        const auto pixel = lens.PixelOf(*angle);
        ASSERT_TRUE(pixel.has_value());
        const auto again = lens.FieldAngleOf(*pixel);
        EXPECT_NEAR(pixel->x_px, x, 1e-9);
        EXPECT_NEAR(pixel->y_px, y, 1e-9);
        EXPECT_NEAR(again->horizontal_deg, angle->horizontal_deg, 1e-9);
        EXPECT_NEAR(again->vertical_deg, angle->vertical_deg, 1e-9);
      }
    }
  }
}

TEST(CameraModel, RightAndUpArePositive) {
  for (const CameraModel& lens : {NarrowLens(), WideLens()}) {
    const auto angle = lens.FieldAngleOf({lens.principal_x_px + 50, lens.principal_y_px - 20});
    EXPECT_GT(angle->horizontal_deg, 0);
    EXPECT_GT(angle->vertical_deg, 0);
    const auto middle = lens.FieldAngleOf({lens.principal_x_px, lens.principal_y_px});
    EXPECT_EQ(middle->horizontal_deg, 0);
    EXPECT_EQ(middle->vertical_deg, 0);
  }
}

TEST(CameraModel, IdealPinholeIsAnArcTangent) {
  const CameraModel lens = IdealPinhole({219.8, 79.5, 59.5}, {160, 120});
  const auto angle = lens.FieldAngleOf({159, 0});
  EXPECT_NEAR(angle->horizontal_deg, std::atan(79.5 / 219.8) * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(angle->vertical_deg, std::atan(59.5 / 219.8) * 180 / std::numbers::pi, 1e-12);
}

// The projections are OpenCV's, which were written by others.
TEST(CameraModel, AgreesWithOpenCv) {
  const std::vector<cv::Point3d> points = {{0.1, -0.2, 1}, {0.5, 0.3, 1.1}, {-0.4, 0.05, 0.9}};
  for (const CameraModel& lens : {NarrowLens(), WideLens()}) {
    const cv::Matx33d matrix(lens.focal_length_x_px, 0, lens.principal_x_px, 0,
                             lens.focal_length_y_px, lens.principal_y_px, 0, 0, 1);
    std::vector<cv::Point2d> expected;
    if (lens.lens == LensModel::kPinhole) {
      const cv::Vec<double, 5> terms(lens.distortion.data());
      cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matrix, terms, expected);
    } else {
      const cv::Vec4d terms(lens.distortion.data());
      cv::fisheye::projectPoints(points, expected, cv::Vec3d(), cv::Vec3d(), matrix, terms);
    }
    for (size_t i = 0; i < points.size(); ++i) {
      const auto pixel = lens.PixelOf(Direction{points[i].x, -points[i].y, points[i].z});
      EXPECT_NEAR(pixel->x_px, expected[i].x, 1e-9);
      EXPECT_NEAR(pixel->y_px, expected[i].y, 1e-9);
    }
  }
}

TEST(CameraModel, DerivativesAgreeWithDifferences) {
  for (const CameraModel& lens : {NarrowLens(), WideLens()}) {
    for (const Direction& point : {Direction{30, -20, 100}, Direction{1e-9, 0, 80}}) {
      const auto at = Project(lens, point);
      ASSERT_TRUE(at.has_value());
      for (size_t i = 0; i < 3; ++i) {
        constexpr double kStep = 1e-4;
        Direction more = point;
        Direction less = point;
        more[i] += kStep;
        less[i] -= kStep;
        const PixelPoint up = *lens.PixelOf(more);
        const PixelPoint down = *lens.PixelOf(less);
        EXPECT_NEAR(at->by_point[i], (up.x_px - down.x_px) / (2 * kStep), 2e-6);
        EXPECT_NEAR(at->by_point[3 + i], (up.y_px - down.y_px) / (2 * kStep), 2e-6);
      }
    }
  }
}

TEST(CameraModel, HasNoPixelBehindAPinholeOrBeyondAFold) {
  EXPECT_FALSE(NarrowLens().PixelOf(Direction{0.1, 0, -1}).has_value());
  CameraModel folded = NarrowLens();
  folded.distortion = {-0.5, 0, 0, 0, 0};
  EXPECT_FALSE(folded.PixelOf(FieldAngle{60, 0}).has_value());
  EXPECT_FALSE(folded.FieldAngleOf({folded.principal_x_px + 2000, 200}).has_value());
  EXPECT_FALSE(WideLens().FieldAngleOf({1e5, 0}).has_value());
}

TEST(SolidAngle, OfAPinholeSumsToThatOfARectangle) {
  const CameraModel lens = IdealPinhole({300, 200.2, 150.7}, {400, 300});
  const auto pixels = PixelSolidAnglesSr(lens);
  ASSERT_TRUE(pixels.ok());
  double sum = 0;
  for (const double sr : pixels->pixels()) sum += sr;
  const double exact =
      SolidAngleSr(*lens.FieldAngleOf({-0.5, 299.5}), *lens.FieldAngleOf({399.5, -0.5}));
  EXPECT_NEAR(sum / exact, 1, 1e-12);
  // On the axis a pixel is 1 / f^2.
  EXPECT_NEAR(pixels->at(200, 151) * 300 * 300, 1, 1e-5);
}

// An equidistant lens images a cone as a disk.
TEST(SolidAngle, OfAnEquidistantLensSumsToThatOfACone) {
  CameraModel lens = WideLens();
  lens.distortion = {};
  lens.focal_length_y_px = lens.focal_length_x_px = 301;
  const auto pixels = PixelSolidAnglesSr(lens);
  ASSERT_TRUE(pixels.ok());
  const double half_angle = 50 * std::numbers::pi / 180;
  double sum = 0;
  for (int y = 0; y < lens.size.height_px; ++y) {
    for (int x = 0; x < lens.size.width_px; ++x) {
      const double r = std::hypot(x - lens.principal_x_px, y - lens.principal_y_px);
      // Share of a pixel at the rim that lies within, to first order.
      const double share = std::clamp(301 * half_angle - r + 0.5, 0.0, 1.0);
      sum += share * pixels->at(x, y);
    }
  }
  EXPECT_NEAR(sum / (2 * std::numbers::pi * (1 - std::cos(half_angle))), 1, 1e-5);
}

}  // namespace
}  // namespace eyebox::optics
