// The command, as a person runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "eyebox/v1/preflight.pb.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(PreflightCli, OfACleanRigPrintsATableAndIsDone) {
  const Outcome outcome = RunEyebox("preflight sim:rift-s-like");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("exposure_ladder"), HasSubstr("passed"),
                                 HasSubstr("connect a photodiode"), Not(HasSubstr("FAILED"))));
}

TEST(PreflightCli, OfAFaultyRigNamesCauseAndRemedyAndIsRejected) {
  const TemporaryFolder folder;
  const Outcome outcome =
      RunEyebox("preflight 'sim:rift-s-like?fault=gamma' --out " + (folder / "kept").string());
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("exposure_ladder FAILED"), HasSubstr("cause:  the"),
                                 HasSubstr("set gamma to 1")));
  EXPECT_THAT(outcome.err, HasSubstr("failed exposure_ladder"));
  v1::PreflightResult kept;
  ASSERT_TRUE(ReadJson(folder / "kept/preflight.json", kept).ok());
  EXPECT_FALSE(kept.passed());
}

TEST(PreflightCli, PrintsTheBoundOfAnExposureBetweenPeriods) {
  const Outcome outcome = RunEyebox(
      "preflight 'sim:rift-s-like?fault=strobe' --photodiode sim:strobe-90hz --exposures 0.0125");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("1.125 refresh periods"), HasSubstr("bound 1/n: 88.9 %"),
                                 HasSubstr("0.01111")));
}

TEST(PreflightCli, CertifiesWhatIsCapturedWithIt) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& preflight, const std::string& out) {
    return ParsedFrom<v1::RunResult>(
        RunEyebox("run sim:rift-s-like --json --out " + (folder / out).string() + preflight));
  };
  ASSERT_EQ(RunEyebox("preflight sim:rift-s-like --out " + (folder / "pre").string()).exit_code, 0);
  const v1::RunResult certified = run(" --preflight " + (folder / "pre").string(), "with");
  EXPECT_TRUE(certified.certified()) << certified.certification_reason();
  const auto replayed =
      ParsedFrom<v1::RunResult>(RunEyebox("replay " + (folder / "with/recording").string() +
                                          " --json --out " + (folder / "replayed").string()));
  EXPECT_TRUE(replayed.certified()) << replayed.certification_reason();
  const v1::RunResult without = run("", "without");
  EXPECT_FALSE(without.certified());
  ASSERT_GT(without.warnings_size(), 0);
  EXPECT_THAT(without.warnings(without.warnings_size() - 1), HasSubstr("not certified: no"));
}

TEST(PreflightCli, OfWhatIsNoRigIsBadInput) {
  EXPECT_EQ(RunEyebox("preflight nowhere").exit_code, 3);
  EXPECT_EQ(RunEyebox("preflight 'sim:rift-s-like?fault=smoke'").exit_code, 3);
  EXPECT_EQ(RunEyebox("preflight sim:rift-s-like --exposures 1e6").exit_code, 3);
  EXPECT_EQ(RunEyebox("preflight sim:rift-s-like --photodiode adc:0").exit_code, 3);
  EXPECT_EQ(RunEyebox("preflight").exit_code, 2);
  const TemporaryFolder folder;
  EXPECT_EQ(RunEyebox("run sim:rift-s-like --preflight " + (folder / "none").string() + " --out " +
                      (folder / "out").string())
                .exit_code,
            3);
  EXPECT_FALSE(std::filesystem::exists(folder / "out")) << "found before any light is measured";
}

}  // namespace
}  // namespace eyebox::service
