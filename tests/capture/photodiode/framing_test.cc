#include "capture/photodiode/serial/framing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "capture/base/random.h"
#include "capture/photodiode/serial/messages.h"

namespace eyebox::capture::serial {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

Bytes RandomPayload(RandomStream& random) {
  Bytes payload(1 + random.Below(kMaxPayloadBytes));
  // Half of them zeros: those are what stuffing is about.
  for (uint8_t& byte : payload) byte = static_cast<uint8_t>(random.Below(2) * random.Below(256));
  return payload;
}

std::vector<Bytes> SplitAll(FrameSplitter& splitter, std::span<const uint8_t> bytes) {
  std::vector<Bytes> payloads;
  splitter.Feed(bytes, payloads);
  return payloads;
}

void Append(Bytes& stream, std::span<const uint8_t> bytes) {
  stream.insert(stream.end(), bytes.begin(), bytes.end());
}

// Check value of the catalogue of parametrised CRC algorithms.
TEST(Crc16, HasItsPublishedCheckValue) {
  constexpr std::string_view kText = "123456789";
  EXPECT_EQ(Crc16(Bytes(kText.begin(), kText.end())), 0x29b1);
  EXPECT_EQ(Crc16({}), 0xffff);
}

TEST(Frame, HasTheGoldenForm) {
  // Payload 11 00 22, CRC bcef (low byte first), computed apart from this code.
  EXPECT_THAT(EncodeFrame(Bytes{0x11, 0x00, 0x22}),
              ElementsAre(0x02, 0x11, 0x04, 0x22, 0xef, 0xbc, 0x00));
}

TEST(Frame, ComesBackWhateverItHolds) {
  RandomStream random({1});
  for (int i = 0; i < 2000; ++i) {
    const Bytes payload = RandomPayload(random);
    Bytes frame = EncodeFrame(payload);
    EXPECT_EQ(std::count(frame.begin(), frame.end(), 0), 1);
    frame.pop_back();
    EXPECT_EQ(DecodeFrame(frame), payload);
  }
}

TEST(Frame, EveryFlippedBitIsFound) {
  Bytes frame = EncodeFrame(Bytes{1, 0, 0, 7, 255, 0, 3});
  frame.pop_back();
  for (size_t bit = 0; bit < 8 * frame.size(); ++bit) {
    Bytes damaged = frame;
    damaged[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    EXPECT_EQ(DecodeFrame(damaged), std::nullopt) << "bit " << bit;
  }
}

TEST(FrameSplitter, FindsItsFeetAfterGarbage) {
  RandomStream random({2});
  FrameSplitter splitter;
  Bytes stream;
  for (int i = 0; i < 500; ++i) stream.push_back(static_cast<uint8_t>(random.Below(256)));
  stream.push_back(0);
  Append(stream, EncodeFrame(Bytes{42}));
  EXPECT_THAT(SplitAll(splitter, stream), ElementsAre(Bytes{42}));
}

TEST(FrameSplitter, ALostByteCostsOneFrame) {
  const Bytes frame = EncodeFrame(Bytes{1, 2, 3, 4});
  for (size_t lost = 0; lost + 1 < frame.size(); ++lost) {
    FrameSplitter splitter;
    Bytes stream = EncodeFrame(Bytes{7});
    Append(stream, std::span(frame).first(lost));
    Append(stream, std::span(frame).subspan(lost + 1));
    Append(stream, EncodeFrame(Bytes{8}));
    EXPECT_THAT(SplitAll(splitter, stream), ElementsAre(Bytes{7}, Bytes{8})) << "byte " << lost;
    EXPECT_EQ(splitter.damaged(), 1);
  }
}

TEST(FrameSplitter, ALostZeroCostsTwoFrames) {
  FrameSplitter splitter;
  Bytes stream = EncodeFrame(Bytes{7});
  Bytes unended = EncodeFrame(Bytes{1, 2});
  unended.pop_back();
  Append(stream, unended);
  Append(stream, EncodeFrame(Bytes{3, 4}));
  Append(stream, EncodeFrame(Bytes{8}));
  EXPECT_THAT(SplitAll(splitter, stream), ElementsAre(Bytes{7}, Bytes{8}));
  EXPECT_EQ(splitter.damaged(), 1);
}

TEST(FrameSplitter, JoiningInTheMiddleIsNoDamage) {
  FrameSplitter splitter;
  const Bytes frame = EncodeFrame(Bytes{1, 2, 3});
  EXPECT_THAT(SplitAll(splitter, std::span(frame).subspan(2)), IsEmpty());
  EXPECT_EQ(splitter.damaged(), 0);
}

TEST(FrameSplitter, AnEndlessFrameIsDroppedWhole) {
  FrameSplitter splitter;
  EXPECT_THAT(SplitAll(splitter, Bytes{0}), IsEmpty());
  EXPECT_THAT(SplitAll(splitter, Bytes(1'000'000, 0x55)), IsEmpty());
  EXPECT_THAT(SplitAll(splitter, Bytes{0}), IsEmpty());
  EXPECT_EQ(splitter.damaged(), 1);
  EXPECT_THAT(SplitAll(splitter, EncodeFrame(Bytes{9})), ElementsAre(Bytes{9}));
}

TEST(FrameSplitter, PiecesOfAnySizeGiveTheSame) {
  RandomStream random({3});
  Bytes stream;
  std::vector<Bytes> sent;
  for (int i = 0; i < 200; ++i) {
    sent.push_back(RandomPayload(random));
    Append(stream, EncodeFrame(sent.back()));
  }
  FrameSplitter splitter;
  std::vector<Bytes> received;
  for (std::span<const uint8_t> rest = stream; !rest.empty();) {
    const size_t piece = std::min<size_t>(1 + random.Below(40), rest.size());
    splitter.Feed(rest.first(piece), received);
    rest = rest.subspan(piece);
  }
  EXPECT_EQ(received, sent);
}

TEST(Messages, RequestsComeBack) {
  for (const RequestType type : {RequestType::kHello, RequestType::kStart, RequestType::kStop}) {
    const auto request = DecodeRequest(EncodeRequest({.type = type, .token = 9}));
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->type, type);
    EXPECT_EQ(request->token, 9);
  }
  const auto configure = DecodeRequest(
      EncodeRequest({.type = RequestType::kConfigure, .token = 1, .period_us = 0x01020304}));
  ASSERT_TRUE(configure.has_value());
  EXPECT_EQ(configure->period_us, 0x01020304);
}

TEST(Messages, SamplesKeepTimeAcrossTheWrapOfTheCounter) {
  const Samples sent = {.sequence = 0xffffffff,
                        .samples = {{0xfffffff0, 1023}, {0x00000010, 0}, {0x0000fff0, 512}}};
  const auto message = DecodeMessage(EncodeSamples(sent));
  ASSERT_TRUE(message.has_value());
  const Samples& received = std::get<Samples>(*message);
  EXPECT_EQ(received.sequence, 0xffffffff);
  ASSERT_THAT(received.samples, SizeIs(3));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(received.samples[i].micros, sent.samples[i].micros);
    EXPECT_EQ(received.samples[i].counts, sent.samples[i].counts);
  }
}

TEST(Messages, WrongLengthsAndTypesAreNotUnderstood) {
  Bytes samples = EncodeSamples({.sequence = 1, .samples = {{2, 3}}});
  samples.push_back(0);
  EXPECT_FALSE(DecodeMessage(samples).has_value());
  Bytes state = EncodeState({.bits = 10});
  state.pop_back();
  EXPECT_FALSE(DecodeMessage(state).has_value());
  EXPECT_FALSE(DecodeMessage({}).has_value());
  EXPECT_FALSE(DecodeMessage(Bytes{0x77, 1, 2}).has_value());
  Bytes none = EncodeSamples({.sequence = 1, .samples = {{2, 3}}});
  none[1] = 0;
  none.resize(10);
  EXPECT_FALSE(DecodeMessage(none).has_value());
}

}  // namespace
}  // namespace eyebox::capture::serial
