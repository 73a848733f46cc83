// Tables behind half floats, packed buffers, coarse filters and 8-bit output: certificates are
// confirmed by arithmetic of the test's own.
#include "fit/cube/storage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "fit/cube/design_table.h"
#include "tests/fit/cube/evaluator.h"

namespace eyebox::fit {
namespace {

using evaluator::Display;
using evaluator::Real;

constexpr int kSamples = 30011;

// To `bits` bits behind the leading one; values here are far above the denormals.
Real Cut(Real value, int bits, bool to_nearest) {
  if (value <= 0) return 0;
  int exponent = 0;
  const Real mantissa = std::frexp(value, &exponent);
  const Real scaled = std::ldexp(mantissa, bits + 1);
  const Real kept = to_nearest ? std::nearbyint(scaled) : std::floor(scaled);
  return std::ldexp(kept, exponent - bits - 1);
}

evaluator::Errors MeasureStored(const Display& display, const TableDesign& table,
                                const StorageModel& storage, int buffer_bits) {
  return evaluator::Measure(display, 0.05L, kSamples, [&](Real u) {
    if (storage.r11g11b10) u = Cut(u, buffer_bits, false);
    const Real position = evaluator::HdrpAxis(u) * (table.size - 1);
    const auto below = static_cast<size_t>(position);
    Real weight = position - static_cast<Real>(below);
    if (storage.filter8) weight = std::round(256 * weight) / 256;
    Real low = table.entries[below];
    Real high = table.entries[below + 1];
    if (storage.half) {
      low = Cut(low, 10, true);
      high = Cut(high, 10, true);
    }
    Real mix = low + weight * (high - low);
    if (storage.r11g11b10) mix = Cut(mix, buffer_bits, false);
    const Real drive = std::clamp<Real>(evaluator::EncodeSrgb(mix), 0, 1);
    return storage.output8 ? std::round(255 * drive) / 255 : drive;
  });
}

std::vector<StorageModel> Models() {
  return {{.half = true},
          {.r11g11b10 = true},
          {.filter8 = true},
          {.output8 = true},
          {.half = true, .r11g11b10 = true, .filter8 = true, .output8 = true}};
}

TEST(StorageTest, CertificateAfterEachModelIsConfirmed) {
  const Display display{2, 200, 0, 2.2L};
  const Activation activation = ActivationOf(display);
  const auto table = *DesignTable(activation, TableTarget::kHdrp, 32);
  for (const StorageModel& storage : Models()) {
    const auto stored = CertifyStored(table, activation, {}, storage);
    ASSERT_TRUE(stored.ok()) << stored.status();
    const int bits = stored->worst_channel == Channel::kBlue ? 5 : 6;
    const auto measured = MeasureStored(display, table, storage, bits);
    const Certificate& certificate = stored->certificate;
    std::printf("%-32s %-5s max %.3f %% rms %.3f %% at %.4f, step %.2f %%; confirmed %.3Lf %%\n",
                NameOf(storage).c_str(), std::string(NameOf(stored->worst_channel)).c_str(),
                100 * certificate.max_relative, 100 * certificate.rms_relative, certificate.at_u,
                100 * certificate.contrast_step_8bit, 100 * measured.worst);
    EXPECT_LE(measured.worst, certificate.max_relative * 1.002);
    EXPECT_GE(measured.worst, certificate.max_relative * 0.97);
    EXPECT_NEAR(static_cast<double>(measured.rms), certificate.rms_relative,
                0.01 * certificate.rms_relative);
    EXPECT_EQ(stored->worst_channel == Channel::kGrey, !storage.r11g11b10);
  }
}

TEST(StorageTest, DesignForTheWayBeatsDesignForAnExactOne) {
  const Display display{0, 200, 0, 2.2L};
  const Activation activation = ActivationOf(display);
  const auto exact = *DesignTable(activation, TableTarget::kHdrp, 32);
  for (const StorageModel& storage : Models()) {
    const auto designed =
        DesignTable(activation, TableTarget::kHdrp, 32, {.designed_for = storage});
    ASSERT_TRUE(designed.ok()) << designed.status();
    const double before = CertifyStored(exact, activation, {}, storage)->certificate.max_relative;
    const double after =
        CertifyStored(*designed, activation, {}, storage)->certificate.max_relative;
    std::printf("%-32s designed exact %.3f %%, in the loop %.3f %%\n", NameOf(storage).c_str(),
                100 * before, 100 * after);
    EXPECT_TRUE(std::ranges::is_sorted(designed->entries));
    EXPECT_LE(after, before * 1.001);
    if (storage.r11g11b10) {
      EXPECT_LT(after, 0.8 * before) << "truncation darkens, which can be allowed for";
    }
  }
}

TEST(StorageTest, HalfFloatsAreWhatTheFileHolds) {
  const auto table =
      *DesignTable({1, 100, 0, 2.2}, TableTarget::kHdrp, 64, {.designed_for = {.half = true}});
  for (double entry : table.entries) {
    if (entry > 1e-4) {
      EXPECT_EQ(entry, static_cast<double>(Cut(entry, 10, true)));
    }
  }
}

TEST(StorageTest, NamesAreReadBack) {
  for (const StorageModel& storage : Models()) EXPECT_EQ(*StorageModelOf(NameOf(storage)), storage);
  EXPECT_TRUE(StorageModelOf("exact")->IsExact());
  for (const char* bad : {"", "half,", "Half", "half filter8", "exact,half"}) {
    EXPECT_THAT(std::string(StorageModelOf(bad).status().message()),
                testing::HasSubstr("half, r11g11b10, filter8 and output8"))
        << bad;
  }
}

TEST(StorageTest, WhatATargetDoesNotHaveIsRefused) {
  const Activation activation;
  const auto refused = [&](TableTarget target, int size, const StorageModel& storage) {
    const auto table = *DesignTable(activation, target, size);
    return CertifyStored(table, activation, {}, storage).status().code() ==
           absl::StatusCode::kInvalidArgument;
  };
  EXPECT_TRUE(refused(TableTarget::kPps, 16, {.half = true}));
  EXPECT_TRUE(refused(TableTarget::kResolve, 16, {.r11g11b10 = true}));
  EXPECT_TRUE(refused(TableTarget::kPtb, 256, {.filter8 = true}));
  EXPECT_FALSE(refused(TableTarget::kPtb, 256, {.output8 = true}));
  EXPECT_FALSE(refused(TableTarget::kPps, 16, {.filter8 = true, .output8 = true}));
  for (const DesignOptions& options :
       {DesignOptions{.method = DesignMethod::kPublished, .designed_for = {.half = true}}}) {
    EXPECT_FALSE(DesignTable(activation, TableTarget::kHdrp, 32, options).ok());
  }
  EXPECT_FALSE(
      DesignTable(activation, TableTarget::kPps, 16, {.designed_for = {.output8 = true}}).ok());
}

}  // namespace
}  // namespace eyebox::fit
