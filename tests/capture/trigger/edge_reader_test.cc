// Faults enter through the line: full queues, lost edges, a wall clock, a chip that goes away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <thread>
#include <utility>

#include "capture/trigger/line_trigger.h"

namespace eyebox::capture {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::SizeIs;

constexpr int64_t kNowNs = 1'000'000;
constexpr auto kLong = milliseconds(20000);

// Gives one batch a read, then `end`.
class ScriptedLine final : public InputLine {
 public:
  ScriptedLine(std::deque<std::vector<Edge>> batches, absl::Status end)
      : batches_(std::move(batches)), end_(std::move(end)) {}

  absl::StatusOr<std::vector<Edge>> Read(milliseconds timeout) override {
    if (!batches_.empty()) {
      std::vector<Edge> batch = std::move(batches_.front());
      batches_.pop_front();
      return batch;
    }
    if (!end_.ok()) return end_;
    std::this_thread::sleep_for(timeout);
    return std::vector<Edge>();
  }

 private:
  std::deque<std::vector<Edge>> batches_;
  const absl::Status end_;
};

std::vector<Edge> Alternating(int64_t first_ns, int count) {
  std::vector<Edge> edges;
  for (int i = 0; i < count; ++i) edges.push_back({first_ns + i, i % 2 == 0});
  return edges;
}

class EdgeReader : public testing::Test {
 protected:
  std::unique_ptr<EdgeSource> Open(std::deque<std::vector<Edge>> batches, EdgeKind kind,
                                   absl::Status end = absl::OkStatus()) {
    auto source = MakeEdgeReader("gpiochip0:1",
                                 std::make_unique<ScriptedLine>(std::move(batches), std::move(end)),
                                 kind, &clock_);
    clock_.AdvanceNs(kNowNs);
    return source;
  }

  // Until there are `count`, or an error.
  static absl::StatusOr<EdgeSource::Edges> TakeAll(EdgeSource& source, size_t count) {
    EdgeSource::Edges all;
    while (all.edges.size() < count) {
      auto taken = source.Take(kLong);
      if (!taken.ok()) return taken;
      all.edges.insert(all.edges.end(), taken->edges.begin(), taken->edges.end());
      all.known_losses += taken->known_losses;
      all.full_queues += taken->full_queues;
    }
    return all;
  }

  ManualClock clock_{1};
};

TEST_F(EdgeReader, KeepsOrderOverManyReads) {
  const auto source = Open({Alternating(10, 4), Alternating(20, 6)}, EdgeKind::kBoth);
  const auto all = TakeAll(*source, 10);
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_EQ(all->edges.front(), (Edge{10, true}));
  EXPECT_EQ(all->edges.back(), (Edge{25, false}));
  EXPECT_EQ(all->known_losses, 0);
  EXPECT_EQ(all->full_queues, 0);
}

TEST_F(EdgeReader, TwoEdgesOfOneDirectionAreAKnownLoss) {
  const auto source = Open({{{10, true}, {11, true}}, {{12, true}, {13, false}}}, EdgeKind::kBoth);
  const auto all = TakeAll(*source, 4);
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_EQ(all->known_losses, 2);
}

TEST_F(EdgeReader, OneDirectionAloneTellsNothingOfLosses) {
  const auto source = Open({{{10, true}, {11, true}}}, EdgeKind::kRising);
  const auto all = TakeAll(*source, 2);
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_EQ(all->known_losses, 0);
}

TEST_F(EdgeReader, AFullQueueIsReported) {
  const auto source = Open({Alternating(10, 16)}, EdgeKind::kBoth);
  const auto all = TakeAll(*source, 16);
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_EQ(all->full_queues, 1);
}

TEST_F(EdgeReader, StampsOfTheWallClockAreRefused) {
  const auto source = Open({{{1'700'000'000'000'000'000, true}}}, EdgeKind::kRising);
  const auto edges = source->Take(kLong);
  EXPECT_TRUE(absl::IsUnavailable(edges.status()));
  EXPECT_THAT(edges.status().message(), HasSubstr("not CLOCK_MONOTONIC"));
}

TEST_F(EdgeReader, WhatCameBeforeTheChipWentIsStillGiven) {
  const auto source =
      Open({Alternating(10, 3)}, EdgeKind::kBoth, absl::UnavailableError("unplugged"));
  const auto all = TakeAll(*source, 3);
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_TRUE(absl::IsUnavailable(source->Take(kLong).status()));
}

TEST_F(EdgeReader, SilenceGivesNoEdges) {
  const auto source = Open({}, EdgeKind::kBoth);
  const auto edges = source->Take(milliseconds(1));
  ASSERT_TRUE(edges.ok()) << edges.status();
  EXPECT_THAT(edges->edges, SizeIs(0));
}

}  // namespace
}  // namespace eyebox::capture
