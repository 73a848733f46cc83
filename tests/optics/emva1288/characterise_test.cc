// Series of a camera whose every parameter is known, written as files and characterised.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "optics/sensor/emva1288/read_series.h"
#include "optics/sensor/sensor_characterisation.h"
#include "tests/optics/emva1288/camera.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::optics {
namespace {

using testing::HasSubstr;

constexpr ImageSize kSize{256, 192};

SensorCharacterisation Characterise(Emva1288Camera& camera, bool photons_known = true) {
  const TemporaryFolder folder;
  const auto file = WriteSeries(folder.path(), camera);
  const auto descriptor = ReadEmva1288Descriptor(file);
  EXPECT_TRUE(descriptor.ok()) << descriptor.status();
  const auto series = ReadSeries(*descriptor, file.string());
  EXPECT_TRUE(series.ok()) << series.status();
  auto sensor = CharacteriseSensor(*series, {.photons_known = photons_known});
  EXPECT_TRUE(sensor.ok()) << sensor.status();
  return *sensor;
}

void ExpectWithin(const char* name, double value, double truth, double relative) {
  std::printf("  %-22s %12.6g, made with %12.6g (%+.3f %%)\n", name, value, truth,
              100 * (value / truth - 1));
  EXPECT_NEAR(value, truth, relative * truth) << name;
}

double ThresholdOf(const Emva1288CameraTruth& truth, double dark_e) {
  const double noise_e2 = truth.dark_noise_e * truth.dark_noise_e + dark_e +
                          1 / (12 * truth.gain_dn_per_e * truth.gain_dn_per_e);
  return std::sqrt(noise_e2 + 0.25) + 0.5;
}

// Temporal variance of the full well's clipping, e^2, averaged over the pixels' responses and
// offsets: that of min(X, c) for X normal with mean m and variance s^2.
double ClippedVariance(const Emva1288CameraTruth& truth, double electrons) {
  constexpr int kNodes = 400;
  const double spread = std::hypot(truth.dsnu_e, truth.prnu * electrons);
  double sum = 0;
  double weights = 0;
  for (int k = 0; k <= kNodes; ++k) {
    const double u = -5 + 10.0 * k / kNodes;
    const double weight = std::exp(-0.5 * u * u);
    const double m = electrons + u * spread;
    const double c = truth.full_well_e;
    const double s = std::sqrt(electrons + truth.dark_noise_e * truth.dark_noise_e);
    const double z = (c - m) / s;
    const double below = 0.5 * std::erfc(-z / std::sqrt(2.0));
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
    const double mean = m * below - s * density + c * (1 - below);
    const double square = (m * m + s * s) * below - s * (m + c) * density + c * c * (1 - below);
    sum += weight * (square - mean * mean);
    weights += weight;
  }
  return sum / weights;
}

// The saturation capacity as the standard defines it, from the noise-free model: the step of the
// largest temporal variance. It lies below the full well, where the brightest pixels' noise already
// clips.
double StandardSaturation(const Emva1288CameraTruth& truth) {
  double best = 0;
  double largest = 0;
  for (const double electrons : StepsOf(truth)) {
    const double slope = 1 - 2 * truth.compression * electrons / truth.full_well_e;
    const double variance = slope * slope * ClippedVariance(truth, electrons);
    if (variance > largest) best = electrons;
    largest = std::max(largest, variance);
  }
  return best;
}

class CharacteriseSeeds : public testing::TestWithParam<int> {};

TEST_P(CharacteriseSeeds, GivesWhatMadeTheSeriesWithinOnePercent) {
  const Emva1288CameraTruth truth;
  Emva1288Camera camera(truth, kSize, GetParam());
  const SensorCharacterisation sensor = Characterise(camera);
  const Emva1288Result& emva = sensor.emva;
  std::printf("seed %d, %s, %zu steps\n", GetParam(), emva.release.c_str(), emva.steps.size());
  ExpectWithin("K [DN/e]", emva.gain_dn_per_e.value, truth.gain_dn_per_e, 0.01);
  ExpectWithin("QE", emva.quantum_efficiency->value, truth.quantum_efficiency, 0.01);
  ExpectWithin("sigma_d [e]", emva.dark_noise_e.value, truth.dark_noise_e, 0.01);
  ExpectWithin("DSNU1288 [e]", emva.dsnu_e.value, truth.dsnu_e, 0.01);
  ExpectWithin("PRNU1288", emva.prnu.value, truth.prnu, 0.01);
  ExpectWithin("PRNU, unfiltered", emva.prnu_unfiltered.value, truth.prnu, 0.01);
  const double saturation_e = StandardSaturation(truth);
  ExpectWithin("mu_e.sat [e]", emva.saturation_e.value, saturation_e, 0.01);
  ASSERT_TRUE(emva.plateau_e.has_value());
  ExpectWithin("full well [e]", emva.plateau_e->value, truth.full_well_e, 0.01);
  ExpectWithin("mu_I.mean [e/s]", emva.dark_current->from_mean_e_s.value, truth.dark_current_e_s,
               0.01);
  const double threshold = ThresholdOf(truth, 0);
  ExpectWithin("mu_e.min [e]", emva.threshold_e.value, threshold, 0.01);
  // Data sheets give decibels with one decimal, linearity in per cent with two.
  const double range_db = 20 * std::log10(saturation_e / threshold);
  std::printf("  DR %.2f dB (%.2f), SNR max %.2f dB, LE %.4f %%\n", emva.DynamicRangeDb(), range_db,
              emva.SnrMaxDb(), 100 * emva.linearity->mean_absolute);
  EXPECT_NEAR(emva.DynamicRangeDb(), range_db, 0.1);
  EXPECT_NEAR(emva.SnrMaxDb(), 10 * std::log10(saturation_e), 0.1);
  EXPECT_NEAR(emva.linearity->mean_absolute, 0, 0.0001);
  EXPECT_TRUE(emva.saturation_reached);
  EXPECT_TRUE(emva.warnings.empty()) << emva.warnings.front();
}

INSTANTIATE_TEST_SUITE_P(FiveSeeds, CharacteriseSeeds, testing::Values(1, 2, 3, 4, 5));

// Quadratic compression: the fit's residuals follow from the noise-free curve alone.
LinearityError TrueLinearity(const Emva1288CameraTruth& truth) {
  std::vector<double> x;
  std::vector<double> y;
  const auto answer = [&](double e) { return e * (1 - truth.compression * e / truth.full_well_e); };
  const double top = answer(StandardSaturation(truth));
  for (const double electrons : StepsOf(truth)) {
    const double signal = answer(std::min(electrons, truth.full_well_e));
    if (signal < 0.05 * top || signal > 0.95 * top || electrons > truth.full_well_e) continue;
    x.push_back(electrons);
    y.push_back(signal);
  }
  // Normal equations of sum ((y - a x - b) / y)^2, by Cramer's rule.
  double xx = 0, x1 = 0, n1 = 0, x0 = 0, n0 = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const double w = 1 / (y[i] * y[i]);
    xx += w * x[i] * x[i];
    x1 += w * x[i];
    n1 += w;
    x0 += w * x[i] * y[i];
    n0 += w * y[i];
  }
  const double a = (x0 * n1 - x1 * n0) / (xx * n1 - x1 * x1);
  const double b = (xx * n0 - x1 * x0) / (xx * n1 - x1 * x1);
  LinearityError error;
  for (size_t i = 0; i < x.size(); ++i) {
    const double deviation = y[i] / (a * x[i] + b) - 1;
    error.mean_absolute += std::abs(deviation) / static_cast<double>(x.size());
    error.minimum = std::min(error.minimum, deviation);
    error.maximum = std::max(error.maximum, deviation);
  }
  return error;
}

