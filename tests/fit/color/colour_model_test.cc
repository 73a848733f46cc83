#include "fit/color/colour_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fit/color/colour_goal.h"
#include "fit/color/drive_for_colour.h"
#include "tests/fit/color/synthetic_display.h"

namespace eyebox::fit {
namespace {

std::vector<ColourModel> AllModels() {
  return {SyntheticDisplay(ColourModelKind::kAdditive, {}),
          SyntheticDisplay(ColourModelKind::kCommonCrosstalk, {0.05}),
          SyntheticDisplay(ColourModelKind::kDriveCrosstalk, {0.09, -0.03, 0.05}),
          SyntheticDisplay(ColourModelKind::kPairwiseCrosstalk, {0.1, 0, -0.02, 0.04, 0.3, 0.2}),
          SyntheticDisplay(ColourModelKind::kActivationGain, {-0.2, 0.1, 0.3})};
}

TEST(ColourModelTest, ParametersComeBackInTheirOrder) {
  for (const ColourModel& model : AllModels()) {
    const std::vector<double> parameters = model.ToParameters();
    EXPECT_EQ(parameters.size(), ParameterNames(model.kind).size());
    EXPECT_EQ(parameters.size(), ParameterCount(model.kind));
    const ColourModel again = ColourModel::FromParameters(model.kind, parameters);
    EXPECT_EQ(again.ToParameters(), parameters);
    EXPECT_TRUE(model.Validate("test").ok());
    EXPECT_EQ(ColourModelKindOf(NameOf(model.kind)).value(), model.kind);
  }
  EXPECT_FALSE(ColourModelKindOf("none").ok());
}

TEST(ColourModelTest, CrosstalkFollowsItsFormula) {
  const ColourModel model = SyntheticDisplay(ColourModelKind::kDriveCrosstalk, {0.08, 0.02, 0.04});
  const Rgb a = model.Activations({0.5, 0.7, 0.3});
  EXPECT_NEAR(a[0], std::pow((0.5 + 0.04 * (0.7 + 0.3) - 0.02) / 0.98, 2.1), 1e-14);
  EXPECT_NEAR(a[2], std::pow((0.3 + 0.02 * (0.7 + 0.5) - 0.06) / 0.94, 2.5), 1e-14);
}

TEST(ColourModelTest, EachPrimaryAloneAtFullDriveIsItsParameter) {
  for (const ColourModel& model : AllModels()) {
    if (model.kind == ColourModelKind::kPairwiseCrosstalk) continue;  // lifts others over cutoff
    const Xyz red = Minus(model.Colour({1, 0, 0}), model.background);
    EXPECT_NEAR(red[0], model.primaries[0][0], 0.02);
  }
}

TEST(ColourModelTest, InverseFindsTheDriveOfEveryColourShown) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(0.1, 1);
  for (const ColourModel& model : AllModels()) {
    for (int i = 0; i < 300; ++i) {
      const Rgb drive = {uniform(generator), uniform(generator), uniform(generator)};
      const ColourDrive found = DriveForColour(model, model.Colour(drive));
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(found.drive[k], drive[k], 1e-9) << NameOf(model.kind);
      }
      EXPECT_TRUE(found.saturation_reached);
      EXPECT_TRUE(found.inside_gamut);
    }
  }
}

TEST(ColourModelTest, ColourOutsideKeepsItsLuminance) {
  for (const ColourModel& model : AllModels()) {
    for (double luminance : {1.0, 5.0, 20.0}) {
      const Xyz wanted = ColourOf({0.17, 0.75}, luminance);  // greener than any display
      const ColourDrive found = DriveForColour(model, wanted);
      EXPECT_FALSE(found.inside_gamut);
      EXPECT_FALSE(found.saturation_reached);
      EXPECT_NEAR(model.Colour(found.drive)[1], luminance, 1e-9 * luminance) << NameOf(model.kind);
    }
  }
}

TEST(ColourModelTest, LightOfBlackIsToldFromTheGamut) {
  const ColourModel model = SyntheticDisplay(ColourModelKind::kAdditive, {});
  Xyz wanted = model.primaries[0];
  for (double& component : wanted) component *= 0.1;
  const ColourDrive found = DriveForColour(model, wanted);
  EXPECT_FALSE(found.saturation_reached);
  EXPECT_TRUE(found.inside_gamut);
  EXPECT_NEAR(model.Colour(found.drive)[1], wanted[1], 1e-12);
}

TEST(ColourModelTest, BelowBlackEveryChannelIsOff) {
  for (const ColourModel& model : AllModels()) {
    const Xyz shown = model.Colour(DriveForColour(model, {0, 0, 0}).drive);
    for (size_t c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(shown[c], model.background[c]);
  }
}

TEST(ColourModelTest, ParameterOutOfRangeIsNamed) {
  ColourModel model = SyntheticDisplay(ColourModelKind::kAdditive, {});
  model.gamma[1] = -1;
  EXPECT_NE(model.Validate("here").message().find("gamma_g"), std::string::npos);
  model = SyntheticDisplay(ColourModelKind::kAdditive, {});
  model.primaries[2] = model.primaries[0];
  EXPECT_FALSE(model.Validate("here").ok());
  model = SyntheticDisplay(ColourModelKind::kDriveCrosstalk, {0.1, 0.1});
  EXPECT_FALSE(model.Validate("here").ok());
}

TEST(ColourGoalTest, BrightestWhiteIsReachedAndNoMore) {
  for (const ColourModel& model : AllModels()) {
    for (WhiteScale scale : {WhiteScale::kEveryColour, WhiteScale::kWhite}) {
      const auto goal = MakeColourGoal(model, {ColourGamut::kNative, {}, scale});
      ASSERT_TRUE(goal.ok()) << goal.status();
      double largest = 0;
      for (int corner = 1; corner < 8; ++corner) {
        if (scale == WhiteScale::kWhite && corner < 7) continue;
        const Rgb u = {corner & 1 ? 1.0 : 0.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 1.0 : 0.0};
        const Rgb drive = DriveForColour(model, goal->Wanted(u)).drive;
        largest = std::max({largest, drive[0], drive[1], drive[2]});
      }
      EXPECT_NEAR(largest, 1, 1e-9) << NameOf(model.kind);
    }
  }
}

TEST(ColourGoalTest, NativeWhiteOfAnAdditiveDisplayIsItsOwn) {
  const ColourModel model = SyntheticDisplay(ColourModelKind::kAdditive, {});
  const auto goal = MakeColourGoal(model, {ColourGamut::kNative, {}, WhiteScale::kWhite});
  ASSERT_TRUE(goal.ok());
  EXPECT_NEAR(goal->share_of_maximum, 1, 1e-9);
}

TEST(ColourGoalTest, WhiteOfSrgbIsD65AndImpossibleOnesAreRefused) {
  const ColourModel model = SyntheticDisplay(ColourModelKind::kAdditive, {});
  const auto goal = MakeColourGoal(model, {ColourGamut::kSrgb, {}, WhiteScale::kEveryColour});
  ASSERT_TRUE(goal.ok()) << goal.status();
  EXPECT_NEAR(ChromaticityOf(goal->White()).x, 0.3127, 1e-12);
  EXPECT_NEAR(ChromaticityOf(goal->White()).y, 0.3290, 1e-12);
  EXPECT_FALSE(MakeColourGoal(model, {ColourGamut::kSrgb, Chromaticity{0.7, 0.29}, {}}).ok());
  EXPECT_FALSE(MakeColourGoal(model, {ColourGamut::kSrgb, Chromaticity{0.9, 0.9}, {}}).ok());
}

}  // namespace
}  // namespace eyebox::fit
