// The contract on every camera that opens without hardware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "capture/camera/rig.h"
#include "capture/recording/writer.h"
#include "capture/run.h"
#include "tests/capture/camera/aravis_fake_process.h"
#include "tests/contract/camera_contract.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {
namespace {

std::string SimUri(const std::filesystem::path&) { return "sim:rift-s-like"; }

std::string ReplayUri(const std::filesystem::path& folder) {
  auto rig = OpenRig({.name = "source", .camera_uri = "sim:rift-s-like"}, SystemClock());
  EXPECT_TRUE(rig.ok()) << rig.status();
  const CapturePlan plan = {{kBright, kLong}};
  auto writer = RecordingWriter::Create(folder / "recording",
                                        MakeHeader(*rig, plan, *SystemClock()), SystemClock());
  EXPECT_TRUE(writer.ok()) << writer.status();
  const auto report = RunPlan(*rig, plan, **writer);
  EXPECT_TRUE(report.ok()) << report.status();
  return "replay:" + (folder / "recording").string();
}

// A whole period of its ramp, so that the mean does not move with it.
std::string AravisFakeUri(const std::filesystem::path&) { return "aravis:fake?region=1024x8+0+0"; }

// A process of its own for every test, which ends with the next one or with the program.
std::string AravisGigEUri(const std::filesystem::path&) {
  static std::unique_ptr<FakeGigECamera> process;
  std::string why_not;
  EXPECT_TRUE(EnterPrivateNetwork(why_not)) << why_not;
  process.reset();
  process = FakeGigECamera::Start("C1");
  EXPECT_NE(process, nullptr) << "is aravis-tools installed?";
  return process ? process->uri() + "?region=512x512+0+0" : "";
}

const CameraCase kCases[] = {{"sim", SimUri},
                             {"replay", ReplayUri},
                             {"aravis_fake", AravisFakeUri},
                             {"aravis_gige", AravisGigEUri, false, false}};

std::string NameOf(const testing::TestParamInfo<CameraCase>& test) { return test.param.name; }

INSTANTIATE_TEST_SUITE_P(Cameras, CameraContract, testing::ValuesIn(kCases), NameOf);

// Only where the picture follows the exposure.
class CameraLight : public CameraContract {};
INSTANTIATE_TEST_SUITE_P(Cameras, CameraLight, testing::ValuesIn(kCases), NameOf);

TEST_P(CameraLight, TwiceTheExposureIsTwiceTheLight) {
  if (!GetParam().linear) GTEST_SKIP() << "it draws the logarithm of the exposure";
  const auto mean_dn = [this](const CaptureSpec& spec) {
    Begin(spec);
    double sum_dn = 0;
    const Frame frame = Take();
    for (const uint16_t count_dn : frame.view.pixels_dn) sum_dn += count_dn;
    return sum_dn / static_cast<double>(frame.view.pixels_dn.size());
  };
  const double short_dn = mean_dn(kBright);
  const double long_dn = mean_dn(kLong);
  constexpr double kBiasBelow_dn = 200;  // of every camera here
  EXPECT_GT(long_dn, 2 * short_dn - kBiasBelow_dn);
  EXPECT_LT(long_dn, 2 * short_dn + 1);
}

TEST(CameraRegistry, ListsItsSchemesForAnUnknownOne) {
  const auto schemes = CameraSchemes();
  EXPECT_THAT(schemes, testing::IsSupersetOf({"sim", "replay"}));
  const absl::Status status = OpenRig({.name = "a", .camera_uri = "usb:0"}, SystemClock()).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  for (const std::string& scheme : schemes) {
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr(scheme + ":"));
  }
}

TEST(CameraRegistry, AReplayOfWhatIsNoRecordingIsNotFound) {
  const TemporaryFolder folder;
  EXPECT_TRUE(absl::IsNotFound(
      OpenRig({.name = "a", .camera_uri = "replay:" + folder.path().string()}, SystemClock())
          .status()));
  EXPECT_TRUE(absl::IsInvalidArgument(
      OpenRig({.name = "a", .camera_uri = "replay:"}, SystemClock()).status()));
}

}  // namespace
}  // namespace eyebox::capture
