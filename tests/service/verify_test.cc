// `eyebox verify`, `eyebox cube --probe` and tables for a field, as they are typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "absl/strings/str_format.h"
#include "capture/base/file.h"
#include "capture/base/npy.h"
#include "eyebox/v1/results.pb.h"
#include "eyebox/v1/table.pb.h"
#include "eyebox/v1/verify.pb.h"
#include "fit/cube/gamma_table.h"
#include "service/result_json.h"
#include "service/results/parameter.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

const char kFixture[] = EYEBOX_SOURCE_DIR "/fixtures/rift-s-like-seed1";

double Value(const google::protobuf::RepeatedPtrField<v1::Parameter>& parameters,
             const std::string& name) {
  for (const v1::Parameter& parameter : parameters) {
    if (parameter.name() == name) return parameter.value();
  }
  ADD_FAILURE() << "no parameter " << name;
  return 0;
}

std::string Written(const TemporaryFolder& folder, const std::string& name,
                    const std::string& text) {
  EXPECT_TRUE(WriteFileAtomically(folder / name, text).ok());
  return folder / name;
}

// L = 1 + 200 v^2.2, as a fit would say it.
std::string FitOf(const TemporaryFolder& folder) {
  v1::ActivationResult fit;
  fit.set_model("power_offset");
  fit.set_luminance_unit("cd/m2");
  AddParameter(*fit.mutable_parameters(), "minimum_luminance", 1, 0.01, "cd/m2");
  AddParameter(*fit.mutable_parameters(), "luminance_range", 200, 0.1, "cd/m2");
  AddParameter(*fit.mutable_parameters(), "cutoff_drive", 0, 0, "1");
  AddParameter(*fit.mutable_parameters(), "gamma", 2.2, 0.001, "1");
  return Written(folder, "fit.json", *ToJson(fit));
}

std::string ThroughTable(double wrong) {
  std::string csv = "m_k,lum,lum_sigma\n";
  for (int i = 2; i <= 10; ++i) {
    const double m = i / 10.0;
    const double u = m <= 0.04045 ? m / 12.92 : std::pow((m + 0.055) / 1.055, 2.4);
    csv += absl::StrFormat("%.1f,%.6f,%.6f\n", m, 201 * std::pow(u, 1 + wrong), 0.4 * u);
  }
  return csv;
}

TEST(VerifyCli, PassesWhatIsProportionalAndFailsWhatIsNot) {
  const TemporaryFolder folder;
  const Outcome cube = RunEyebox("cube --fit " + FitOf(folder) + " --target hdrp --out " +
                                 (folder / "a.cube").string() + " --storage half,output8 --json");
  const auto certificate = ParsedFrom<v1::CubeResult>(cube);
  EXPECT_EQ(certificate.storage_certificates_size(), 3);
  EXPECT_EQ(certificate.method(), "minimax");
  const std::string judge = " --certificate " + Written(folder, "cube.json", cube.out) + " --json";
  const auto good = ParsedFrom<v1::VerifyResult>(
      RunEyebox("verify " + Written(folder, "good.csv", ThroughTable(0)) + judge));
  EXPECT_EQ(good.verdict(), "pass") << good.reason();
  EXPECT_LT(Value(good.parameters(), "departure_of_maximum"), 1e-6);
  const Outcome bad = RunEyebox("verify " + Written(folder, "bad.csv", ThroughTable(0.1)) + judge);
  EXPECT_EQ(bad.exit_code, 5);
  EXPECT_THAT(bad.out, HasSubstr("\"fail\""));
  const Outcome unjudged = RunEyebox("verify " + (folder / "bad.csv").string());
  EXPECT_EQ(unjudged.exit_code, 0) << unjudged.err;
  EXPECT_THAT(unjudged.out, HasSubstr("not judged"));
  EXPECT_EQ(RunEyebox("verify " + (folder / "bad.csv").string() + " --input gamma").exit_code, 3);
}