TEST(CharacteriseTest, LinearityErrorOfACompressiveCameraIsFoundAndCorrected) {
  Emva1288CameraTruth truth;
  truth.compression = 0.04;
  Emva1288Camera camera(truth, kSize, 11);
  const SensorCharacterisation sensor = Characterise(camera);
  const LinearityError expected = TrueLinearity(truth);
  ASSERT_TRUE(sensor.emva.linearity.has_value());
  const LinearityError& found = *sensor.emva.linearity;
  std::printf("LE %.3f %% (%.3f), min %.3f (%.3f), max %.3f (%.3f)\n", 100 * found.mean_absolute,
              100 * expected.mean_absolute, 100 * found.minimum, 100 * expected.minimum,
              100 * found.maximum, 100 * expected.maximum);
  EXPECT_GT(expected.mean_absolute, 0.002);
  EXPECT_NEAR(found.mean_absolute, expected.mean_absolute, 1e-4);
  EXPECT_NEAR(found.minimum, expected.minimum, 2e-4);
  EXPECT_NEAR(found.maximum, expected.maximum, 2e-4);

  ASSERT_TRUE(sensor.linearity.has_value());
  const LinearityCurve& curve = *sensor.linearity;
  const auto ratio = [&](double electrons) {
    const double linear_dn = truth.gain_dn_per_e * electrons;
    const double dn = linear_dn * (1 - truth.compression * electrons / truth.full_well_e);
    return curve.At(dn).value_dn / linear_dn;
  };
  const double at_reference = ratio(100000);
  // The counts themselves lack 0.16 % at 8000 electrons and 3.6 % at 180000.
  for (const double electrons : {8000.0, 20000.0, 60000.0, 140000.0, 180000.0}) {
    EXPECT_NEAR(ratio(electrons) / at_reference, 1, 0.002) << electrons;
  }
}

