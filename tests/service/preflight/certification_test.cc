#include "service/preflight/certification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/base/clock.h"
#include "capture/base/file.h"
#include "capture/camera/sim/sim_rig.h"
#include "service/preflight/describe.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

class CertificationTest : public testing::Test {
 protected:
  CertificationTest() {
    header_.rig = {.name = "bench", .camera_uri = "sim:bench"};
    header_.camera.serial = "rift-s-like";
    header_.plan.captures.resize(2);
    header_.plan.captures[0].exposure_s = 0.0125;
    header_.plan.captures[1].exposure_s = 3;
    header_.plan.captures[1].kind = FrameKind::kDark;
  }

  v1::PreflightResult Preflight(std::vector<Check> checks) {
    const auto rig = capture::OpenSimRig(header_.rig, {}, &clock_);
    EXPECT_TRUE(rig.ok()) << rig.status();
    return DescribePreflight(checks, *rig, std::vector{0.0125}, 7);
  }
  Certification Of(const v1::PreflightResult& preflight) {
    EXPECT_TRUE(WritePreflight(folder_.path(), preflight).ok());
    return CertificationOf(folder_.path(), header_);
  }

  static Check Named(const std::string& name, Verdict verdict) {
    return {.name = name, .verdict = verdict, .wanted = "1"};
  }
  const std::vector<Check> passed_ = {Named("ladder", Verdict::kPassed),
                                      Named("refresh", Verdict::kSkipped)};
  const ManualClock clock_;
  const TemporaryFolder folder_;
  capture::RecordingHeader header_;
};

TEST_F(CertificationTest, OfAPassedPreflightNamesWhatWasSkipped) {
  const Certification certification = Of(Preflight(passed_));
  EXPECT_TRUE(certification.certified) << certification.reason;
  EXPECT_THAT(certification.reason, HasSubstr("not checked: refresh"));
}

TEST_F(CertificationTest, IsBlockedByAFailedCheckWhichIsNamed) {
  std::vector<Check> checks = passed_;
  checks.push_back(Named("moire", Verdict::kFailed));
  const Certification certification = Of(Preflight(checks));
  EXPECT_FALSE(certification.certified);
  EXPECT_THAT(certification.reason, HasSubstr("failed: moire"));
}

TEST_F(CertificationTest, IsNoneWithoutAPreflightOrWithADamagedOne) {
  EXPECT_THAT(CertificationOf(folder_.path(), header_).reason, HasSubstr("eyebox preflight"));
  ASSERT_TRUE(WriteFileAtomically(folder_.path() / kPreflightFile, "{\"passed\": tr").ok());
  EXPECT_FALSE(CertificationOf(folder_.path(), header_).certified);
  EXPECT_THAT(CertificationOf(folder_.path(), header_).reason, HasSubstr("cannot be read"));
}

TEST_F(CertificationTest, IsNoneWhereThePreflightSaysNothing) {
  EXPECT_FALSE(Of(Preflight({})).certified);
  v1::PreflightResult claim;
  claim.set_passed(true);
  claim.set_camera_serial("rift-s-like");
  EXPECT_FALSE(Of(claim).certified);
}

TEST_F(CertificationTest, IsOfThisCameraAndTheseExposuresAlone) {
  v1::PreflightResult other = Preflight(passed_);
  other.set_camera_serial("another");
  EXPECT_THAT(Of(other).reason, HasSubstr("another camera"));
  header_.plan.captures[0].exposure_s = 0.013;
  const Certification certification = Of(Preflight(passed_));
  EXPECT_FALSE(certification.certified);
  EXPECT_THAT(certification.reason, HasSubstr("0.013 s"));
}

TEST_F(CertificationTest, ComesFromAFileOrItsFolder) {
  const v1::PreflightResult preflight = Preflight(passed_);
  ASSERT_TRUE(WritePreflight(folder_.path(), preflight).ok());
  for (const auto& place : {folder_.path(), folder_.path() / kPreflightFile}) {
    const auto read = ReadPreflight(place);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(read->SerializeAsString(), preflight.SerializeAsString());
  }
  EXPECT_TRUE(absl::IsNotFound(ReadPreflight(folder_.path() / "none").status()));
}

}  // namespace
}  // namespace eyebox::service
