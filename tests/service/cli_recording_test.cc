// Commands that keep recordings: export, import, recover.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "eyebox/v1/recording_service.pb.h"
#include "eyebox/v1/results.pb.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

const char kFixture[] = EYEBOX_SOURCE_DIR "/fixtures/rift-s-like-seed1";

TEST(CliRecording, ExportedFramesAreImportedAgain) {
  const TemporaryFolder folder;
  const std::string frames = folder / "frames";
  const std::string again = folder / "again";
  const Outcome exported =
      RunEyebox("export " + std::string(kFixture) + " --out " + frames + " --kind dark");
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_THAT(exported.out, HasSubstr("Wrote " + frames));
  const auto imported =
      ParsedFrom<v1::ImportResult>(RunEyebox("import " + frames + " --out " + again + " --json"));
  EXPECT_EQ(imported.recording(), again);
  EXPECT_THAT(
      exported.out,
      HasSubstr(std::to_string(static_cast<int>(imported.parameters(0).value())) + " frames of"));
  EXPECT_EQ(RunEyebox("verify-files " + again).exit_code, 0);
}

TEST(CliRecording, ExportOfWhatIsNotThereNamesWhatIs) {
  const TemporaryFolder folder;
  const Outcome series = RunEyebox("export " + std::string(kFixture) + " --out " +
                                   (folder / "frames").string() + " --series blue");
  EXPECT_EQ(series.exit_code, 3);
  EXPECT_THAT(series.err, HasSubstr("light"));
  EXPECT_EQ(RunEyebox("export a --out b --kind green").exit_code, 2);
}

TEST(CliRecording, RecoverMendsATornManifestAndSaysSo) {
  const TemporaryFolder folder;
  const std::filesystem::path recording = folder / "recording";
  std::filesystem::copy(kFixture, recording, std::filesystem::copy_options::recursive);
  std::ofstream(recording / "manifest.log", std::ios::app | std::ios::binary) << "torn";
  EXPECT_EQ(RunEyebox("verify-files " + recording.string()).exit_code, 3);
  const Outcome recovered = RunEyebox("recover " + recording.string());
  ASSERT_EQ(recovered.exit_code, 0) << recovered.err;
  EXPECT_THAT(recovered.out, HasSubstr("4 bytes cut"));
  EXPECT_THAT(recovered.out, HasSubstr("Every frame of"));
  EXPECT_EQ(RunEyebox("verify-files " + recording.string()).exit_code, 0);
  EXPECT_EQ(RunEyebox("recover " + folder.path().string()).exit_code, 3);
}

TEST(CliRecording, CatalogueListsFiltersAndIsMadeAnew) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "data/lab");
  for (const char* name : {"data/a", "data/lab/b"}) {
    std::filesystem::copy(kFixture, folder / name, std::filesystem::copy_options::recursive);
  }
  std::filesystem::remove(folder / "data/a/captures/000001.h5");
  const std::string catalogue =
      "catalogue --store " + (folder / "data").string() + " --state " + (folder / "state").string();
  const Outcome all = RunEyebox(catalogue);
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_THAT(all.out, HasSubstr("recordings/a"));
  EXPECT_THAT(all.out, HasSubstr("000001.h5: is missing"));
  EXPECT_THAT(all.err, HasSubstr("made anew from 2 recordings"));
  const Outcome whole = RunEyebox(catalogue + " --filter 'state = COMPLETE' --json");
  const auto listed = ParsedFrom<v1::ListRecordingsResponse>(whole);
  ASSERT_EQ(listed.recordings_size(), 1);
  EXPECT_EQ(listed.recordings(0).name(), "recordings/lab/b");
  EXPECT_EQ(whole.err, "");
  EXPECT_THAT(RunEyebox(catalogue + " --rebuild").err, HasSubstr("as was asked for"));
  const Outcome wrong = RunEyebox(catalogue + " --filter 'state = GREEN'");
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("at character 9, 'GREEN' is unknown"));
}

}  // namespace
}  // namespace eyebox::service