TEST(CharacteriseTest, DefectsAreMappedHotDeadAndDull) {
  Emva1288Camera camera({}, kSize, 21);
  camera.offset_e.at(10, 20) = 4000;
  camera.response.at(30, 40) = 0;
  camera.response.at(50, 60) = 0.9F;
  camera.response.at(0, 0) = 1.1F;
  const SensorCharacterisation sensor = Characterise(camera);
  const Image<uint8_t>& defective = sensor.defects.defective;
  EXPECT_EQ(defective.at(10, 20), 1);
  EXPECT_EQ(defective.at(30, 40), 1);
  EXPECT_EQ(defective.at(50, 60), 1);
  EXPECT_EQ(defective.at(0, 0), 1);
  EXPECT_EQ(std::count(defective.pixels().begin(), defective.pixels().end(), 1), 4)
      << "their neighbours are sound";
  EXPECT_GT(sensor.defects.hot_share, 0);
  EXPECT_GT(sensor.defects.dead_share, 0);
}

TEST(CharacteriseTest, UnevenLightDoesNotEnterPrnu) {
  const Emva1288CameraTruth truth;
  Emva1288Camera camera(truth, kSize, 22);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      camera.response.at(x, y) *= 1 + 0.03F * (static_cast<float>(x) / kSize.width_px - 0.5F);
    }
  }
  const SensorCharacterisation sensor = Characterise(camera);
  EXPECT_NEAR(sensor.emva.prnu.value, truth.prnu, 0.01 * truth.prnu);
  EXPECT_GT(sensor.emva.prnu_unfiltered.value, 2 * truth.prnu);
}

TEST(CharacteriseTest, WithoutPhotonsThereIsNoQuantumEfficiency) {
  Emva1288Camera camera({}, kSize, 23);
  const SensorCharacterisation sensor = Characterise(camera, false);
  EXPECT_FALSE(sensor.emva.quantum_efficiency.has_value());
  EXPECT_FALSE(sensor.emva.threshold_photons.has_value());
  EXPECT_GT(sensor.emva.dynamic_range.value, 1000);
}

TEST(CharacteriseTest, BecomesTheSensorPartOfACalibration) {
  const Emva1288CameraTruth truth;
  Emva1288Camera camera(truth, kSize, 24);
  camera.response.at(30, 40) = 0;
  const SensorCharacterisation sensor = Characterise(camera);
  Calibration calibration;
  calibration.defects.defective = Image<uint8_t>(kSize);
  calibration.defects.defective.at(1, 1) = 1;
  ASSERT_TRUE(ApplySensor(sensor, calibration).ok());
  EXPECT_NEAR(calibration.noise.gain_dn_per_e, truth.gain_dn_per_e, 0.01 * truth.gain_dn_per_e);
  const double read_dn = truth.gain_dn_per_e * truth.dark_noise_e;
  EXPECT_NEAR(calibration.noise.read_variance_dn2, read_dn * read_dn, 0.02 * read_dn * read_dn);
  EXPECT_NEAR(calibration.noise.bias_dn, truth.offset_dn, 1);
  EXPECT_EQ(calibration.defects.defective.at(30, 40), 1);
  EXPECT_EQ(calibration.defects.defective.at(1, 1), 1) << "defects that were known stay";
  EXPECT_TRUE(calibration.linearity.has_value());

  calibration.noise.gain_db = 6;
  EXPECT_THAT(ApplySensor(sensor, calibration).message(), HasSubstr("6 dB"));
  calibration.defects.defective = Image<uint8_t>({8, 8});
  EXPECT_THAT(ApplySensor(sensor, calibration).message(), HasSubstr("region of interest"));
}

}  // namespace
}  // namespace eyebox::optics
