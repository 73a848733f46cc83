#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "optics/geometry/entrance_pupil.h"
#include "optics/geometry/registration.h"
#include "optics/geometry/resample.h"
#include "optics/geometry/solid_angle.h"
#include "tests/optics/geometry/views.h"

namespace eyebox::optics {
namespace {

using testing::Contains;
using testing::HasSubstr;

// A display 110 deg wide seen through a lens that bends it.
FieldAngle SeenAt(const PixelPoint& display) {
  const double s = (display.x_px - 719.5) / 720;
  const double t = (display.y_px - 799.5) / 800;
  const double r2 = s * s + t * t;
  return {48 * s * (1 + 0.12 * r2) + 1.5, -50 * t * (1 + 0.1 * r2) - 0.7 + 0.4 * s};
}

std::vector<DisplayedDot> Dots(double sigma_deg, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, sigma_deg > 0 ? sigma_deg : 1);
  std::vector<DisplayedDot> dots;
  for (int y = 50; y < 1600; y += 150) {
    for (int x = 40; x < 1440; x += 130) {
      DisplayedDot dot{{1.0 * x, 1.0 * y}, SeenAt({1.0 * x, 1.0 * y})};
      if (sigma_deg > 0) {
        dot.seen.horizontal_deg += noise(random);
        dot.seen.vertical_deg += noise(random);
      }
      dots.push_back(dot);
    }
  }
  return dots;
}

TEST(Registration, CrossValidationFindsTheOrderAndTheMap) {
  const auto found = RegisterDisplay(Dots(0.02, 1));
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_EQ(found->map.order, 3);
  EXPECT_NEAR(found->residual_rms_deg, 0.02, 0.003);
  for (const PixelPoint& place :
       {PixelPoint{100, 100}, PixelPoint{720, 800}, PixelPoint{1300, 1500}}) {
    const FieldAngle seen = found->map.FieldAngleOf(place);
    EXPECT_NEAR(seen.horizontal_deg, SeenAt(place).horizontal_deg, 0.03);
    EXPECT_NEAR(seen.vertical_deg, SeenAt(place).vertical_deg, 0.03);
    const auto back = found->map.DisplayPixelOf(seen);
    ASSERT_TRUE(back.has_value());
    EXPECT_NEAR(back->x_px, place.x_px, 1e-9);
    EXPECT_NEAR(back->y_px, place.y_px, 1e-9);
  }
  EXPECT_FALSE(found->map.DisplayPixelOf({300, 0}).has_value());
}

TEST(Registration, SaysWhatIsMissing) {
  const auto dots = Dots(0, 1);
  EXPECT_LT(RegisterDisplay(dots, 3)->largest_residual_deg, 1e-11);
  EXPECT_THAT(RegisterDisplay(std::span(dots).first(4)).status().message(),
              HasSubstr("at least 5 dots"));
  EXPECT_THAT(RegisterDisplay(dots, 9).status().message(), HasSubstr("give 1 to 8"));
  EXPECT_EQ(RegisterDisplay(std::span(dots).first(11), 2).status().code(),
            absl::StatusCode::kFailedPrecondition);  // all in one row
}

TEST(EntrancePupil, TurnsCarryTheAxis) {
  const ViewGeometry turned = {NarrowLens(), {.yaw_deg = 10, .pitch_deg = 4}};
  const auto axis = turned.FieldAngleOf({NarrowLens().principal_x_px, NarrowLens().principal_y_px});
  EXPECT_NEAR(axis->horizontal_deg, 10, 1e-12);
  EXPECT_NEAR(std::atan(std::tan(axis->vertical_deg * std::numbers::pi / 180) *
                        std::cos(10 * std::numbers::pi / 180)) *
                  180 / std::numbers::pi,
              4, 1e-12);
  // Rolled clockwise, the right of the image lies below.
  const ViewGeometry rolled = {NarrowLens(), {.roll_deg = 5}};
  EXPECT_LT(rolled.FieldAngleOf({600, NarrowLens().principal_y_px})->vertical_deg, -0.5);
  const PixelPoint place = {123, 321};
  const auto back = rolled.PixelOf(*rolled.FieldAngleOf(place));
  EXPECT_NEAR(back->x_px, place.x_px, 1e-9);
  EXPECT_NEAR(back->y_px, place.y_px, 1e-9);
}

TEST(EntrancePupil, WarnsOfWhatSpoilsTheMeasurement) {
  const EntrancePupil pupil = {.diameter_mm = 4, .right_mm = 3, .forward_mm = -2};
  const auto warnings = PupilWarnings(pupil, {.focal_length_mm = 16,
                                              .f_number = 2,
                                              .exit_pupil_mm = 8,
                                              .eye_pupil_mm = 3,
                                              .image_distance_m = 1.3});
  EXPECT_EQ(warnings.size(), 5U);
  EXPECT_THAT(warnings, Contains(HasSubstr("8 mm (16 mm at f/2), larger than the 4 mm stated")));
  EXPECT_THAT(warnings, Contains(HasSubstr("2 mm behind the eye point")));
  EXPECT_THAT(warnings, Contains(HasSubstr("shifts field angles by 0.13 deg")));
  EXPECT_TRUE(PupilWarnings({.diameter_mm = 2}, {.exit_pupil_mm = 8, .eye_pupil_mm = 3}).empty());
  EXPECT_FALSE(EntrancePupil{.yaw_deg = 95}.Validate().ok());
}

MeasuredImage Smooth(ImageSize size) {
  MeasuredImage image = MakeMeasuredImage(size, "cd/m2");
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      image.value.at(x, y) = static_cast<float>(50 + 0.02 * x - 0.01 * y);
      image.variance.at(x, y) = 0.25F;
    }
  }
  return image;
}

