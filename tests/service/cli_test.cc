// The commands as they are typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "eyebox/v1/results.pb.h"
#include "tests/service/recorded_rig.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const char kFixture[] = EYEBOX_SOURCE_DIR "/fixtures/rift-s-like-seed1";

double Value(const google::protobuf::RepeatedPtrField<v1::Parameter>& parameters,
             const std::string& name) {
  for (const v1::Parameter& parameter : parameters) {
    if (parameter.name() == name) return parameter.value();
  }
  ADD_FAILURE() << "no parameter " << name;
  return 0;
}

TEST(Cli, HelpOfEveryCommandHasAnExample) {
  for (const char* command : {"run", "replay", "import", "simulate", "reduce", "uniformity", "fit",
                              "cube", "verify-files", "pack", "serve"}) {
    const Outcome help = RunEyebox(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_THAT(help.out, HasSubstr(std::string("eyebox ") + command)) << command;
  }
}

TEST(Cli, ReplayOfTheFixtureMeetsItsTruth) {
  const TemporaryFolder folder;
  const Outcome outcome = RunEyebox("replay " + std::string(kFixture) + " --out " +
                                    (folder / "out").string() + " --json");
  const auto result = ParsedFrom<v1::RunResult>(outcome);
  ASSERT_THAT(result.parameters(), Not(IsEmpty()));
  const v1::Parameter& gamma = result.activation().parameters(3);
  EXPECT_EQ(gamma.name(), "gamma");
  EXPECT_NEAR(gamma.value(), 2.3, 3 * gamma.sigma());
  EXPECT_LT(gamma.sigma(), 0.005 * gamma.value());
  for (const char* file : {"report.html", "uniformity.json", "activation.json", "linearize.cube",
                           "linearize.png", "result.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / file)) << file;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) {
    EXPECT_TRUE(entry.is_regular_file()) << entry.path() << ": the replayed frames were not kept";
  }
}

TEST(Cli, TheFixtureIsIntact) {
  const auto result = ParsedFrom<v1::VerifyFilesResult>(
      RunEyebox("verify-files " + std::string(kFixture) + " --json"));
  EXPECT_EQ(Value(result.parameters(), "frames"), 150);
}

TEST(Cli, StepsAloneAgreeWithTheWholeRun) {
  const TemporaryFolder folder;
  const std::string recording = RecordedRig();
  const auto run = ParsedFrom<v1::RunResult>(
      RunEyebox("run " + recording + " --out " + (folder / "out").string() + " --json"));
  const auto map =
      ParsedFrom<v1::UniformityResult>(RunEyebox("uniformity " + recording + " --json"));
  EXPECT_EQ(Value(map.parameters(), "uniformity_9_point"),
            Value(run.uniformity().parameters(), "uniformity_9_point"));
  const auto fit = ParsedFrom<v1::ActivationResult>(RunEyebox("fit " + recording + " --json"));
  EXPECT_EQ(Value(fit.parameters(), "gamma"), Value(run.activation().parameters(), "gamma"));
  const auto level =
      ParsedFrom<v1::ReduceResult>(RunEyebox("reduce " + recording + " --level 1 --json"));
  EXPECT_EQ(Value(level.parameters(), "mean"), Value(run.reduction().parameters(), "mean"));
}

TEST(Cli, ATableFollowsFromAFitThroughAFileOrAPipe) {
  const TemporaryFolder folder;
  const std::string fit = folder / "fit.json";
  ASSERT_EQ(
      RunEyebox("run " + std::string(kFixture) + " --out " + folder.path().string()).exit_code, 0);
  const std::string cube = folder / "again.cube";
  const auto table =
      ParsedFrom<v1::CubeResult>(RunEyebox("cube --fit " + (folder / "activation.json").string() +
                                           " --target hdrp --size 32 --out " + cube + " --json"));
  EXPECT_EQ(*ReadWholeFile(cube), *ReadWholeFile(folder / "linearize.cube"));
  EXPECT_EQ(table.file(), "again.cube");
  const std::string piped = folder / "piped.cube";
  EXPECT_EQ(RunEyebox("cube --fit - --target hdrp --out " + piped + " < " +
                      (folder / "activation.json").string())
                .exit_code,
            0);
  EXPECT_EQ(*ReadWholeFile(piped), *ReadWholeFile(cube));
}

TEST(Cli, ASimulationIsPackedWithoutLoss) {
  const TemporaryFolder folder;
  const std::string recording = folder / "recording";
  const auto simulated = ParsedFrom<v1::SimulateResult>(
      RunEyebox("simulate sim:rift-s-like --seed 9 --levels 5 --exposures 0.0125,0.1 --repeats 2 "
                "--json --out " +
                recording));
  EXPECT_EQ(Value(simulated.parameters(), "captures"), 2 + 2 + 5 * 2);
  EXPECT_THAT(*ReadWholeFile(recording + "/truth.json"), HasSubstr("\"seed\": 9"));
  const std::string packed = folder / "packed";
  EXPECT_EQ(RunEyebox("pack " + recording + " --out " + packed).exit_code, 0);
  const Outcome first = RunEyebox("fit " + recording + " --json");
  EXPECT_EQ(first.out, RunEyebox("fit " + packed + " --json").out);
  EXPECT_THAT(first.out, HasSubstr("gamma"));
}

TEST(Cli, ASeriesOfSeveralStimuliSaysWhichOneWasReduced) {
  const Outcome outcome = RunEyebox("reduce " + RecordedRig().string() + " --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("17 stimuli"), HasSubstr("--level")));
}

class RealInput : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_ / "luminance/achromatic_420.csv")) {
      GTEST_SKIP() << folder_ << " is absent: no measured data to compare with";
    }
  }
  const std::filesystem::path folder_ = EYEBOX_SOURCE_DIR "/../shared/reference";
  const TemporaryFolder out_;
};

