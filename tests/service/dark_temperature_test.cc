// A camera that warms up while it measures, and the darks that belong to each level.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "service/simulate.h"
#include "service/steps/calibrate.h"
#include "service/steps/levels.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

class DarkTemperature : public testing::Test {
 protected:
  std::unique_ptr<capture::RecordingReader> Record(const std::string& camera, int dark_every) {
    SimulateRequest request;
    request.rig = {.name = "test", .camera_uri = camera, .seed = 5};
    request.plan.levels = 9;
    request.plan.exposures_s = {0.0125, 0.1, 2};
    request.plan.dark_every = dark_every;
    request.recording = folder_.path() / std::to_string(++recordings_);
    const auto made = Simulate(request, {});
    EXPECT_TRUE(made.ok()) << made.status();
    return *capture::RecordingReader::Open(request.recording);
  }

  static absl::StatusOr<MeasuredLevels> Reduce(capture::RecordingReader& recording) {
    const auto calibration = CalibrateCamera(recording, {});
    if (!calibration.ok()) return calibration.status();
    return ReduceGreyLevels(recording, "", *calibration, {});
  }

 private:
  const TemporaryFolder folder_;
  int recordings_ = 0;
};

TEST_F(DarkTemperature, DarksBetweenTheLevelsAreMatched) {
  const auto steady = Reduce(*Record("sim:rift-s-like", 0));
  const auto warming = Reduce(*Record("sim:rift-s-like?fault=warming", 2));
  ASSERT_TRUE(steady.ok()) << steady.status();
  ASSERT_TRUE(warming.ok()) << warming.status();
  for (size_t i = 0; i < steady->series.readings.size(); ++i) {
    const auto& a = steady->series.readings[i];
    const auto& b = warming->series.readings[i];
    EXPECT_NEAR(a.luminance, b.luminance, 5 * std::hypot(a.luminance_sigma, b.luminance_sigma))
        << a.drive;
  }
  EXPECT_THAT(warming->reference.reduced.luminance.image.history,
              Contains(AllOf(HasSubstr("MatchDark("), HasSubstr("degC"))));
}

TEST_F(DarkTemperature, DarksOfAColdCameraAreNotTakenForAHotOne) {
  const auto levels = Reduce(*Record("sim:rift-s-like?fault=warming", 0));
  EXPECT_TRUE(absl::IsFailedPrecondition(levels.status())) << levels.status();
  EXPECT_THAT(std::string(levels.status().message()),
              AllOf(HasSubstr("nearest dark at 2"), HasSubstr("DN of dark current"),
                    HasSubstr("record darks between the lights")));
}

}  // namespace
}  // namespace eyebox::service