CameraModel SmallLens() {
  CameraModel lens = WideLens();
  lens.size = {160, 150};
  lens.focal_length_x_px = lens.focal_length_y_px = 76;
  lens.principal_x_px = 80.2;
  lens.principal_y_px = 74.1;
  return lens;
}

TEST(ResampleToField, ConservesLightWhateverTheStep) {
  const ViewGeometry geometry = {SmallLens(), {.yaw_deg = 2, .roll_deg = 3}};
  const MeasuredImage image = Smooth(geometry.camera.size);
  const auto solid_angle = PixelSolidAnglesSr(geometry.camera);
  double light = 0;
  for (size_t i = 0; i < image.value.pixels().size(); ++i) {
    light += image.value.pixels()[i] * solid_angle->pixels()[i];
  }
  for (const double step_deg : {0.31, 1.0, 7.0}) {
    FieldGrid grid = *GridOver(geometry, step_deg);
    grid.left_deg -= step_deg;  // room for the outermost half pixels
    grid.top_deg += step_deg;
    grid.size = {grid.size.width_px + 2, grid.size.height_px + 2};
    const auto map = ResampleToField(image, geometry, grid, {.least_coverage = 0});
    ASSERT_TRUE(map.ok()) << map.status();
    double resampled = 0;
    for (size_t i = 0; i < map->image.value.pixels().size(); ++i) {
      if (map->image.mask.pixels()[i] != 0) continue;
      resampled += map->image.value.pixels()[i] * map->solid_angle_sr.pixels()[i];
    }
    EXPECT_NEAR(resampled / light, 1, 1e-6) << step_deg;
  }
}

TEST(ResampleToField, TellsTheLuminanceOfADirection) {
  const ViewGeometry geometry = {SmallLens(), {}};
  const auto grid = GridOver(geometry, 1);
  const auto map = ResampleToField(Smooth(geometry.camera.size), geometry, *grid);
  ASSERT_TRUE(map.ok());
  for (int row = 5; row < grid->size.height_px - 5; row += 9) {
    for (int column = 5; column < grid->size.width_px - 5; column += 9) {
      if (map->image.mask.at(column, row) != 0) continue;
      const auto pixel = geometry.PixelOf(grid->CentreOf(column, row));
      EXPECT_NEAR(map->image.value.at(column, row), 50 + 0.02 * pixel->x_px - 0.01 * pixel->y_px,
                  0.02);
    }
  }
}

TEST(ResampleToField, StatedVarianceIsTheScatterOfTheCells) {
  const ViewGeometry geometry = {SmallLens(), {}};
  const auto grid = GridOver(geometry, 2.5);
  const MeasuredImage clean = Smooth(geometry.camera.size);
  const auto expected = ResampleToField(clean, geometry, *grid);
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.5);
  double squared_pulls = 0;
  int pulls = 0;
  for (int trial = 0; trial < 10; ++trial) {
    MeasuredImage noisy = clean;
    for (float& value : noisy.value.pixels()) value += static_cast<float>(noise(random));
    const auto map = ResampleToField(noisy, geometry, *grid);
    for (size_t i = 0; i < map->image.value.pixels().size(); ++i) {
      if (map->image.mask.pixels()[i] != 0) continue;
      squared_pulls +=
          std::pow(map->image.value.pixels()[i] - expected->image.value.pixels()[i], 2) /
          map->image.variance.pixels()[i];
      ++pulls;
    }
  }
  EXPECT_GT(pulls, 5000);
  EXPECT_NEAR(squared_pulls / pulls, 1, 0.06);
}

TEST(ResampleToField, MaskedPixelsTakeNoPart) {
  const ViewGeometry geometry = {SmallLens(), {}};
  MeasuredImage image = Smooth(geometry.camera.size);
  for (int y = 60; y < 90; ++y) {
    for (int x = 60; x < 100; ++x) image.mask.at(x, y) = kSaturated;
  }
  BlankMaskedPixels(image);
  FieldGrid grid = *GridOver(geometry, 2);
  grid.size.width_px += 3;  // nothing is seen there
  const auto map = ResampleToField(image, geometry, grid);
  ASSERT_TRUE(map.ok());
  const int middle_x = static_cast<int>(std::lround(-grid.left_deg / grid.step_deg));
  const int middle_y = static_cast<int>(std::lround(grid.top_deg / grid.step_deg));
  EXPECT_EQ(map->image.mask.at(middle_x, middle_y), kSaturated);
  EXPECT_EQ(map->image.mask.at(grid.size.width_px - 1, middle_y), kNoData);
  for (size_t i = 0; i < map->image.mask.pixels().size(); ++i) {
    if (map->image.mask.pixels()[i] == 0) {
      EXPECT_TRUE(std::isfinite(map->image.value.pixels()[i]));
    }
  }
}

TEST(ResampleToField, RefusesAnotherSize) {
  const ViewGeometry geometry = {SmallLens(), {}};
  EXPECT_THAT(
      ResampleToField(Smooth({80, 60}), geometry, *GridOver(geometry, 2)).status().message(),
      HasSubstr("of 160 x 150 px, the map has 80 x 60"));
  EXPECT_FALSE(GridOver(geometry, 0).ok());
}

}  // namespace
}  // namespace eyebox::optics
