// Contrast through a lens that scatters, beside that of the same display through one that does not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "capture/base/clock.h"
#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "service/contrast.h"
#include "service/scatter.h"
#include "service/steps/record_plan.h"
#include "tests/support/restless_display.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kTailEndsDeg = 20.85;  // 80 px

class Contrast : public testing::Test {
 protected:
  // Every frame takes 10 ms of the clock. `lost_per_s` of the light is lost in a second.
  std::filesystem::path Record(const std::string& name, double tail_share,
                               const capture::PlanOptions& plan, double lost_per_s = 0) {
    ManualClock clock;
    capture::SimParameters parameters;
    parameters.scatter.tail_weight = tail_share;
    auto rig =
        OpenSimRig({.name = name, .camera_uri = "sim:rift-s-like", .seed = 5}, parameters, &clock);
    EXPECT_TRUE(rig.ok()) << rig.status();
    if (lost_per_s > 0) {
      const auto fades = [lost_per_s](const capture::DisplayMoment& moment) {
        return capture::DisplayFault{.factor =
                                         1 - lost_per_s * static_cast<double>(moment.now_ns) / 1e9};
      };
      capture::MakeRestless(*rig, clock, parameters.sensor.bias_dn, fades);
    }
    const auto report = RecordPlan(*rig, *capture::MakeGreyPlan(plan), folder_.path() / name, {});
    EXPECT_TRUE(report.ok()) << report.status();
    return folder_.path() / name;
  }

  std::filesystem::path ScatterOf(const std::filesystem::path& recording) {
    ScatterRequest request;
    request.source = recording;
    request.fit.reach_deg = kTailEndsDeg;
    request.out = folder_.path() / "scatter";
    const auto result = MeasureScatter(request, {});
    EXPECT_TRUE(result.ok()) << result.status();
    return request.out / "scatter.json";
  }

  static v1::ContrastResult Measured(const std::filesystem::path& recording,
                                     const std::filesystem::path& scatter) {
    ContrastRequest request;
    request.recording = recording;
    request.scatter = scatter;
    const auto result = MeasureContrast(request, {});
    EXPECT_TRUE(result.ok()) << result.status();
    return result.value_or(v1::ContrastResult());
  }

  static v1::GlareFigure Named(const v1::ContrastResult& result, const std::string& name) {
    for (const v1::GlareFigure& figure : result.figures()) {
      if (figure.name() == name) return figure;
    }
    ADD_FAILURE() << "no " << name;
    return {};
  }

  const TemporaryFolder folder_;
};

TEST_F(Contrast, OfACheckerboardIsTheDisplaysOnceTheLensIsTakenOut) {
  capture::PlanOptions plan = {.levels = 2,
                               .disk_diameters_deg = {0.5, 1, 2, 4, 8, 16, 24},
                               .black_disk_diameters_deg = {2, 5, 10},
                               .checkerboard_squares_deg = {5}};
  const auto hazy = Record("hazy", 0.02, plan);
  const auto result = Measured(hazy, ScatterOf(hazy));
  EXPECT_THAT(result.warnings(), ElementsAre(HasSubstr("without a reference")));
  plan.disk_diameters_deg = plan.black_disk_diameters_deg = {};
  const v1::GlareFigure clear =
      Named(Measured(Record("clear", 0, plan), {}), "checkerboard_contrast");
  const v1::GlareFigure seen = Named(result, "checkerboard_contrast");
  const v1::GlareFigure corrected = Named(result, "checkerboard_contrast_of_display");
  EXPECT_LT(seen.value(), 0.4 * clear.value());
  EXPECT_GT(seen.floor(), seen.value()) << "the display's own black is seen too";
  EXPECT_LT(seen.floor(), 1.5 * seen.value());
  EXPECT_EQ(corrected.diameter_deg(), 5);
  EXPECT_NEAR(corrected.value(), clear.value(), 4 * std::hypot(corrected.sigma(), clear.sigma()));
  EXPECT_LT(corrected.sigma(), 0.03 * corrected.value());
}

TEST_F(Contrast, WithoutTheInstrumentsScatterItSaysSo) {
  const auto result =
      Measured(Record("plain", 0.02, {.levels = 2, .black_disk_diameters_deg = {5}}), {});
  EXPECT_THAT(result.warnings(), ElementsAre(HasSubstr("scatter is not known")));
  EXPECT_NEAR(Named(result, "full_field_contrast").value(), 59 / 0.19, 10);
  EXPECT_EQ(Named(result, "black_spot_glare").instrument_share(), 0);
}

TEST_F(Contrast, ADisplayThatFadesMeanwhileIsCorrectedForIt) {
  capture::PlanOptions plan = {.levels = 5,
                               .reference_every = 1,
                               .disk_diameters_deg = {1, 2, 4, 8, 16, 24},
                               .black_disk_diameters_deg = {5}};
  const auto share = [](const v1::ContrastResult& result) {
    return Named(result, "black_spot_glare");
  };
  const v1::GlareFigure steady = share(Measured(Record("steady", 0.02, plan), {}));
  const auto fading = Measured(Record("fading", 0.02, plan, 0.04), {});
  EXPECT_THAT(fading.warnings(), Contains(HasSubstr("the display drifted")));
  EXPECT_NEAR(share(fading).value() / steady.value(), 1, 0.01);
  plan.reference_every = 0;
  const v1::GlareFigure unseen = share(Measured(Record("unseen", 0.02, plan, 0.04), {}));
  EXPECT_LT(unseen.value() / steady.value(), 0.98) << "the drift is worth correcting";
}

TEST_F(Contrast, ARecordingWithoutItIsToldWhatToRecord) {
  ContrastRequest request;
  request.recording = Record("levels", 0.02, {.levels = 2});
  const auto result = MeasureContrast(request, {});
  EXPECT_TRUE(absl::IsFailedPrecondition(result.status())) << result.status();
  EXPECT_THAT(std::string(result.status().message()),
              AllOf(HasSubstr("levels"), HasSubstr("--checkerboards")));
}

}  // namespace
}  // namespace eyebox::service
