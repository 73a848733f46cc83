#include "capture/camera/v4l2/v4l2_uri.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace eyebox::capture {
namespace {

TEST(V4l2Uri, NamesADeviceAlone) {
  const auto options = ParseV4l2Uri("v4l2:/dev/video3");
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(options->path, "/dev/video3");
  EXPECT_EQ(options->format, "");
  EXPECT_FALSE(options->size_px);
  EXPECT_FALSE(options->gain_db_per_step);
}

TEST(V4l2Uri, TakesEveryOption) {
  const auto options =
      ParseV4l2Uri("v4l2:/dev/video0?format=Y10P&size=1280x800&gain_db_per_step=0.1&gamma=100");
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(options->format, "Y10P");
  EXPECT_EQ(options->size_px, (ImageSize{.width_px = 1280, .height_px = 800}));
  EXPECT_EQ(options->gain_db_per_step, 0.1);
  EXPECT_EQ(options->gamma, 100);
}

struct Wrong {
  const char* uri;
  const char* words;
};

class V4l2UriWrong : public testing::TestWithParam<Wrong> {};

TEST_P(V4l2UriWrong, IsRefusedByName) {
  const auto options = ParseV4l2Uri(GetParam().uri);
  ASSERT_TRUE(absl::IsInvalidArgument(options.status())) << options.status();
  EXPECT_THAT(std::string(options.status().message()), testing::HasSubstr(GetParam().words));
}

INSTANTIATE_TEST_SUITE_P(
    Uris, V4l2UriWrong,
    testing::Values(Wrong{"sim:x", "v4l2:/dev/video0"}, Wrong{"v4l2:", "whole path"},
                    Wrong{"v4l2:video0", "whole path"},
                    Wrong{"v4l2:/dev/video0?format=YUYV", "format"},
                    Wrong{"v4l2:/dev/video0?format", "format"},
                    Wrong{"v4l2:/dev/video0?size=640", "WIDTHxHEIGHT"},
                    Wrong{"v4l2:/dev/video0?size=0x480", "WIDTHxHEIGHT"},
                    Wrong{"v4l2:/dev/video0?size=99999999999x480", "WIDTHxHEIGHT"},
                    Wrong{"v4l2:/dev/video0?gain_db_per_step=nan", "data sheet"},
                    Wrong{"v4l2:/dev/video0?gain_db_per_step=0", "data sheet"},
                    Wrong{"v4l2:/dev/video0?gamma=1.5", "gamma"},
                    Wrong{"v4l2:/dev/video0?zoom=2", "known are"}));

}  // namespace
}  // namespace eyebox::capture
