#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "capture/camera/aravis/aravis_uri.h"
#include "capture/camera/aravis/count_planes.h"
#include "capture/camera/aravis/frame_id.h"

namespace eyebox::capture::aravis {
namespace {

using testing::HasSubstr;

TEST(FrameIds, GoOnWhereSixteenBitsWrapAndSkipZero) {
  FrameIdCounter counter(FrameIdWidth::k16Bit);
  EXPECT_EQ(counter.Unwrap(65534), 65534);
  EXPECT_EQ(counter.Unwrap(65535), 65535);
  EXPECT_EQ(counter.Unwrap(1), 65536);
  EXPECT_EQ(counter.Unwrap(2), 65537);
  for (uint64_t lap = 0; lap < 3; ++lap) {
    for (const uint64_t id : {20000, 40000, 60000}) {
      EXPECT_EQ(counter.Unwrap(id), 65535 * (lap + 1) + id);
    }
  }
}

TEST(FrameIds, AGapStaysAGapAcrossTheWrap) {
  FrameIdCounter counter(FrameIdWidth::k16Bit);
  EXPECT_EQ(counter.Unwrap(65535), 65535);
  EXPECT_EQ(counter.Unwrap(3), 65538);
}

TEST(FrameIds, ALateFrameGetsItsOwnPlace) {
  FrameIdCounter counter(FrameIdWidth::k16Bit);
  EXPECT_EQ(counter.Unwrap(65535), 65535);
  EXPECT_EQ(counter.Unwrap(2), 65537);
  EXPECT_EQ(counter.Unwrap(1), 65536);
  EXPECT_EQ(counter.Unwrap(2), 65537);
  EXPECT_EQ(counter.Unwrap(3), 65538);
}

TEST(FrameIds, SixtyFourBitIdsArePassedOn) {
  FrameIdCounter counter(FrameIdWidth::k64Bit);
  EXPECT_EQ(counter.Unwrap(65535), 65535);
  EXPECT_EQ(counter.Unwrap(65536), 65536);
  EXPECT_EQ(counter.Unwrap(65540), 65540);
  EXPECT_EQ(counter.Unwrap(65538), 65538);
  EXPECT_EQ(counter.Unwrap(65541), 65541);
}

TEST(FrameIds, ComeAfterAllBeforeWhereTheCameraCountsAnew) {
  FrameIdCounter narrow(FrameIdWidth::k16Bit);
  narrow.Unwrap(500);
  narrow.Restart();
  const uint64_t restarted = narrow.Unwrap(1);
  EXPECT_GT(restarted, 500);
  EXPECT_EQ(narrow.Unwrap(2), restarted + 1);
  narrow.Restart();
  EXPECT_GT(narrow.Unwrap(2), restarted + 1);
  FrameIdCounter wide(FrameIdWidth::k64Bit);
  wide.Unwrap(500);
  wide.Restart();
  EXPECT_GT(wide.Unwrap(0), 500);
  EXPECT_EQ(wide.Unwrap(1), 502);
}

TEST(AravisUri, NamesCameraAndOptions) {
  const auto options = ParseAravisUri(
      "aravis:Basler-21892432?pixel_format=Mono12p&region=640x480+8+16&packet_size=8000&"
      "packet_delay_ns=1000&socket_buffer_mib=8&packet_socket=1&buffers=20");
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_EQ(options->id, "Basler-21892432");
  EXPECT_FALSE(options->fake);
  EXPECT_EQ(options->pixel_format->name, "Mono12p");
  EXPECT_EQ(*options->region, (Region{.x_px = 8, .y_px = 16, .size = {640, 480}}));
  EXPECT_EQ(options->packet_size_bytes, 8000);
  EXPECT_EQ(options->packet_delay_ns, 1000);
  EXPECT_EQ(options->socket_buffer_mib, 8);
  EXPECT_TRUE(options->packet_socket);
  EXPECT_EQ(options->buffers, 20);
}

TEST(AravisUri, LeavesTheRestToTheCamera) {
  const auto options = ParseAravisUri("aravis:fake");
  ASSERT_TRUE(options.ok()) << options.status();
  EXPECT_TRUE(options->fake);
  EXPECT_FALSE(options->pixel_format.has_value());
  EXPECT_FALSE(options->region.has_value());
  EXPECT_FALSE(options->packet_socket);
  EXPECT_GE(options->socket_buffer_mib, 4);
}

class BadUri : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(BadUri, IsRefusedByName) {
  const auto options = ParseAravisUri(GetParam().first);
  EXPECT_TRUE(absl::IsInvalidArgument(options.status())) << options.status();
  EXPECT_THAT(std::string(options.status().message()), HasSubstr(GetParam().second));
}

INSTANTIATE_TEST_SUITE_P(
    Options, BadUri,
    testing::Values(std::pair{"aravis:", "names no Aravis camera"},
                    std::pair{"sim:fake", "names no Aravis camera"},
                    std::pair{"aravis:fake?region=512x512", "region"},
                    std::pair{"aravis:fake?region=512x0+0+0", "region"},
                    std::pair{"aravis:fake?region=512x-1+0+0", "region"},
                    std::pair{"aravis:fake?region=512x512+0+99999999999", "region"},
                    std::pair{"aravis:fake?pixel_format=RGB8", "RGB8"},
                    std::pair{"aravis:fake?packet_size=", "packet_size"},
                    std::pair{"aravis:fake?packet_size=9000000", "packet_size"},
                    std::pair{"aravis:fake?socket_buffer_mib=1", "socket_buffer_mib"},
                    std::pair{"aravis:fake?fake_rate_hz=nan", "fake_rate_hz"},
                    std::pair{"aravis:X?fake_rate_hz=100", "fake_rate_hz"},
                    std::pair{"aravis:fake?gain=3", "gain"}));

TEST(CountPlanes, AreUsedAgainAndOutliveTheirPool) {
  auto pool = std::make_shared<CountPlanes>();
  auto first = pool->Take(100);
  const auto* const memory = first->data();
  auto second = pool->Take(100);
  EXPECT_NE(second->data(), memory);
  first.reset();
  EXPECT_EQ(pool->Take(50)->data(), memory);
  pool.reset();
  second->at(99) = 7;
  EXPECT_EQ(second->back(), 7);
}

}  // namespace
}  // namespace eyebox::capture::aravis
