#include "optics/photometry/spectral_mismatch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eyebox::optics {
namespace {

Spectrum Gaussian(double centre_nm, double width_nm, double relative_sigma = 0) {
  Spectrum spectrum;
  for (double nm = 380; nm <= 780; nm += 5) {
    spectrum.wavelength_nm.push_back(nm);
    spectrum.value.push_back(std::exp(-0.5 * std::pow((nm - centre_nm) / width_nm, 2)));
    if (relative_sigma > 0) spectrum.sigma.push_back(relative_sigma * spectrum.value.back());
  }
  return spectrum;
}

Spectrum TheEye(double factor) {
  Spectrum spectrum;
  for (double nm = 380; nm <= 780; nm += 5) {
    spectrum.wavelength_nm.push_back(nm);
    spectrum.value.push_back(factor * PhotopicEfficiency(nm));
  }
  return spectrum;
}

// Published figures: V integrates to 106.857 nm, and illuminant A's table says 9.80 at 380 nm,
// 241.68 at 780 nm.
TEST(SpectralMismatch, TablesAreThoseOfTheCie) {
  double sum = 0;
  for (double nm = 380; nm <= 780; nm += 5) sum += 5 * PhotopicEfficiency(nm);
  EXPECT_NEAR(sum, 106.857, 0.003);
  EXPECT_EQ(PhotopicEfficiency(555), 1);
  EXPECT_EQ(PhotopicEfficiency(379.9), 0);
  EXPECT_NEAR(IlluminantA(380), 9.7951, 1e-3);
  EXPECT_NEAR(IlluminantA(560), 100, 1e-12);
  EXPECT_NEAR(IlluminantA(780), 241.675, 5e-3);
}

TEST(SpectralMismatch, ADetectorLikeTheEyeHasNone) {
  EXPECT_NEAR(*F1Prime(TheEye(7)), 0, 1e-12);
  const auto factor = MismatchFactor(TheEye(7), Gaussian(450, 10), IlluminantASpectrum());
  ASSERT_TRUE(factor.ok());
  EXPECT_NEAR(factor->factor, 1, 1e-12);
}

// Narrow lights: the factor is (V / s at the light) / (V / s at the calibration light).
TEST(SpectralMismatch, OfNarrowLightsIsARatioOfResponsivities) {
  const Spectrum detector = Gaussian(560, 60);
  const Spectrum light = {{599.9, 600, 600.1}, {0, 1, 0}, {}};
  const Spectrum calibration = {{519.9, 520, 520.1}, {0, 1, 0}, {}};
  const auto factor = MismatchFactor(detector, light, calibration);
  ASSERT_TRUE(factor.ok());
  const double expected =
      PhotopicEfficiency(600) / detector.At(600) * detector.At(520) / PhotopicEfficiency(520);
  EXPECT_NEAR(factor->factor, expected, 1e-3 * expected);
}

TEST(SpectralMismatch, StatedSigmaIsTheScatterOfPerturbedSpectra) {
  const Spectrum detector = Gaussian(560, 60, 0.02);
  const Spectrum light = Gaussian(630, 12, 0.01);
  const Spectrum calibration = Gaussian(540, 30, 0.01);
  const auto stated = MismatchFactor(detector, light, calibration);
  ASSERT_TRUE(stated.ok());
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0, 1);
  const auto perturbed = [&](Spectrum spectrum) {
    for (size_t i = 0; i < spectrum.value.size(); ++i) {
      spectrum.value[i] = std::max(0.0, spectrum.value[i] + spectrum.sigma[i] * noise(random));
    }
    return spectrum;
  };
  double sum = 0;
  constexpr int kTrials = 300;
  for (int i = 0; i < kTrials; ++i) {
    const auto trial =
        MismatchFactor(perturbed(detector), perturbed(light), perturbed(calibration));
    sum += std::pow(trial->factor - stated->factor, 2);
  }
  // 300 trials tell a scatter to 4 %.
  EXPECT_NEAR(std::sqrt(sum / kTrials) / stated->sigma, 1, 0.13);
  EXPECT_GT(MismatchFactor(detector, light, calibration, 1)->sigma, 1.5 * stated->sigma);
}

TEST(SpectralMismatch, SaysWhatIsWrong) {
  Spectrum falling = Gaussian(560, 60);
  std::swap(falling.wavelength_nm[3], falling.wavelength_nm[4]);
  EXPECT_THAT(F1Prime(falling).status().message(), testing::HasSubstr("entry 5"));
  const Spectrum infrared = {{800, 900}, {1, 1}, {}};
  EXPECT_EQ(MismatchFactor(Gaussian(560, 60), infrared, IlluminantASpectrum()).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace eyebox::optics
