// Polynomials whose orders are weighted: nearer to the truth than any that is cut off, and sure of
// themselves to the right degree, at the rim too.
#include "optics/uniformity/order_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "optics/uniformity/cross_validate.h"
#include "optics/uniformity/smooth_field.h"

namespace eyebox::optics {
namespace {

constexpr ImageSize kSize{80, 60};
constexpr double kNoise = 0.005;

// Falls off as lenses make it, and bends within a few pixels of the rim, as scatter does.
double Lens(double u, double v) {
  const double smooth = std::exp(-0.2 * (u * u + v * v)) * (1 + 0.02 * u - 0.03 * v);
  const double rim = std::exp(-(1 - std::abs(u)) / 0.06) + std::exp(-(1 - std::abs(v)) / 0.06);
  return smooth + 0.0015 * rim;
}
double Flat(double, double) { return 1; }
double Quartic(double u, double v) { return 1 - 0.2 * u * u * v * v + 0.1 * v * v * v; }

double U(int x) { return 2.0 * x / (kSize.width_px - 1) - 1; }
double V(int y) { return 2.0 * y / (kSize.height_px - 1) - 1; }

template <typename G>
MeasuredImage Field(G g, double noise, double stated, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  MeasuredImage image = MakeMeasuredImage(kSize, "cd/m2");
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      image.value.at(x, y) = static_cast<float>(100 * (g(U(x), V(y)) + noise * normal(random)));
      image.variance.at(x, y) = static_cast<float>(1e4 * stated * stated);
    }
  }
  return image;
}

struct Accuracy {
  double error_squares = 0;
  double pull_squares = 0;
  double covered = 0;
  double pixels = 0;

  template <typename G>
  void Add(const SmoothField& field, G g) {
    const Image<float> values = field.Values();
    const Image<float> sigmas = field.Sigmas();
    for (int y = 0; y < kSize.height_px; ++y) {
      for (int x = 0; x < kSize.width_px; ++x) {
        const double error = values.at(x, y) - 100 * g(U(x), V(y));
        const double pull = error / sigmas.at(x, y);
        error_squares += error * error;
        pull_squares += pull * pull;
        covered += std::abs(pull) < 1.96 ? 1 : 0;
        ++pixels;
      }
    }
  }
};

TEST(OrderWeights, NearerToTheTruthThanTheBestSingleOrderAndHonest) {
  Accuracy weighted, cut, larger;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    const MeasuredImage image = Field(Lens, kNoise, kNoise, seed);
    const auto choice = CrossValidate(image);
    ASSERT_TRUE(choice.ok()) << choice.status();
    const auto one = FitWeightedPolynomial(image, kLargestOrder);
    const auto other = FitSmoothField(image, FieldModel::kPolynomial, choice->polynomial.size);
    ASSERT_TRUE(one.ok() && other.ok());
    EXPECT_LT(one->effective_functions, 45);
    EXPECT_GT(one->effective_functions, 6);
    weighted.Add(*one, Lens);
    cut.Add(*other, Lens);
    // What it takes to make the bias small beside the sigmas.
    const int above = std::min(choice->polynomial.size + 2, kLargestOrder);
    const auto honest = FitSmoothField(image, FieldModel::kPolynomial, above);
    ASSERT_TRUE(honest.ok()) << honest.status();
    larger.Add(*honest, Lens);
  }
  const auto print = [](const char* name, const Accuracy& of) {
    std::printf("%s: rms error %.4f, rms pull %.3f, 95 %% cover %.1f %%\n", name,
                std::sqrt(of.error_squares / of.pixels), std::sqrt(of.pull_squares / of.pixels),
                100 * of.covered / of.pixels);
  };
  print("weighted orders", weighted);
  print("best single order", cut);
  print("two orders above", larger);
  EXPECT_LT(weighted.error_squares, cut.error_squares);
  EXPECT_LT(weighted.error_squares, larger.error_squares);
  EXPECT_NEAR(weighted.covered / weighted.pixels, 0.95, 0.025);
  EXPECT_NEAR(std::sqrt(weighted.pull_squares / weighted.pixels), 1, 0.12);
  EXPECT_LT(cut.covered / cut.pixels, 0.92) << "else nothing is shown here";
}

TEST(OrderWeights, NoiseBeyondTheStatedIsNotTakenForShape) {
  Accuracy understated;
  for (uint64_t seed = 1; seed <= 15; ++seed) {
    const auto field = FitWeightedPolynomial(Field(Lens, kNoise, kNoise / 3, seed), kLargestOrder);
    ASSERT_TRUE(field.ok()) << field.status();
    EXPECT_NEAR(field->reduced_chi2, 9, 0.8);
    understated.Add(*field, Lens);
  }
  EXPECT_NEAR(understated.covered / understated.pixels, 0.95, 0.03);
}

