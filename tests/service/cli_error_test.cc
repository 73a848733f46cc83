// What a person reads when something is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "capture/base/image_file.h"
#include "tests/service/recorded_rig.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class CliError : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }
  void Write(const std::string& name, const std::string& content) {
    ASSERT_TRUE(WriteFileAtomically(Path(name), content).ok());
  }
  // 8-bit grey TIFF, 2 x 2, as the specification of TIFF 6.0 has it.
  static std::string SmallTiff() {
    std::string tiff("II*\0\x08\0\0\0\x08\0", 10);
    const auto tag = [&tiff](uint16_t id, uint16_t type, uint32_t value) {
      const uint32_t count = 1;
      tiff.append(reinterpret_cast<const char*>(&id), 2);
      tiff.append(reinterpret_cast<const char*>(&type), 2);
      tiff.append(reinterpret_cast<const char*>(&count), 4);
      tiff.append(reinterpret_cast<const char*>(&value), 4);
    };
    tag(256, 4, 2), tag(257, 4, 2), tag(258, 3, 8), tag(259, 3, 1), tag(262, 3, 1);
    tag(273, 4, 8 + 2 + 8 * 12 + 4), tag(278, 4, 2), tag(279, 4, 4);
    return tiff.append(4, '\0').append("\x01\x02\x03\x04");
  }
  static void ExpectBadInput(const Outcome& outcome, const std::string& where) {
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(where));
    EXPECT_THAT(outcome.err, HasSubstr("; ")) << "no remedy is given";
    EXPECT_THAT(outcome.out, IsEmpty());
  }

  const TemporaryFolder folder_;
};

constexpr char kIndexHeader[] = "file,kind,exposure_s,gain_db,series,repeat\n";

TEST_F(CliError, ATruncatedTiffIsNamedAndNothingIsWritten) {
  Write("frames/index.csv", std::string(kIndexHeader) + "a.tif,light,0.1,0,s,1\n");
  Write("frames/a.tif", SmallTiff());
  ASSERT_EQ(RunEyebox("import " + Path("frames") + " --out " + Path("whole")).exit_code, 0);
  Write("frames/a.tif", SmallTiff().substr(0, SmallTiff().size() - 2));
  ExpectBadInput(RunEyebox("import " + Path("frames") + " --out " + Path("recording")), "a.tif");
  EXPECT_FALSE(std::filesystem::exists(Path("recording")));
}

TEST_F(CliError, AnIndexThatNamesAMissingFileIsBadInput) {
  Write("frames/index.csv", std::string(kIndexHeader) + "gone.tif,light,0.1,0,s,1\n");
  ExpectBadInput(RunEyebox("import " + Path("frames") + " --out " + Path("recording")), "gone.tif");
  EXPECT_FALSE(std::filesystem::exists(Path("recording")));
}

TEST_F(CliError, AFlatLineIsBadInput) {
  Write("flat.csv", "m_k,lum\n0,5\n0.25,5\n0.5,5\n0.75,5\n1,5\n");
  ExpectBadInput(RunEyebox("fit --json --csv " + Path("flat.csv")), "flat.csv");
}

TEST_F(CliError, AFlippedByteIsFoundByEveryCommandThatReadsIt) {
  std::filesystem::copy(EYEBOX_SOURCE_DIR "/fixtures/rift-s-like-seed1", Path("recording"),
                        std::filesystem::copy_options::recursive);
  const std::string file = Path("recording/captures/000030.h5");
  std::string bytes = *ReadWholeFile(file);
  bytes[bytes.size() / 2] ^= 0x10;
  Write("recording/captures/000030.h5", bytes);
  ExpectBadInput(RunEyebox("verify-files " + Path("recording") + " --json"), "000030.h5");
  ExpectBadInput(RunEyebox("run " + Path("recording") + " --json --out " + Path("out")),
                 "000030.h5");
  EXPECT_FALSE(std::filesystem::exists(Path("out")));
}

TEST_F(CliError, WhatDoesNotExistIsNamed) {
  for (const char* command :
       {"run ", "replay ", "reduce ", "uniformity ", "fit ", "verify-files "}) {
    ExpectBadInput(RunEyebox(command + Path("nowhere")), "nowhere");
  }
  ExpectBadInput(RunEyebox("run sim:unheard-of --out " + Path("out")), "sim:unheard-of");
  EXPECT_FALSE(std::filesystem::exists(Path("out")));
}

TEST_F(CliError, ARecordingIsNeverOverwritten) {
  const Outcome outcome =
      RunEyebox("simulate sim:rift-s-like --levels 2 --out " + RecordedRig().string());
  ExpectBadInput(outcome, RecordedRig().string());
  EXPECT_EQ(RunEyebox("verify-files " + RecordedRig().string()).exit_code, 0);
}

TEST_F(CliError, AFitThatIsNoneIsNamed) {
  Write("fit.json", "{\"parameters\": [");
  ExpectBadInput(
      RunEyebox("cube --target hdrp --fit " + Path("fit.json") + " --out " + Path("a.cube")),
      "fit.json");
  Write("fit.json", "{}");
  ExpectBadInput(
      RunEyebox("cube --target hdrp --fit " + Path("fit.json") + " --out " + Path("a.cube")),
      "fit.json");
  EXPECT_FALSE(std::filesystem::exists(Path("a.cube")));
}

TEST_F(CliError, AnUnknownCommandIsNamed) {
  const Outcome outcome = RunEyebox("measure rec");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no command 'measure'"));
}

TEST_F(CliError, UsageIsTwo) {
  for (const char* arguments :
       {"", "measure", "fit", "fit rec --csv a.csv", "fit --csv a.csv --model cubic",
        "cube --fit a --target hdrp --size 1 --out b", "run rec --hdrp-size 130", "run"}) {
    const Outcome outcome = RunEyebox(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.err, Not(IsEmpty())) << arguments;
  }
}

TEST_F(CliError, AMeasurementThatDoesNotSufficeIsFive) {
  Write("frames/index.csv", std::string(kIndexHeader) + "a.tif,light,0.1,0,s,1\n");
  Write("frames/a.tif", SmallTiff());
  ASSERT_EQ(RunEyebox("import " + Path("frames") + " --out " + Path("recording")).exit_code, 0);
  const Outcome outcome = RunEyebox("reduce " + Path("recording") + " --json");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(Path("recording")), HasSubstr("no dark frames")));
}

}  // namespace
}  // namespace eyebox::service
