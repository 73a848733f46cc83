// Splines and polynomials over a field, and which of them predicts it better.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optics/uniformity/cross_validate.h"
#include "optics/uniformity/smooth_field.h"

namespace eyebox::optics {
namespace {

constexpr ImageSize kSize{96, 72};

template <typename G>
MeasuredImage Field(G g, double sigma, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  MeasuredImage image = MakeMeasuredImage(kSize, "cd/m2");
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      image.value.at(x, y) = static_cast<float>(
          g(2.0 * x / (kSize.width_px - 1) - 1, 2.0 * y / (kSize.height_px - 1) - 1) +
          sigma * normal(random));
      image.variance.at(x, y) = static_cast<float>(sigma * sigma);
    }
  }
  return image;
}

double Cubic(double u, double v) {
  return 3 - u + 0.5 * v * v * v + 0.25 * u * u * v * v * v - 0.125 * u * u * u * v;
}
// A bump narrower than any low polynomial.
double Bump(double u, double v) { return 1 + 0.3 * std::exp(-40 * (u * u + v * v)); }
double Parabola(double u, double v) { return 1 - 0.2 * u * u - 0.1 * v * v; }

TEST(SmoothModels, ASplineHoldsEveryBicubicExactly) {
  const MeasuredImage image = Field(Cubic, 1e-3, 1);
  MeasuredImage exact = image;
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      exact.value.at(x, y) = static_cast<float>(
          Cubic(2.0 * x / (kSize.width_px - 1) - 1, 2.0 * y / (kSize.height_px - 1) - 1));
    }
  }
  const auto spline = FitSmoothField(exact, FieldModel::kSpline, 5);
  ASSERT_TRUE(spline.ok()) << spline.status();
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {95.0, 71.0}, {40.3, 17.7}, {95.0, 0.0}}) {
    EXPECT_NEAR(spline->At(x, y), Cubic(2 * x / 95 - 1, 2 * y / 71 - 1), 2e-6);
  }
  const Image<float> values = spline->Values();
  EXPECT_NEAR(values.at(40, 17), spline->At(40, 17), 1e-6);
}

TEST(SmoothModels, MapsAreWhatSinglePlacesGive) {
  const MeasuredImage image = Field(Bump, 0.02, 3);
  for (const auto& [model, order] : {std::pair{FieldModel::kPolynomial, 0},
                                     {FieldModel::kPolynomial, kLargestOrder},
                                     {FieldModel::kSpline, 1},
                                     {FieldModel::kSpline, 7}}) {
    const auto field = FitSmoothField(image, model, order);
    ASSERT_TRUE(field.ok()) << field.status();
    const Image<float> values = field->Values();
    const Image<float> sigmas = field->Sigmas();
    for (int y = 0; y < kSize.height_px; y += 5) {
      for (int x = 0; x < kSize.width_px; x += 7) {
        EXPECT_NEAR(values.at(x, y), field->At(x, y), 1e-6);
        EXPECT_NEAR(sigmas.at(x, y) / field->SigmaAt(x, y), 1, 1e-6);
      }
    }
  }
}

TEST(SmoothModels, PullsOfASplineHaveUnitVariance) {
  double squares = 0;
  int count = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const auto spline = FitSmoothField(Field(Cubic, 0.02, seed), FieldModel::kSpline, 3);
    ASSERT_TRUE(spline.ok()) << spline.status();
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {47.0, 35.0}, {80.0, 5.0}}) {
      const double pull =
          (spline->At(x, y) - Cubic(2 * x / 95 - 1, 2 * y / 71 - 1)) / spline->SigmaAt(x, y);
      squares += pull * pull;
      ++count;
    }
  }
  EXPECT_NEAR(squares / count, 1, 0.4);  // sigma of this mean is 0.13
}

TEST(SmoothModels, CrossValidationTakesTheOrderOfTheTruth) {
  const auto choice = CrossValidate(Field(Parabola, 0.01, 2));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_GE(choice->polynomial.size, 2);
  EXPECT_LE(choice->polynomial.size, 4);
  EXPECT_FALSE(choice->spline_is_better);
  EXPECT_NEAR(choice->polynomial.held_out_chi2, 1, 0.1);
  EXPECT_GT(choice->polynomials[1].held_out_chi2, 5);
}

TEST(SmoothModels, CrossValidationTakesASplineForANarrowBump) {
  const auto choice = CrossValidate(Field(Bump, 0.01, 3));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_TRUE(choice->spline_is_better);
  EXPECT_GE(choice->spline.size, 6);
  EXPECT_NEAR(choice->spline.held_out_chi2, 1, 0.15);
}

TEST(SmoothModels, WhatThePixelsDoNotDetermineIsNotOffered) {
  MeasuredImage image = Field(Parabola, 0.01, 4);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      if (x > 10) image.mask.at(x, y) = kNoData;
    }
  }
  BlankMaskedPixels(image);
  const auto choice = CrossValidate(image);
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_LT(choice->splines.size(), 8);  // finer ones have functions without a pixel
  for (uint8_t& flag : image.mask.pixels()) flag = kNoData;
  BlankMaskedPixels(image);
  EXPECT_TRUE(absl::IsFailedPrecondition(CrossValidate(image).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(FitSmoothField(image, FieldModel::kSpline, 17).status()));
}

}  // namespace
}  // namespace eyebox::optics
