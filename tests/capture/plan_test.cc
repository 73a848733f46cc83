#include "capture/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

std::vector<CaptureSpec> OfKind(const CapturePlan& plan, FrameKind kind) {
  std::vector<CaptureSpec> found;
  std::ranges::copy_if(plan.captures, std::back_inserter(found),
                       [kind](const CaptureSpec& spec) { return spec.kind == kind; });
  return found;
}

TEST(GreyPlan, TakesEveryLevelAtEveryExposure) {
  const auto plan = MakeGreyPlan({});
  ASSERT_TRUE(plan.ok()) << plan.status();
  const auto lights = OfKind(*plan, FrameKind::kLight);
  EXPECT_EQ(lights.size(), 17 * 3);
  std::set<std::pair<int, double>> seen;
  for (const CaptureSpec& spec : lights) {
    const double drive = spec.level_id / 16.0;
    EXPECT_EQ(spec.stimulus.pattern, StimulusPattern::kFullField);
    EXPECT_EQ(spec.stimulus.drive, (DriveRgb{drive, drive, drive}));
    EXPECT_EQ(spec.repeats, 2);
    EXPECT_EQ(spec.series, "");
    seen.insert({spec.level_id, spec.exposure_s});
  }
  EXPECT_EQ(seen.size(), lights.size());
}

TEST(GreyPlan, HasADarkOfEveryExposureAndGain) {
  const auto plan = MakeGreyPlan({.gain_db = 6});
  ASSERT_TRUE(plan.ok()) << plan.status();
  const auto darks = OfKind(*plan, FrameKind::kDark);
  for (const CaptureSpec& spec : plan->captures) {
    EXPECT_EQ(spec.gain_db, 6);
    EXPECT_TRUE(std::ranges::any_of(
        darks, [&](const CaptureSpec& dark) { return dark.exposure_s == spec.exposure_s; }));
  }
}

TEST(GreyPlan, FlatsCarryTheirKnownLuminance) {
  const auto plan =
      MakeGreyPlan({.flat_luminance_cd_m2 = 12, .flat_luminance_relative_sigma = 0.01});
  ASSERT_TRUE(plan.ok()) << plan.status();
  const auto flats = OfKind(*plan, FrameKind::kFlat);
  EXPECT_EQ(flats.size(), 3);
  for (const CaptureSpec& flat : flats) {
    EXPECT_EQ(flat.luminance_cd_m2, 12);
    EXPECT_EQ(flat.luminance_relative_sigma, 0.01);
    EXPECT_EQ(flat.repeats, 8);
  }
}

TEST(GreyPlan, WithoutFlatsHasNone) {
  const auto plan = MakeGreyPlan({.flat_repeats = 0, .flat_luminance_cd_m2 = 0});
  ASSERT_TRUE(plan.ok()) << plan.status();
  EXPECT_TRUE(OfKind(*plan, FrameKind::kFlat).empty());
}

TEST(GreyPlan, OrderOfLevelsIsRandomButRepeatable) {
  const auto first = MakeGreyPlan({.seed = 1});
  const auto again = MakeGreyPlan({.seed = 1});
  const auto other = MakeGreyPlan({.seed = 2});
  ASSERT_TRUE(first.ok() && again.ok() && other.ok());
  EXPECT_EQ(first->captures, again->captures);
  EXPECT_NE(first->captures, other->captures);
  const auto lights = OfKind(*first, FrameKind::kLight);
  EXPECT_FALSE(std::ranges::is_sorted(lights, {}, &CaptureSpec::level_id));
}

TEST(GreyPlan, ReferencesStandFirstLastAndEverySoManyLevels) {
  const auto plan = MakeGreyPlan({.levels = 5,
                                  .exposures_s = {0.1, 0.4},
                                  .flat_repeats = 0,
                                  .reference_every = 2,
                                  .reference_drive = 0.25});
  ASSERT_TRUE(plan.ok()) << plan.status();
  std::string order;
  for (const CaptureSpec& spec : OfKind(*plan, FrameKind::kLight)) {
    const bool reference = spec.role == CaptureRole::kReference;
    order += reference ? 'R' : 'l';
    if (!reference) continue;
    EXPECT_EQ(spec.series, kReferenceSeries);
    EXPECT_EQ(spec.stimulus.drive, (DriveRgb{0.25, 0.25, 0.25}));
    EXPECT_EQ(spec.exposure_s, 0.1);
    EXPECT_EQ(spec.repeats, 4);
    EXPECT_EQ(spec.level_id, -1);
  }
  EXPECT_EQ(order, "RllllRllllRllR");  // two exposures a level
}

TEST(GreyPlan, ReferencesLeaveTheOrderOfLevelsAsItIs) {
  auto with = MakeGreyPlan({.reference_every = 4});
  const auto without = MakeGreyPlan({});
  ASSERT_TRUE(with.ok() && without.ok());
  std::erase_if(with->captures,
                [](const CaptureSpec& spec) { return spec.role == CaptureRole::kReference; });
  EXPECT_EQ(with->captures, without->captures);
}

