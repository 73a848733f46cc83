#include "capture/base/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace eyebox {
namespace {

using testing::HasSubstr;

TEST(Csv, ReadsFieldsByColumnName) {
  const auto table = ParseCsv("t.csv", "name,x\na,1.5\nb,-2e3\n");
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_EQ(table->RowCount(), 2U);
  const size_t x = *table->Column("x");
  EXPECT_EQ(table->Field(1, *table->Column("name")), "b");
  EXPECT_EQ(*table->Number(0, x), 1.5);
  EXPECT_EQ(*table->Number(1, x), -2000);
  EXPECT_FALSE(table->FindColumn("y").has_value());
}

TEST(Csv, UnderstandsQuotesBlanksAndLineEnds) {
  const auto table = ParseCsv("t.csv",
                              "\xef\xbb\xbf"
                              "a,b\r\n\r\n\"x, \"\"y\"\"\n z\", 2 \r\n\"\",3");
  ASSERT_TRUE(table.ok()) << table.status();
  ASSERT_EQ(table->RowCount(), 2U);
  EXPECT_EQ(table->Field(0, 0), "x, \"y\"\n z");
  EXPECT_EQ(table->Field(0, 1), "2");
  EXPECT_EQ(table->LineOf(0), 3);
  EXPECT_EQ(table->Field(1, 0), "");
  EXPECT_EQ(table->LineOf(1), 5);
}

TEST(Csv, StaysReadableWhenMoved) {
  auto table = ParseCsv("t.csv", "a\n1\n");
  ASSERT_TRUE(table.ok());
  const CsvTable moved = *std::move(table);
  EXPECT_EQ(moved.Field(0, 0), "1");
}

TEST(Csv, AMissingColumnListsThoseThereAre) {
  const auto table = ParseCsv("t.csv", "a,b\n1,2\n");
  ASSERT_TRUE(table.ok());
  const absl::Status status = table->Column("c").status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_THAT(std::string(status.message()), HasSubstr("t.csv:1"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("a, b"));
}

TEST(Csv, WhatIsNoFiniteNumberIsNamedByLineAndColumn) {
  for (const char* text : {"", "x", "1.5 m", "1,5", "nan", "inf", "-inf", "1e999", "0x10", "--1"}) {
    const auto table = ParseCsv("t.csv", "a,b\n1,1\n2,\"" + std::string(text) + "\"\n");
    ASSERT_TRUE(table.ok()) << table.status();
    const absl::Status status = table->Number(1, 1).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << text;
    EXPECT_THAT(std::string(status.message()), HasSubstr("t.csv:3, column b"));
  }
}

TEST(Csv, WholeNumbersHaveNoFraction) {
  const auto table = ParseCsv("t.csv", "a\n-7\n7.0\n99999999999999999999\n");
  ASSERT_TRUE(table.ok());
  EXPECT_EQ(*table->WholeNumber(0, 0), -7);
  EXPECT_FALSE(table->WholeNumber(1, 0).ok());
  EXPECT_FALSE(table->WholeNumber(2, 0).ok());
}

struct BadTable {
  const char* text;
  const char* words;
};

class MalformedCsv : public testing::TestWithParam<BadTable> {};

TEST_P(MalformedCsv, IsRefused) {
  const absl::Status status = ParseCsv("t.csv", GetParam().text).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr(GetParam().words));
}

INSTANTIATE_TEST_SUITE_P(Tables, MalformedCsv,
                         testing::Values(BadTable{"", "is empty"}, BadTable{"\n\n", "is empty"},
                                         BadTable{"a,b\n", "no row"},
                                         BadTable{"a,a\n1,2\n", "'a' twice"},
                                         BadTable{"a,\n1,2\n", "column 2 has no name"},
                                         BadTable{"a,b\n1,2\n1\n", "t.csv:3: has 1 fields"},
                                         BadTable{"a,b\n1,2,3\n", "t.csv:2: has 3 fields"},
                                         BadTable{"a\n\"1\n", "t.csv:2: opens a quote"},
                                         BadTable{"a\n\"1\"\"", "t.csv:2: opens a quote"},
                                         BadTable{"a\n\"1\"2\n", "t.csv:2: goes on after"},
                                         BadTable{"a\n1\"2\n", "t.csv:2: has a quote"},
                                         BadTable{"a\n1\r2\n", "t.csv:2: has a quote or control"}));

TEST(Csv, OfAMissingFileIsNotFound) {
  EXPECT_TRUE(absl::IsNotFound(ReadCsv("no/such/file.csv").status()));
}

}  // namespace
}  // namespace eyebox