TEST(VerifyCli, RealSeriesThroughATableDepartsAsPublished) {
  const std::filesystem::path data =
      std::filesystem::path(EYEBOX_SOURCE_DIR) / "../shared/reference/luminance";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is absent: no real series";
  const auto grey = ParsedFrom<v1::VerifyResult>(
      RunEyebox("verify " + (data / "achromatic_420_through_lut.csv").string() + " --json"));
  EXPECT_NEAR(Value(grey.parameters(), "departure_of_maximum"), 0.0041, 0.00005);
  EXPECT_NEAR(Value(grey.parameters(), "departure_of_value"), 0.017, 0.0005);
  const auto colour = ParsedFrom<v1::VerifyResult>(
      RunEyebox("verify " + (data / "chromatic_118_through_lut.csv").string() + " --json"));
  std::printf("colour series: worst %.2f %% of maximum, white %+.2f %% of its primaries\n",
              100 * Value(colour.parameters(), "departure_of_maximum"),
              100 * colour.white_against_primaries().value());
  EXPECT_LT(Value(colour.parameters(), "departure_of_maximum"), 0.1);
  EXPECT_NEAR(colour.white_against_primaries().value(), 118.5 / (19.97 + 81.08 + 7.135) - 1, 1e-6);
}

TEST(VerifyCli, RecordingIsJudgedPlaceByPlace) {
  const TemporaryFolder folder;
  // The fixture was recorded without a table, so it departs everywhere.
  const auto result = ParsedFrom<v1::VerifyResult>(RunEyebox(
      "verify " + std::string(kFixture) + " --out " + (folder / "maps").string() + " --json"));
  EXPECT_EQ(result.verdict(), "not judged");
  EXPECT_GT(result.places(), 10);
  ASSERT_EQ(result.maps_size(), 5);
  const auto map = ReadNpy(folder / "maps" / result.maps(0).file());
  ASSERT_TRUE(map.ok()) << map.status();
  EXPECT_EQ(map->size().width_px, result.maps(0).width_px());
}

TEST(ProbeCli, PlansPatchesAndNamesWhatTheReadingsShow) {
  const TemporaryFolder folder;
  const std::string fit = FitOf(folder);
  const std::string out = folder / "probe";
  const auto plan = ParsedFrom<v1::ProbeResult>(
      RunEyebox("cube --probe " + fit + " --target hdrp --out " + out + " --json"));
  ASSERT_EQ(plan.patches_size(), 16);
  EXPECT_TRUE(std::filesystem::exists(out + "/probe.csv"));
  EXPECT_TRUE(std::filesystem::exists(out + "/probe.cube"));
  for (int truth = 0; truth < plan.hypotheses_size(); ++truth) {
    std::string csv = "u,lum\n";
    for (const v1::ProbePatch& patch : plan.patches()) {
      csv += absl::StrFormat("%.8f,%.8f\n", patch.u(), patch.expected(truth));
    }
    const auto verdict = ParsedFrom<v1::ProbeResult>(RunEyebox("cube --probe " + fit +
                                                               " --target hdrp --json --readings " +
                                                               Written(folder, "read.csv", csv)));
    EXPECT_EQ(verdict.verdict(), plan.hypotheses(truth).name()) << verdict.reason();
  }
}

TEST(FieldTablesCli, OneTableOrManyFromARecording) {
  const TemporaryFolder folder;
  const std::string out = folder / "set";
  const auto set = ParsedFrom<v1::CubeSetResult>(
      RunEyebox("cube --recording " + std::string(kFixture) +
                " --target hdrp --tolerance 20% --out " + out + " --json"));
  EXPECT_GE(set.tables_size(), 1);
  EXPECT_TRUE(set.proven_smallest());
  EXPECT_THAT(set.explanation(), HasSubstr("delta / k"));
  for (const char* file : {"single.cube", "table_1.cube", "single_error.npy", "regions.npy"}) {
    EXPECT_TRUE(std::filesystem::exists(out + "/" + file)) << file;
  }
  EXPECT_LE(Value(set.parameters(), "tables_at_least"), set.tables_size());
  const Outcome bad = RunEyebox("cube --recording " + std::string(kFixture) +
                                " --target hdrp --region middle --out " + out);
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, HasSubstr("central D"));
}

TEST(GammaTableCli, TableForThePsychtoolboxIsRead) {
  const TemporaryFolder folder;
  const std::string out = folder / "table.txt";
  const auto cube = ParsedFrom<v1::CubeResult>(
      RunEyebox("cube --fit " + FitOf(folder) + " --target ptb --out " + out + " --json"));
  EXPECT_EQ(cube.size(), 256);
  const auto table = fit::ReadGammaTable(out);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_NEAR((*table)[255][0], 1, 1e-6);
}

}  // namespace
}  // namespace eyebox::service