TEST(OrderWeights, PenaltiesRiseWithTheOrderAndLeaveTheMeanAlone) {
  const FieldBasis basis(FieldModel::kPolynomial, kLargestOrder, kSize);
  const MeasuredImage image = Field(Lens, kNoise, kNoise, 5);
  const auto penalties = OrderPenalties(SumImage(image, basis, 1).front(), basis);
  ASSERT_EQ(penalties.size(), basis.Terms().size());
  EXPECT_EQ(penalties[0], 0);
  for (size_t i = 1; i < penalties.size(); ++i) {
    const auto [a, b] = basis.Terms()[i];
    EXPECT_GT(penalties[i], 0);
    if (b != 0 || a < 2) continue;
    // Of the same functions in x, normalised: the precision rises.
    const size_t before = static_cast<size_t>(a - 1) * a / 2;
    EXPECT_GT(penalties[i] * (2 * a + 1), penalties[before] * (2 * a - 1)) << "order " << a;
  }
}

TEST(OrderWeights, AtTheExtremesAllStaysFinite) {
  for (const double noise : {0.0, 1e-7, 3.0}) {
    for (const auto& g : {Flat, Quartic}) {
      const MeasuredImage image = Field(g, noise, std::max(noise, 1e-6), 3);
      const auto field = FitWeightedPolynomial(image, kLargestOrder);
      ASSERT_TRUE(field.ok()) << field.status() << " noise " << noise;
      const Image<float> values = field->Values();
      const Image<float> sigmas = field->Sigmas();
      for (const auto& [x, y] : {std::pair{0, 0}, {40, 30}, {79, 59}, {79, 0}}) {
        EXPECT_TRUE(std::isfinite(values.at(x, y)) && std::isfinite(sigmas.at(x, y)));
        EXPECT_GT(sigmas.at(x, y), 0);
        EXPECT_NEAR(values.at(x, y), 100 * g(U(x), V(y)), 5 * sigmas.at(x, y) + 2e-5);
      }
    }
  }
}

TEST(OrderWeights, ThePredictionOfTheWeightedIsItsOwnHoweverSmallTheCoefficients) {
  for (const double noise : {1e-5, kNoise}) {
    const auto choice = CrossValidate(Field(Quartic, noise, noise, 8));
    ASSERT_TRUE(choice.ok()) << choice.status();
    EXPECT_EQ(choice->weighted.size, kLargestOrder);
    EXPECT_LT(choice->weighted.held_out_chi2, choice->polynomials.back().held_out_chi2);
    EXPECT_LT(choice->weighted.held_out_chi2, choice->polynomial.held_out_chi2 + 0.005);
  }
}

TEST(OrderWeights, FewOrdersAreTakenAsTheyAre) {
  const MeasuredImage image = Field(Quartic, kNoise, kNoise, 4);
  const auto plain = FitSmoothField(image, FieldModel::kPolynomial, kLeastWeightedOrder - 1);
  const auto weighted = FitWeightedPolynomial(image, kLeastWeightedOrder - 1);
  ASSERT_TRUE(plain.ok() && weighted.ok());
  EXPECT_EQ(weighted->coefficients, plain->coefficients);
  EXPECT_EQ(weighted->effective_functions, 10);
}

TEST(OrderWeights, ASplineTooCoarseKnowsThatALargerOneFollowsBetter) {
  const MeasuredImage image = Field(Lens, kNoise / 10, kNoise / 10, 6);
  const auto alone = FitSmoothField(image, FieldModel::kSpline, 3);
  const auto warned = FitSmoothField(image, FieldModel::kSpline, 3, {}, 6);
  ASSERT_TRUE(alone.ok() && warned.ok());
  EXPECT_GT(warned->SigmaAt(79, 59), 1.5 * alone->SigmaAt(79, 59));
  EXPECT_EQ(warned->coefficients, alone->coefficients);
  Accuracy of_alone, of_warned;
  of_alone.Add(*alone, Lens);
  of_warned.Add(*warned, Lens);
  EXPECT_LT(of_alone.covered / of_alone.pixels, 0.8);
  EXPECT_GT(of_warned.covered / of_warned.pixels, of_alone.covered / of_alone.pixels + 0.1);
}

}  // namespace
}  // namespace eyebox::optics
