#include "fit/cube/cube_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "tests/fit/cube/evaluator.h"

namespace eyebox::fit {
namespace {

// Departure from proportionality of L = v^gamma + offset through the table, by the evaluator.
double DepartureOf(const TableDesign& table, const PlaceResponse& place) {
  const Cube3d cube = ToCube(table, "");
  evaluator::Real least = 1e9L;
  evaluator::Real most = 0;
  for (int i = 0; i < 1501; ++i) {
    const evaluator::Real x = std::pow(0.05L, 1 - static_cast<evaluator::Real>(i) / 1500);
    const auto drive = evaluator::Drive(cube, TableTarget::kHdrp, {x, x, x})[1];
    const auto ratio =
        (std::pow(drive, static_cast<evaluator::Real>(place.gamma)) + place.offset_over_gain) / x;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  return static_cast<double>((most - least) / (most + least));
}

std::vector<PlaceResponse> Row(double from, double to, double gamma, int count) {
  std::vector<PlaceResponse> places;
  for (int i = 0; i < count; ++i) {
    places.push_back({std::lerp(from, to, static_cast<double>(i) / (count - 1)), 1e-4, gamma});
  }
  return places;
}

std::vector<uint8_t> All(const std::vector<PlaceResponse>& places) {
  return std::vector<uint8_t>(places.size(), 1);
}

TEST(CubeSetTest, PlacesThatDifferInGainAloneShareATable) {
  const std::vector<PlaceResponse> places(50, {0.01, 1e-4, 2.2});
  const auto set = *DesignCubeSet(places, All(places), {});
  EXPECT_EQ(set.tables.size(), 1u);
  EXPECT_EQ(set.at_least, 1u);
  EXPECT_LE(set.single.max_relative, set.single.table.certificate.max_relative * 1.01);
}

TEST(CubeSetTest, MapOfTheSingleTableIsWhatEachPlaceWouldShow) {
  const auto places = Row(0, 0.02, 2.2, 9);
  const auto set = *DesignCubeSet(places, All(places), {.tolerance = 0.2});
  for (size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(set.single_error[i], DepartureOf(set.single.table, places[i]), 3e-4) << i;
    EXPECT_GE(set.single_error_sigma[i], 0);
  }
  // An offset that is wrong by 0.01 is wrong by 0.2 at 5 % of white: half of that either way.
  EXPECT_NEAR(set.single.max_relative, 0.093, 0.01);
  EXPECT_EQ(set.tables.size(), 1u) << "within the tolerance";
}

TEST(CubeSetTest, NoOtherSingleTableIsBetter) {
  const auto places = Row(0, 0.02, 2.2, 5);
  const auto set = *DesignCubeSet(places, All(places), {.tolerance = 0.2});
  for (double offset = 0; offset <= 0.02; offset += 0.0005) {
    const auto other = *DesignTable({offset, 1, 0, 2.2}, TableTarget::kHdrp, 32);
    double worst = 0;
    for (const auto& place : places) worst = std::max(worst, DepartureOf(other, place));
    EXPECT_GE(worst, set.single.max_relative - 0.002);
  }
}

TEST(CubeSetTest, FewestTablesKeepTheTolerance) {
  const auto places = Row(0, 0.03, 2.2, 301);
  size_t before = 1000;
  for (double tolerance : {0.015, 0.02, 0.05, 0.1, 0.3}) {
    const auto set = DesignCubeSet(places, All(places), {.tolerance = tolerance});
    ASSERT_TRUE(set.ok()) << set.status();
    std::printf("tolerance %.1f %%: %zu tables\n", 100 * tolerance, set->tables.size());
    EXPECT_EQ(set->at_least, set->tables.size());
    EXPECT_LE(set->tables.size(), before);
    before = set->tables.size();
    for (size_t i = 0; i < places.size(); i += 20) {
      const int index = set->table_of[i];
      ASSERT_GE(index, 1);
      EXPECT_LE(DepartureOf(set->tables[static_cast<size_t>(index) - 1].table, places[i]),
                tolerance + 2e-4);
    }
  }
}

// n tables reach n times as far as one.
TEST(CubeSetTest, NumberOfTablesIsThatOfTheAlgebra) {
  // A place whose offset differs by d from the table's shows L / x from 1 + d at white to 1 + 20 d
  // at 5 %: it departs by 19 d / 2, to first order, and a table serves d either way.
  const auto places = Row(0, 0.03, 2.2, 3001);
  const double own = 0.007;
  const double reach = 4 * (0.05 - own) / 19;
  const auto set = *DesignCubeSet(places, All(places), {.tolerance = 0.05});
  EXPECT_NEAR(static_cast<double>(set.tables.size()), 0.03 / reach, 1.2);
}

TEST(CubeSetTest, ExponentsMayDiffer) {
  std::vector<PlaceResponse> places;
  for (double gamma : {2.0, 2.1, 2.2, 2.3}) {
    for (const auto& place : Row(0, 0.004, gamma, 20)) places.push_back(place);
  }
  const auto set = *DesignCubeSet(places, All(places), {.tolerance = 0.05});
  EXPECT_GE(set.tables.size(), set.at_least);
  EXPECT_GE(set.at_least, 2u);
  EXPECT_LE(set.tables.size(), 5u);
  for (size_t i = 0; i < places.size(); i += 7) {
    const auto index = static_cast<size_t>(set.table_of[i]) - 1;
    EXPECT_LE(DepartureOf(set.tables[index].table, places[i]), 0.0503);
  }
}

TEST(CubeSetTest, PlacesOutsideTheRegionDoNotCount) {
  auto places = Row(0, 0.03, 2.2, 31);
  places[3].offset_over_gain = std::numeric_limits<double>::quiet_NaN();
  std::vector<uint8_t> in_region(31, 0);
  for (int i = 0; i < 5; ++i) in_region[i] = 1;
  const auto set = *DesignCubeSet(places, in_region, {.tolerance = 0.05});
  EXPECT_EQ(set.tables.size(), 1u);
  EXPECT_EQ(set.single.places, 4u);
  EXPECT_EQ(set.table_of[10], 0);
  EXPECT_TRUE(std::isnan(set.single_error[3]));
  EXPECT_GT(set.single_error[30], 0.1) << "but the map shows what they would suffer";
}

TEST(CubeSetTest, WhatCannotBeDoneIsSaid) {
  const auto places = Row(0, 0.03, 2.2, 31);
  const auto too_fine = DesignCubeSet(places, All(places), {.tolerance = 0.001});
  EXPECT_EQ(too_fine.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(too_fine.status().message()), testing::HasSubstr("more entries"));
  EXPECT_FALSE(DesignCubeSet(places, All(places), {.tolerance = 0}).ok());
  EXPECT_FALSE(DesignCubeSet(places, std::vector<uint8_t>(31, 0), {}).ok());
  EXPECT_FALSE(DesignCubeSet(places, std::vector<uint8_t>(3, 1), {}).ok());
}

}  // namespace
}  // namespace eyebox::fit