TEST_F(RealInput, AMeasuredSeriesIsPredictedAndItsTablesCertified) {
  const Outcome fitted =
      RunEyebox("fit --csv " + (folder_ / "luminance/achromatic_420.csv").string() + " --json");
  const auto fit = ParsedFrom<v1::ActivationResult>(fitted);
  EXPECT_LE(fit.leave_one_out_rms_relative(), 0.012);  // published method: 0.0605
  EXPECT_GT(fit.condition_number(), 1);
  EXPECT_EQ(fit.source(), "achromatic_420.csv");
  ASSERT_TRUE(WriteFileAtomically(out_ / "fit.json", fitted.out).ok());
  const auto certified = [&](int size) {
    return ParsedFrom<v1::CubeResult>(RunEyebox("cube --fit " + (out_ / "fit.json").string() +
                                                " --target hdrp --json --size " +
                                                std::to_string(size) + " --out " +
                                                (out_ / "linearize.cube").string()))
        .certificate()
        .max_relative();
  };
  EXPECT_LE(certified(32), 0.008);
  EXPECT_LE(certified(64), 0.002);
}

TEST_F(RealInput, MeasuredFramesAreImportedAndMerged) {
  const std::string recording = out_ / "recording";
  const auto imported = ParsedFrom<v1::ImportResult>(
      RunEyebox("import " + (folder_ / "frames").string() + " --json --out " + recording));
  EXPECT_EQ(Value(imported.parameters(), "frames"), 28);
  const auto merged = ParsedFrom<v1::ReduceResult>(
      RunEyebox("reduce " + recording + " --series filter_550nm --json"));
  EXPECT_EQ(merged.exposures_size(), 7);
  ASSERT_EQ(merged.exposure_pairs_size(), 6);
  for (const v1::ExposurePair& pair : merged.exposure_pairs()) {
    EXPECT_GT(pair.pixels(), 1000);
    EXPECT_NEAR(pair.signal_ratio_over_time_ratio(), 1, 0.08);
  }
  EXPECT_GT(merged.hot_share(), 0);
  EXPECT_EQ(merged.valid_pixels() + merged.invalid_pixels(), 408 * 344);
  const Outcome unnamed = RunEyebox("reduce " + recording);
  EXPECT_EQ(unnamed.exit_code, 3);
  EXPECT_THAT(unnamed.err, AllOf(HasSubstr("--series"), HasSubstr("filter_650nm")));
}

}  // namespace
}  // namespace eyebox::service
