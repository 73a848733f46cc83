#include "optics/geometry/calibrate_lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/optics/geometry/views.h"

namespace eyebox::optics {
namespace {

using testing::HasSubstr;

constexpr GridBoard kBoard;
constexpr double kSigmaPx = 0.1;

struct Case {
  CameraModel lens;
  double distance_mm;
  GridBoard board;
};

std::vector<Case> Cases() {
  return {{NarrowLens(), 160, kBoard},
          {WideLens(), 55, {.columns = 13, .rows = 11, .pitch_mm = 10}}};
}

TEST(CalibrateLens, RecoversTheLensWithinItsUncertainty) {
  for (const Case& tried : Cases()) {
    double sum_of_squared_pulls = 0;
    int pulls = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
      const auto views = SeenThrough(tried.lens, tried.board, tried.distance_mm, kSigmaPx, seed);
      const auto found = CalibrateLens(views, tried.lens.size, {.lens = tried.lens.lens});
      ASSERT_TRUE(found.ok()) << found.status();
      EXPECT_TRUE(found->accepted);
      EXPECT_NEAR(found->rms_px, kSigmaPx * std::sqrt(2), 0.01);
      const auto truth = ParametersOf(tried.lens);
      const auto values = ParametersOf(found->model);
      for (size_t i = 0; i < 8; ++i) {
        const double pull = (values[i] - truth[i]) / found->sigma[i];
        EXPECT_LT(std::abs(pull), 4) << "parameter " << i << ", seed " << seed;
        sum_of_squared_pulls += pull * pull;
        ++pulls;
      }
    }
    // 96 pulls, of which groups of 8 hang together: 1 within about 3 of its own sigmas.
    EXPECT_NEAR(sum_of_squared_pulls / pulls, 1, 0.5);
  }
}

TEST(CalibrateLens, IsExactWithoutNoise) {
  for (const Case& tried : Cases()) {
    const auto views = SeenThrough(tried.lens, tried.board, tried.distance_mm, 0, 1);
    const auto found = CalibrateLens(views, tried.lens.size, {.lens = tried.lens.lens});
    ASSERT_TRUE(found.ok()) << found.status();
    EXPECT_LT(found->rms_px, 1e-8);
    EXPECT_NEAR(found->model.focal_length_x_px, tried.lens.focal_length_x_px, 1e-5);
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(found->model.distortion[i], tried.lens.distortion[i], 1e-6);
    }
  }
}

TEST(CalibrateLens, ReachesTheEdgeOfAWideField) {
  const auto views = SeenThrough(WideLens(), Cases()[1].board, Cases()[1].distance_mm, kSigmaPx, 3);
  const auto found = CalibrateLens(views, WideLens().size, {.lens = LensModel::kEquidistant});
  ASSERT_TRUE(found.ok()) << found.status();
  for (const double angle_deg : {-55.0, -30.0, 0.0, 30.0, 55.0}) {
    const auto pixel = WideLens().PixelOf(FieldAngle{angle_deg, 0});
    EXPECT_NEAR(found->model.FieldAngleOf(*pixel)->horizontal_deg, angle_deg, 0.1);
  }
}

TEST(CalibrateLens, NamesTheViewThatDoesNotFit) {
  auto views = SeenThrough(NarrowLens(), kBoard, 160, kSigmaPx, 1);
  for (size_t i = 0; i < views[4].points.size(); i += 5) views[4].points[i].pixel.x_px += 3;
  const auto found = CalibrateLens(views, NarrowLens().size);
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_THAT(found->warnings, testing::Contains(HasSubstr("view 4: leaves")));
}

TEST(CalibrateLens, WrongLensIsNotAccepted) {
  const auto views = SeenThrough(WideLens(), Cases()[1].board, Cases()[1].distance_mm, kSigmaPx, 1);
  const auto found = CalibrateLens(views, WideLens().size, {.distortion_terms = 1});
  if (found.ok()) {
    EXPECT_FALSE(found->accepted);
    EXPECT_THAT(found->reasons[0], HasSubstr("another model"));
  } else {
    EXPECT_EQ(found.status().code(), absl::StatusCode::kFailedPrecondition);
  }
}

TEST(CalibrateLens, ParallelViewsDoNotDetermineTheFocalLength) {
  const auto all = SeenThrough(NarrowLens(), kBoard, 160, kSigmaPx, 1);
  const std::vector<ViewPoints> same = {all[0], all[0], all[0]};
  const auto found = CalibrateLens(same, NarrowLens().size);
  if (found.ok()) {
    EXPECT_FALSE(found->accepted);
  } else {
    EXPECT_EQ(found.status().code(), absl::StatusCode::kFailedPrecondition);
  }
}

TEST(CalibrateLens, SaysWhatIsMissing) {
  const auto views = SeenThrough(NarrowLens(), kBoard, 160, kSigmaPx, 1);
  const auto two = CalibrateLens(std::span(views).first(2), NarrowLens().size);
  EXPECT_EQ(two.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(two.status().message(), HasSubstr("2 views of the target; take at least 3"));
  auto few = views;
  few[1].points.resize(5);
  EXPECT_THAT(CalibrateLens(few, NarrowLens().size).status().message(),
              HasSubstr("view 1: shows 5 points"));
  auto line = views;
  line[2].points.resize(8);
  EXPECT_THAT(CalibrateLens(line, NarrowLens().size).status().message(), HasSubstr("on a line"));
  EXPECT_THAT(CalibrateLens(views, NarrowLens().size, {.distortion_terms = 6}).status().message(),
              HasSubstr("give 0 to 5"));
}

}  // namespace
}  // namespace eyebox::optics
