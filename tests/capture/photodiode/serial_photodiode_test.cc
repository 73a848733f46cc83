// The whole path over a pseudo-terminal: port, link, protocol, clock.
#include "capture/photodiode/serial/serial_photodiode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/capture/photodiode/fake_board.h"

namespace eyebox::capture {
namespace {

using serial::Bytes;
using serial::FakeBoard;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr auto kLong = milliseconds(20000);

absl::StatusOr<std::unique_ptr<Photodiode>> Open(const FakeBoard& board) {
  return OpenPhotodiode({.uri = board.uri()}, SystemClock());
}

std::unique_ptr<Photodiode> Started(const FakeBoard& board,
                                    const PhotodiodeSettings& settings = {}) {
  auto photodiode = Open(board);
  EXPECT_TRUE(photodiode.ok()) << photodiode.status();
  const auto set = (*photodiode)->Configure(settings);
  EXPECT_TRUE(set.ok()) << set.status();
  const absl::Status started = (*photodiode)->Start();
  EXPECT_TRUE(started.ok()) << started;
  return *std::move(photodiode);
}

TEST(SerialPhotodiode, LearnsWhatTheBoardCanDo) {
  FakeBoard board;
  const auto photodiode = Open(board);
  ASSERT_TRUE(photodiode.ok()) << photodiode.status();
  EXPECT_EQ((*photodiode)->Info().significant_bits, 10);
  EXPECT_EQ((*photodiode)->Info().maximum_counts, 1023);
  EXPECT_DOUBLE_EQ((*photodiode)->Info().sample_rate_max_hz, 5000);
}

TEST(SerialPhotodiode, SetsTheNearestRateInMicroseconds) {
  FakeBoard board;
  const auto photodiode = Open(board);
  ASSERT_TRUE(photodiode.ok());
  const auto set = (*photodiode)->Configure({.sample_rate_hz = 3000});
  ASSERT_TRUE(set.ok()) << set.status();
  EXPECT_DOUBLE_EQ(set->sample_rate_hz, 1e6 / 333);
}

TEST(SerialPhotodiode, APeriodThatDoesNotReadBackIsRefused) {
  FakeBoard board;
  board.deaf_to_period = true;
  const auto photodiode = Open(board);
  ASSERT_TRUE(photodiode.ok());
  const auto set = (*photodiode)->Configure({});
  EXPECT_TRUE(absl::IsUnavailable(set.status()));
  EXPECT_THAT(set.status().message(), HasSubstr("reads back 0 us"));
}

TEST(SerialPhotodiode, SamplesLieBetweenTheirConversionAndTheirArrival) {
  FakeBoard board;
  const auto photodiode = Started(board);
  int64_t last_ns = 0;
  for (uint32_t i = 0; i < 20; ++i) {
    const int64_t sent_ns = SystemClock()->MonotonicNs();
    board.SendSamples(4 * i);
    const auto block = photodiode->Read(kLong);
    ASSERT_TRUE(block.ok()) << block.status();
    const int64_t arrived_ns = SystemClock()->MonotonicNs();
    EXPECT_EQ(block->sequence, 4 * i);
    EXPECT_EQ(block->lost_before, 0);
    ASSERT_EQ(block->samples.size(), 4);
    EXPECT_EQ(block->device_time_ns.size(), 4);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(block->samples[k].counts, static_cast<int>(4 * i) + k);
    EXPECT_GE(block->samples.back().monotonic_ns, sent_ns - block->time_uncertainty_ns);
    EXPECT_LE(block->samples.back().monotonic_ns, arrived_ns + block->time_uncertainty_ns);
    EXPECT_GT(block->samples.front().monotonic_ns, last_ns);
    last_ns = block->samples.back().monotonic_ns;
  }
}

TEST(SerialPhotodiode, TimeGoesOnOverTheWrapOfMicros) {
  FakeBoard board(0xffffffff - 300'000);  // 0.3 s before the wrap
  const auto photodiode = Started(board);
  int64_t last_ns = 0;
  for (uint32_t i = 0; i < 40; ++i) {
    board.SendSamples(4 * i);
    const auto block = photodiode->Read(kLong);
    ASSERT_TRUE(block.ok()) << block.status();
    if (i > 0) {
      EXPECT_LT(block->samples.back().monotonic_ns - last_ns, 20'000'000'000);
    }
    EXPECT_GT(block->samples.front().monotonic_ns, last_ns);
    last_ns = block->samples.back().monotonic_ns;
    std::this_thread::sleep_for(milliseconds(15));
  }
  EXPECT_LT(board.Micros(), 0x80000000);  // it did wrap
}

TEST(SerialPhotodiode, GarbageAndDamageCostOnlyWhatTheyHit) {
  FakeBoard board;
  const auto photodiode = Started(board);
  board.SendRaw(Bytes{0x13, 0x37, 0x00, 0xff, 0xff, 0x01, 0x00});
  board.SendSamples(0);
  Bytes damaged = serial::EncodeFrame(serial::EncodeSamples(
      {.sequence = 4, .samples = {{board.Micros(), 1}, {board.Micros(), 2}}}));
  damaged[5] ^= 0x10;
  board.SendRaw(damaged);
  board.SendSamples(6);
  const auto first = photodiode->Read(kLong);
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_EQ(first->lost_before, 0);
  const auto second = photodiode->Read(kLong);
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(second->sequence, 6);
  EXPECT_EQ(second->lost_before, 2);
}

TEST(SerialPhotodiode, FramesLostBeforeTheFirstAreCountedToo) {
  FakeBoard board;
  const auto photodiode = Started(board);
  board.SendSamples(12);
  const auto block = photodiode->Read(kLong);
  ASSERT_TRUE(block.ok()) << block.status();
  EXPECT_EQ(block->lost_before, 12);
}

TEST(SerialPhotodiode, ASecondProgramIsRefused) {
  FakeBoard board;
  const auto first = Open(board);
  ASSERT_TRUE(first.ok()) << first.status();
  const auto second = Open(board);
  EXPECT_TRUE(absl::IsResourceExhausted(second.status())) << second.status();
  EXPECT_THAT(second.status().message(), HasSubstr("is in use"));
}

TEST(SerialPhotodiode, ClosedItCanBeOpenedAgain) {
  FakeBoard board;
  ASSERT_TRUE(Open(board).ok());
  EXPECT_TRUE(Open(board).ok());
}

TEST(SerialPhotodiode, UnpluggedIsReportedAfterWhatCameBefore) {
  FakeBoard board;
  const auto photodiode = Started(board);
  board.SendSamples(0);
  ASSERT_TRUE(photodiode->Read(kLong).ok());
  board.Unplug();
  const auto lost = photodiode->Read(kLong);
  EXPECT_TRUE(absl::IsUnavailable(lost.status())) << lost.status();
}

TEST(SerialPhotodiode, ABoardThatRestartsIsLost) {
  FakeBoard board;
  const auto photodiode = Started(board);
  board.SendSamples(100);
  ASSERT_TRUE(photodiode->Read(kLong).ok());
  board.SendSamples(0);
  const auto lost = photodiode->Read(kLong);
  EXPECT_TRUE(absl::IsUnavailable(lost.status()));
  EXPECT_THAT(lost.status().message(), HasSubstr("restarted"));
}

TEST(SerialPhotodiode, ABoardThatStoppedConvertingIsFoundByAsking) {
  FakeBoard board;
  const auto photodiode = Started(board);
  board.Restart();
  const auto lost = photodiode->Read(kLong);
  EXPECT_TRUE(absl::IsUnavailable(lost.status()));
  EXPECT_THAT(lost.status().message(), HasSubstr("restarted"));
}

TEST(SerialPhotodiode, WaitingForPulsesMayBeInVain) {
  FakeBoard board;
  const auto photodiode = Started(board, {.pulse_started = true});
  EXPECT_TRUE(absl::IsDeadlineExceeded(photodiode->Read(milliseconds(10)).status()));
  board.SendSamples(0, 1);
  EXPECT_TRUE(photodiode->Read(kLong).ok());
}

TEST(SerialPhotodiode, AnotherVersionOfTheProtocolIsNamed) {
  FakeBoard board(0, {.protocol = 9, .bits = 10, .minimum_period_us = 200});
  EXPECT_THAT(Open(board).status().message(), HasSubstr("speaks version 9"));
}

TEST(SerialPhotodiode, ABoardThatDoesNotAnswerIsNoPhotodiode) {
  FakeBoard board;
  board.mute = true;
  const auto photodiode = Open(board);
  EXPECT_TRUE(absl::IsUnavailable(photodiode.status()));
  EXPECT_THAT(photodiode.status().message(), HasSubstr("does not answer"));
}

TEST(SerialPhotodiode, WhatIsNoTerminalIsRefused) {
  const auto photodiode = OpenPhotodiode({.uri = "serial:/dev/null"}, SystemClock());
  EXPECT_TRUE(absl::IsInvalidArgument(photodiode.status())) << photodiode.status();
}

TEST(SerialPhotodiode, StopsAndStartsAgainFromZero) {
  FakeBoard board;
  const auto photodiode = Started(board);
  board.SendSamples(0);
  ASSERT_TRUE(photodiode->Read(kLong).ok());
  ASSERT_TRUE(photodiode->Stop().ok());
  ASSERT_TRUE(photodiode->Start().ok());
  board.SendSamples(0);
  const auto block = photodiode->Read(kLong);
  ASSERT_TRUE(block.ok()) << block.status();
  EXPECT_EQ(block->lost_before, 0);
}

}  // namespace
}  // namespace eyebox::capture
