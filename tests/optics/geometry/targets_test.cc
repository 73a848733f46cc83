#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optics/geometry/calibrate_lens.h"
#include "optics/geometry/find_charuco.h"
#include "optics/geometry/find_dots.h"
#include "tests/optics/geometry/photograph.h"
#include "tests/optics/geometry/views.h"

namespace eyebox::optics {
namespace {

using testing::HasSubstr;

constexpr DotGrid kDots = {.columns = 11, .rows = 9, .bright = true};
constexpr double kPitchMm = 8;

double DotsAt(double x_mm, double y_mm) {
  return GridOfDots(kDots.columns, kDots.rows, kPitchMm, 1.5, x_mm, y_mm);
}

CameraModel SmallWideLens() {
  CameraModel lens = WideLens();
  lens.size = {400, 360};
  lens.focal_length_x_px = 190;
  lens.focal_length_y_px = 189;
  lens.principal_x_px = 201.5;
  lens.principal_y_px = 178.2;
  return lens;
}

ViewPoints PointsOf(const std::vector<Dot>& dots) {
  ViewPoints view{"drawn", {}};
  for (const Dot& dot : dots) {
    view.points.push_back({kPitchMm * dot.column, kPitchMm * dot.row, dot.centre});
  }
  return view;
}

TEST(FindDots, OfAWideFieldCalibrateItsLens) {
  const CameraModel lens = SmallWideLens();
  std::vector<ViewPoints> views;
  unsigned seed = 1;
  for (const Pose& pose : Poses(50)) {
    const auto dots = FindDots(Photograph(lens, pose, seed++, 15, DotsAt), kDots, "drawn");
    ASSERT_TRUE(dots.ok()) << dots.status();
    ASSERT_EQ(dots->size(), 99U);
    views.push_back(PointsOf(*dots));
  }
  const auto found = CalibrateLens(views, lens.size, {.lens = LensModel::kEquidistant});
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_TRUE(found->accepted);
  // Dots are disks of 1.5 mm at 50 mm: the centre of light is not quite the centre.
  EXPECT_LT(found->rms_px, 0.1);
  EXPECT_NEAR(found->model.focal_length_x_px, lens.focal_length_x_px, 0.5);
  EXPECT_NEAR(found->model.principal_x_px, lens.principal_x_px, 0.5);
}

TEST(FindDots, DarkDotsAndABoardOnItsSideAreFound) {
  const CameraModel lens = SmallWideLens();
  const Image<double> view = Photograph(lens, At(0, 0, 60, 5, 5, 87), 1, 10,
                                        [](double x, double y) { return 1 - DotsAt(x, y); });
  const auto dots = FindDots(view, {.columns = 11, .rows = 9, .bright = false}, "side.png");
  ASSERT_TRUE(dots.ok()) << dots.status();
  for (const Dot& dot : *dots) {
    EXPECT_LT(dot.column, 11);
    EXPECT_LT(dot.row, 9);
  }
}

TEST(FindDots, NamesTheGridThatIsThere) {
  const Image<double> view = Photograph(SmallWideLens(), At(0, 0, 60, 0, 0, 0), 1, 10, DotsAt);
  const auto wrong = FindDots(view, {.columns = 12, .rows = 9, .bright = true}, "wrong.png");
  EXPECT_EQ(wrong.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(wrong.status().message(),
              HasSubstr("wrong.png: shows 99 dots in a grid of 11 x 9, not 12 x 9"));
  const auto none = FindDots(Image<double>({200, 200}, 100.0), kDots, "grey.png");
  EXPECT_THAT(none.status().message(), HasSubstr("grey.png: no grid among 0 spots"));
  EXPECT_THAT(FindDots(view, {.columns = 2, .rows = 9}, "x").status().message(),
              HasSubstr("at least 3 columns"));
}

constexpr CharucoBoard kBoard = {.columns = 8, .rows = 6, .square_mm = 10, .marker_mm = 7};

// Half as many pixels as NarrowLens() has, across and down.
CameraModel SmallNarrowLens() {
  CameraModel lens = NarrowLens();
  lens.size = {320, 240};
  for (double* length : {&lens.focal_length_x_px, &lens.focal_length_y_px, &lens.principal_x_px,
                         &lens.principal_y_px}) {
    *length /= 2;
  }
  return lens;
}

struct Print {
  Image<double> drawn;
  double operator()(double x_mm, double y_mm) const {  // the middle of the board is 0, 0
    const double x = 4.0 * (x_mm + 40) - 0.5;
    const double y = 4.0 * (y_mm + 30) - 0.5;
    const int column = static_cast<int>(std::lround(x));
    const int row = static_cast<int>(std::lround(y));
    if (column < 0 || row < 0 || column >= drawn.size().width_px || row >= drawn.size().height_px) {
      return 1;
    }
    return drawn.at(column, row) / 255;
  }
};

TEST(FindCharuco, PartialViewsCalibrateAPinhole) {
  const CameraModel lens = SmallNarrowLens();
  const Print print{*DrawCharuco(kBoard, 40)};
  std::vector<ViewPoints> views;
  size_t partial = 0;
  unsigned seed = 1;
  for (const Pose& pose :
       {At(0, 0, 130, 0, 0, 0), At(25, 0, 110, 25, 0, 5), At(-25, 10, 110, -25, 5, 0),
        At(0, -20, 110, 0, 28, 0), At(20, 20, 110, 5, -25, 10), At(-20, -20, 100, 20, 20, 0)}) {
    const auto view = FindCharuco(Photograph(lens, pose, seed++, 10, print), kBoard, "drawn");
    ASSERT_TRUE(view.ok()) << view.status();
    partial += view->points.size() < 35 ? 1 : 0;
    views.push_back(*view);
  }
  EXPECT_GE(partial, 3U);
  const auto found = CalibrateLens(views, lens.size, {});
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_LT(found->rms_px, 0.3);
  const auto truth = ParametersOf(lens);
  const auto values = ParametersOf(found->model);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(values[i], truth[i], 4 * found->sigma[i] + 0.5) << i;
  }
}

TEST(FindCharuco, NamesTheBoardThatItIsNot) {
  const CameraModel lens = SmallNarrowLens();
  const Print print{*DrawCharuco(kBoard, 40)};
  const Image<double> view = Photograph(lens, At(0, 0, 130, 5, 5, 0), 1, 10, print);
  CharucoBoard other = kBoard;
  other.columns = 7;
  EXPECT_THAT(FindCharuco(view, other, "board.png").status().message(),
              HasSubstr("board.png: its markers do not lie as on a board of 7 x 6 squares"));
  other.columns = 9;
  EXPECT_THAT(FindCharuco(view, other, "board.png").status().message(),
              HasSubstr("do not lie as on a board of 9 x 6 squares"));
  other = kBoard;
  other.marker_bits = 6;
  EXPECT_THAT(FindCharuco(view, other, "board.png").status().message(),
              HasSubstr("no marker of the board's dictionary"));
  other.marker_mm = 12;
  EXPECT_EQ(FindCharuco(view, other, "board.png").status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyebox::optics
