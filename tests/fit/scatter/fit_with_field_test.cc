// w and g from one sequence: a display that is not even, through an instrument that scatters.
#include "fit/scatter/fit_with_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fit/scatter/read_disk.h"
#include "optics/scatter/spread_light.h"
#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

constexpr double kPitchDeg = 0.1;
constexpr int kSize = 121;
constexpr int kMiddle = kSize / 2;
constexpr double kBright = 60;
const optics::ScatterKernel kLens{.core_radius_deg = 0.08,
                                  .tail_share = 0.2,
                                  .tail_radius_deg = 0.8,
                                  .tail_exponent = 2.6,
                                  .reach_deg = 12};
const DiskAim kAim{{kMiddle, kMiddle}, kPitchDeg};

double RadiusDeg(int x, int y) { return std::hypot(x - kMiddle, y - kMiddle) * kPitchDeg; }

// Falls by 45 % to the edge, with a tilt. The display ends at the image's edge.
double G(int x, int y) {
  const double r = RadiusDeg(x, y);
  return std::exp(-0.017 * r * r) * (1 + 0.01 * (x - kMiddle) * kPitchDeg);
}

double Covered(int x, int y, double radius_deg) {
  int inside = 0;
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < 8; ++i) {
      inside += std::hypot(x - kMiddle + (i - 3.5) / 8, y - kMiddle + (j - 3.5) / 8) * kPitchDeg <
                        radius_deg
                    ? 1
                    : 0;
    }
  }
  return inside / 64.0;
}

optics::LuminanceImage Photograph(GlarePattern pattern, double diameter_deg, uint64_t seed) {
  Image<float> scene({kSize, kSize});
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double disk = diameter_deg > 0 ? Covered(x, y, diameter_deg / 2) : 0;
      const double lit = pattern == GlarePattern::kBrightDisk ? disk : 1 - disk;
      scene.at(x, y) = static_cast<float>(kBright * lit * G(x, y));
    }
  }
  const auto seen = optics::SpreadLight(scene, kPitchDeg, kLens);
  EXPECT_TRUE(seen.ok()) << seen.status();
  RandomStream random({seed});
  optics::LuminanceImage frame;
  frame.image = optics::MakeMeasuredImage(scene.size(), "cd/m2");
  for (size_t i = 0; i < scene.pixels().size(); ++i) {
    const double light = std::max(seen->pixels()[i], 0.0F);
    const double variance = 1e-6 + 2e-5 * light;
    frame.image.value.pixels()[i] =
        static_cast<float>(light + std::sqrt(variance) * Gaussian(random));
    frame.image.variance.pixels()[i] = static_cast<float>(variance);
  }
  return frame;
}

struct Sequence {
  GlareSeries series{{}, kMiddle* kPitchDeg, "cd/m2", "simulated"};
  BrightField field;
};

Sequence Record() {
  Sequence sequence;
  uint64_t seed = 1;
  const auto add = [&](GlarePattern pattern, double diameter_deg) {
    const auto image = Photograph(pattern, diameter_deg, seed++);
    const auto readings = ReadDisk(image.image, {}, kAim, pattern, diameter_deg);
    ASSERT_TRUE(readings.ok()) << readings.status();
    auto& all = sequence.series.readings;
    all.insert(all.end(), readings->begin(), readings->end());
  };
  for (const double diameter : {0.3, 0.5, 0.8, 1.3, 2.0, 3.5, 6.0, 9.0}) {
    add(GlarePattern::kBrightDisk, diameter);
  }
  for (const double diameter : {0.0, 1.0, 2.0, 4.0}) add(GlarePattern::kBlackDisk, diameter);
  sequence.field = {Photograph(GlarePattern::kBlackDisk, 0, seed), kAim.axis, kPitchDeg, 1,
                    optics::Surround::kDark};
  return sequence;
}

// rms over the field of g / truth - 1, g being relative to the middle.
double ErrorOfG(const optics::MeasuredImage& field) {
  double middle = 0;
  for (int k = 0; k < 25; ++k)
    middle += field.value.at(kMiddle - 2 + k % 5, kMiddle - 2 + k / 5) / 25;
  double squares = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      squares += std::pow(field.value.at(x, y) / middle / G(x, y) - 1, 2);
    }
  }
  return std::sqrt(squares / (kSize * kSize));
}

TEST(FitWithField, BothComeOutBetterThanWhenEachNeglectsTheOther) {
  const Sequence sequence = Record();
  FieldFitOptions options;
  options.fit.reach_deg = kLens.reach_deg;
  options.fit.background_luminance = 0;
  options.rings = 12;
  const auto joint = FitScatterWithField(sequence.series, sequence.field, options);
  ASSERT_TRUE(joint.ok()) << joint.status();
  const auto even = FitScatter(sequence.series, options.fit);
  ASSERT_TRUE(even.ok()) << even.status();
  const double joint_w = std::abs(joint->fit.kernel.tail_share / kLens.tail_share - 1);
  const double even_w = std::abs(even->kernel.tail_share / kLens.tail_share - 1);
  const double joint_g = ErrorOfG(joint->removal.luminance.image);
  const double raw_g = ErrorOfG(sequence.field.luminance.image);
  std::printf("relative error of the tail's share: field as even %.4f, jointly %.4f\n", even_w,
              joint_w);
  std::printf("rms relative error of g: glare left in %.4f, jointly %.4f; %d rounds\n", raw_g,
              joint_g, joint->rounds);
  EXPECT_LT(joint_w, 0.5 * even_w);
  EXPECT_LT(joint_g, raw_g);
  EXPECT_NEAR(joint->fit.kernel.tail_share, kLens.tail_share, 4 * joint->fit.parameters[1].sigma);
}

TEST(FitWithField, RefusesAFieldWithoutLight) {
  Sequence sequence = Record();
  for (float& value : sequence.field.luminance.image.value.pixels()) value = 0;
  EXPECT_TRUE(
      absl::IsFailedPrecondition(FitScatterWithField(sequence.series, sequence.field).status()));
  FieldFitOptions options;
  options.rings = 1;
  EXPECT_TRUE(absl::IsInvalidArgument(
      FitScatterWithField(sequence.series, sequence.field, options).status()));
}

}  // namespace
}  // namespace eyebox::fit
