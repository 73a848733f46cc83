// Frames that are late, come twice or out of turn: what ends up on disk is whole and in order.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "capture/recording/reader.h"
#include "capture/run.h"
#include "tests/support/faulty_camera.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {
namespace {

class CameraFaults : public testing::TestWithParam<CameraFault> {
 protected:
  void SetUp() override {
    SimParameters parameters;
    parameters.sensor.size = {.width_px = 8, .height_px = 6};
    const RigConfig config = {.name = "test", .camera_uri = "sim:rift-s-like", .seed = 4};
    auto rig = OpenSimRig(config, parameters, &clock_);
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
    auto plan = MakeGreyPlan(
        {.levels = 2, .exposures_s = {0.01}, .repeats = 4, .dark_repeats = 2, .flat_repeats = 0});
    ASSERT_TRUE(plan.ok()) << plan.status();
    plan_ = *std::move(plan);  // a dark of 2 frames, then 2 levels of 4
  }

  absl::StatusOr<RunReport> RunWith(FaultyCamera::FaultOf fault) {
    rig_.camera = std::make_unique<FaultyCamera>(std::move(rig_.camera), std::move(fault));
    const auto writer =
        RecordingWriter::Create(path_, MakeHeader(rig_, plan_, clock_), SystemClock());
    if (!writer.ok()) return writer.status();
    return RunPlan(rig_, plan_, **writer);
  }

  ManualClock clock_{10, 1700000000000000000};
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "recording";
  Rig rig_;
  CapturePlan plan_;
};

INSTANTIATE_TEST_SUITE_P(Faults, CameraFaults,
                         testing::Values(CameraFault::kDropped, CameraFault::kIncomplete,
                                         CameraFault::kTimedOut, CameraFault::kLate,
                                         CameraFault::kDuplicated, CameraFault::kReordered));

TEST_P(CameraFaults, OnceMakesTheCaptureBeTakenAgain) {
  for (int at = 3; at <= 4; ++at) {  // the second and the third frame of the second capture
    SetUp();
    std::filesystem::remove_all(path_);
    const auto report =
        RunWith([at](int frame) { return frame == at ? GetParam() : CameraFault::kNone; });
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_EQ(report->captures_taken_again, 1);
    const auto reader = RecordingReader::Open(path_);
    ASSERT_TRUE(reader.ok()) << reader.status();
    ASSERT_EQ((*reader)->Captures().size(), 3U);
    for (const CaptureEntry& capture : (*reader)->Captures()) {
      EXPECT_EQ(capture.frame_count, capture.spec.repeats);
      std::optional<uint64_t> previous;
      const absl::Status status = (*reader)->VisitFrames(capture, [&](const Frame& frame) {
        const uint64_t id = frame.metadata.camera_frame_id;
        EXPECT_EQ(id, previous.value_or(id - 1) + 1);
        previous = id;
        return absl::OkStatus();
      });
      EXPECT_TRUE(status.ok()) << status;
    }
  }
}

TEST_P(CameraFaults, ThatPersistEndTheRunAndLeaveWhatWasWhole) {
  const auto report =
      RunWith([](int frame) { return frame < 3 ? CameraFault::kNone : GetParam(); });
  EXPECT_TRUE(absl::IsUnavailable(report.status())) << report.status();
  const auto verified = VerifyRecording(path_);
  ASSERT_TRUE(verified.ok()) << verified.status();
  EXPECT_EQ(verified->captures, 1);
  EXPECT_EQ(verified->frames, 2);
}

}  // namespace
}  // namespace eyebox::capture
