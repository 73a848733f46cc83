#include "capture/recording/rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

class RigFile : public testing::Test {
 protected:
  absl::StatusOr<RigConfig> Read(const std::string& text) {
    std::ofstream(folder_ / "rig.textproto") << text;
    return ReadRigFile(folder_ / "rig.textproto");
  }
  std::string Refusal(const std::string& text) {
    const absl::Status status = Read(text).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("rig.textproto"));
    return std::string(status.message());
  }
  const TemporaryFolder folder_;
};

TEST_F(RigFile, IsATextproto) {
  const auto rig = Read("# my bench\nname: \"bench-1\"\ncamera_uri: \"sim:rift-s-like\" seed: 7\n");
  ASSERT_TRUE(rig.ok()) << rig.status();
  EXPECT_EQ(rig->name, "bench-1");
  EXPECT_EQ(rig->camera_uri, "sim:rift-s-like");
  EXPECT_EQ(rig->seed, 7U);
}

TEST_F(RigFile, OfUnknownFieldIsRefusedByLine) {
  const std::string message = Refusal("name: \"a\"\ncamera_url: \"sim:x\"\n");
  EXPECT_THAT(message, HasSubstr("rig.textproto:2"));
  EXPECT_THAT(message, HasSubstr("camera_url"));
}

TEST_F(RigFile, OfABadValueIsRefusedByLine) {
  EXPECT_THAT(Refusal("name: \"a\"\ncamera_uri: \"sim:x\"\nseed: -1\n"),
              HasSubstr("rig.textproto:3"));
  EXPECT_THAT(Refusal("name: \"a\" name: \"b\"\n"), HasSubstr("rig.textproto:1"));
}

TEST_F(RigFile, OfABadNameIsRefused) {
  for (const std::string& name :
       {std::string(), std::string("Bench"), std::string("a/b"), std::string(64, 'a')}) {
    EXPECT_THAT(Refusal("name: \"" + name + "\" camera_uri: \"sim:rift-s-like\""),
                HasSubstr("name"));
  }
  EXPECT_TRUE(Read("name: \"" + std::string(63, 'a') + "\" camera_uri: \"sim:rift-s-like\"").ok());
}

TEST_F(RigFile, OfAnUnknownSchemeIsRefusedAndTheKnownAreListed) {
  const std::string message = Refusal("name: \"a\" camera_uri: \"usb:3\"");
  EXPECT_THAT(message, HasSubstr("camera_uri"));
  EXPECT_THAT(message, HasSubstr("sim: replay:"));
  EXPECT_THAT(Refusal("name: \"a\""), HasSubstr("camera_uri"));
}

TEST_F(RigFile, NamesPhotodiodeAndTrigger) {
  const std::string camera = "name: \"a\" camera_uri: \"sim:rift-s-like\" ";
  const auto rig =
      Read(camera + "photodiode_uri: \"sim:strobe-90hz\" trigger_uri: \"gpiochip0:17\"");
  ASSERT_TRUE(rig.ok()) << rig.status();
  EXPECT_EQ(rig->photodiode_uri, "sim:strobe-90hz");
  EXPECT_EQ(rig->trigger_uri, "gpiochip0:17");
  EXPECT_THAT(Refusal(camera + "photodiode_uri: \"adc:0\""), HasSubstr("iio: serial: sim:"));
  EXPECT_THAT(Refusal(camera + "trigger_uri: \"button\""), HasSubstr("trigger_uri"));
  const std::string line = "camera_trigger_line: \"Line0\"";
  EXPECT_THAT(Refusal(camera + line), HasSubstr("camera_trigger_line"));
  const auto wired = Read(camera + "trigger_uri: \"gpiochip0:17\" " + line);
  ASSERT_TRUE(wired.ok()) << wired.status();
  EXPECT_EQ(wired->camera_trigger_line, "Line0");
}

TEST_F(RigFile, ThatIsMissingIsNotFound) {
  EXPECT_TRUE(absl::IsNotFound(ReadRigFile(folder_ / "none").status()));
}

}  // namespace
}  // namespace eyebox::capture