TEST(GreyPlan, DarksComeBackAfterEverySoManyLevelsAndAfterTheLast) {
  const auto plan =
      MakeGreyPlan({.levels = 5, .exposures_s = {0.1, 0.4}, .dark_every = 2, .flat_repeats = 0});
  ASSERT_TRUE(plan.ok()) << plan.status();
  std::string order;
  for (const CaptureSpec& spec : plan->captures) order += spec.kind == FrameKind::kDark ? 'd' : 'l';
  EXPECT_EQ(order, "ddllllddllllddlldd");  // two exposures a level
}

TEST(GreyPlan, EveryOrderIsEquallyLikely) {
  int first_place[4] = {};
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    const auto plan =
        MakeGreyPlan({.levels = 4, .exposures_s = {1}, .flat_repeats = 0, .seed = seed});
    ASSERT_TRUE(plan.ok());
    ++first_place[OfKind(*plan, FrameKind::kLight).front().level_id];
  }
  for (const int count : first_place) EXPECT_NEAR(count, 1000, 4.5 * std::sqrt(750));
}

TEST(GreyPlan, RefusesOptionsByName) {
  const auto message = [](const PlanOptions& options) {
    const absl::Status status = MakeGreyPlan(options).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    return std::string(status.message());
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({.levels = 1}), HasSubstr("levels"));
  EXPECT_THAT(message({.exposures_s = {}}), HasSubstr("exposures_s"));
  EXPECT_THAT(message({.exposures_s = {0.1, 0}}), HasSubstr("exposures_s"));
  EXPECT_THAT(message({.exposures_s = {0.1, nan}}), HasSubstr("exposures_s"));
  EXPECT_THAT(message({.exposures_s = {0.1, 0.1}}), HasSubstr("ascending"));
  EXPECT_THAT(message({.gain_db = nan}), HasSubstr("gain_db"));
  EXPECT_THAT(message({.dark_every = -1}), HasSubstr("dark_every"));
  EXPECT_THAT(message({.repeats = 0}), HasSubstr("repeats"));
  EXPECT_THAT(message({.dark_repeats = 0}), HasSubstr("dark_repeats"));
  EXPECT_THAT(message({.flat_repeats = -1}), HasSubstr("flat_repeats"));
  EXPECT_THAT(message({.reference_every = -1}), HasSubstr("reference_every"));
  EXPECT_THAT(message({.reference_every = 4, .reference_drive = 0}), HasSubstr("reference_drive"));
  EXPECT_THAT(message({.reference_every = 4, .reference_drive = nan}),
              HasSubstr("reference_drive"));
  EXPECT_THAT(message({.reference_every = 4, .reference_repeats = 0}),
              HasSubstr("reference_repeats"));
  EXPECT_THAT(message({.flat_luminance_cd_m2 = 0}), HasSubstr("flat_luminance_cd_m2"));
  EXPECT_THAT(message({.flat_luminance_relative_sigma = nan}),
              HasSubstr("flat_luminance_relative_sigma"));
}

TEST(GreyPlan, DisksFollowTheLevelsWithTheFieldsThatTheyNeed) {
  const auto plan = MakeGreyPlan({.levels = 2,
                                  .exposures_s = {0.1},
                                  .disk_diameters_deg = {1, 5},
                                  .black_disk_diameters_deg = {2},
                                  .checkerboard_squares_deg = {4},
                                  .disk_drive = 0.8});
  ASSERT_TRUE(plan.ok()) << plan.status();
  std::vector<Stimulus> glare;
  for (const CaptureSpec& spec : plan->captures) {
    if (spec.series == kGlareSeries) glare.push_back(spec.stimulus);
  }
  const DriveRgb bright = {0.8, 0.8, 0.8};
  const std::vector<Stimulus> expected = {{StimulusPattern::kFullField, 0, DriveRgb{0, 0, 0}},
                                          {StimulusPattern::kFullField, 0, bright},
                                          {StimulusPattern::kDisk, 1, bright},
                                          {StimulusPattern::kDisk, 5, bright},
                                          {StimulusPattern::kBlackDisk, 2, bright},
                                          {StimulusPattern::kCheckerboard, 4, bright}};
  EXPECT_EQ(glare, expected);
  EXPECT_EQ(plan->captures.back().series, kGlareSeries);
  const auto referenced = MakeGreyPlan({.reference_every = 4, .disk_diameters_deg = {1}});
  ASSERT_TRUE(referenced.ok());
  EXPECT_EQ(referenced->captures.back().role, CaptureRole::kReference) << "after the disks too";
  EXPECT_THAT(std::string(MakeGreyPlan({.disk_diameters_deg = {0}}).status().message()),
              HasSubstr("disk_diameters_deg"));
}

}  // namespace
}  // namespace eyebox::capture
