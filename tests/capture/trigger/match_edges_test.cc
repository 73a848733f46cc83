#include "capture/trigger/match_edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace eyebox::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;

constexpr MatchWindow kWindow = {.earliest_ns = 0, .latest_ns = 100};

TEST(MatchEdges, PairsEachExpectedTimeWithItsEdge) {
  const auto match = MatchEdges(std::vector<int64_t>{1000, 2000, 3000},
                                std::vector<int64_t>{1010, 2030, 3050}, kWindow);
  ASSERT_TRUE(match.ok()) << match.status();
  EXPECT_THAT(match->edge_of, ElementsAre(Optional(0), Optional(1), Optional(2)));
  EXPECT_DOUBLE_EQ(match->mean_delay_ns, 30);
  EXPECT_DOUBLE_EQ(match->delay_sigma_ns, 20);
  EXPECT_TRUE(CheckComplete(*match, "strobe of frame").ok());
}

TEST(MatchEdges, NamesLostAndUnexpectedEdges) {
  const auto match = MatchEdges(std::vector<int64_t>{1000, 2000, 3000, 4000},
                                std::vector<int64_t>{500, 1010, 1020, 3050, 3999, 9000}, kWindow);
  ASSERT_TRUE(match.ok()) << match.status();
  EXPECT_THAT(match->lost, ElementsAre(1, 3));
  EXPECT_THAT(match->unexpected, ElementsAre(0, 2, 4, 5));
  const absl::Status complete = CheckComplete(*match, "strobe of frame");
  EXPECT_TRUE(absl::IsDataLoss(complete));
  EXPECT_THAT(complete.message(), HasSubstr("strobe of frame: 2 of 4 were lost (1, 3)"));
  EXPECT_THAT(complete.message(), HasSubstr("4 edges belong to none"));
}

// A burst of 40 pulses into a queue of 16 that is read twice.
TEST(MatchEdges, FindsWhatAFullQueueDropped) {
  std::vector<int64_t> pulses;
  std::vector<int64_t> edges;
  for (int64_t i = 0; i < 40; ++i) {
    pulses.push_back(1000 * i);
    if (i < 16 || i >= 24) edges.push_back(1000 * i + 7);
  }
  const auto match = MatchEdges(pulses, edges, kWindow);
  ASSERT_TRUE(match.ok());
  EXPECT_THAT(match->lost, ElementsAre(16, 17, 18, 19, 20, 21, 22, 23));
  EXPECT_THAT(match->unexpected, IsEmpty());
  EXPECT_THAT(CheckComplete(*match, "pulse").message(), HasSubstr("(16, 17, 18, 19, 20, ...)"));
}

TEST(MatchEdges, WindowMayLieBeforeTheExpectedTime) {
  const auto match = MatchEdges(std::vector<int64_t>{1000}, std::vector<int64_t>{950},
                                {.earliest_ns = -60, .latest_ns = -40});
  ASSERT_TRUE(match.ok());
  EXPECT_THAT(match->lost, IsEmpty());
  EXPECT_DOUBLE_EQ(match->mean_delay_ns, -50);
}

TEST(MatchEdges, NothingAtAllIsComplete) {
  const auto match = MatchEdges({}, {}, kWindow);
  ASSERT_TRUE(match.ok());
  EXPECT_TRUE(CheckComplete(*match, "pulse").ok());
}

TEST(MatchEdges, AmbiguousOrDisorderedInputIsRefused) {
  const std::vector<int64_t> ascending = {1000, 1100};
  const std::vector<int64_t> disordered = {1000, 1000};
  EXPECT_TRUE(absl::IsInvalidArgument(MatchEdges(ascending, {}, kWindow).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(MatchEdges(disordered, {}, {0, 0}).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(MatchEdges({}, disordered, kWindow).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(MatchEdges({}, {}, {10, 9}).status()));
}

}  // namespace
}  // namespace eyebox::capture
