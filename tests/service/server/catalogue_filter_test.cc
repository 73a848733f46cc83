// What a client may ask the catalogue for, and how it is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "eyebox/v1/recording_service.pb.h"
#include "service/server/catalogue/filter.h"
#include "service/server/catalogue/query.h"
#include "service/server/catalogue/select.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;
using testing::Not;

Filter Parsed(const std::string& text) {
  const auto filter = ParseFilter(text);
  EXPECT_TRUE(filter.ok()) << text << ": " << filter.status();
  return filter.ok() ? *filter : Filter();
}

std::string Refusal(const std::string& text) {
  const auto filter = ParseFilter(text);
  EXPECT_TRUE(absl::IsInvalidArgument(filter.status())) << text;
  EXPECT_EQ(FieldOf(filter.status()), "filter") << text;
  return std::string(filter.status().message());
}

TEST(CatalogueFilter, ReadsConditionsOfEveryKind) {
  EXPECT_TRUE(Parsed("").empty());
  EXPECT_TRUE(Parsed("   ").empty());
  const Filter filter = Parsed(
      R"(rig = "left \"eye\"" AND  state=COMPLETE AND frames >= 100 AND series:'' AND name != a/b*)");
  ASSERT_EQ(filter.size(), 5u);
  EXPECT_EQ(filter[0].field, FilterField::kRig);
  EXPECT_EQ(std::get<std::string>(filter[0].value), R"(left "eye")");
  EXPECT_FALSE(filter[0].any_rest);
  EXPECT_EQ(std::get<int64_t>(filter[1].value), v1::RECORDING_STATE_COMPLETE);
  EXPECT_EQ(filter[2].comparison, FilterOperator::kGreaterOrEqual);
  EXPECT_EQ(std::get<int64_t>(filter[2].value), 100);
  EXPECT_EQ(filter[3].comparison, FilterOperator::kHas);
  EXPECT_EQ(std::get<std::string>(filter[3].value), "");
  EXPECT_EQ(filter[4].comparison, FilterOperator::kNotEqual);
  EXPECT_EQ(std::get<std::string>(filter[4].value), "a/b");
  EXPECT_TRUE(filter[4].any_rest);
}

TEST(CatalogueFilter, ReadsTimesToTheNanosecond) {
  const auto ns = [](const std::string& time) {
    return std::get<int64_t>(Parsed("start_time > " + time).at(0).value);
  };
  constexpr int64_t kNovember = 1'793'491'200'000'000'000;  // date -d 2026-11-01T00:00Z +%s
  EXPECT_EQ(ns("2026-11-01"), kNovember);
  EXPECT_EQ(ns("\"2026-11-01T00:00:00Z\""), kNovember);
  EXPECT_EQ(ns("2026-11-01T01:00:00+01:00"), kNovember);
  EXPECT_EQ(ns("2026-11-01T00:00:00.000000001"), kNovember + 1);
  for (const char* bad : {"2026", "2026-13-01", "26-11-01", "infinite-future",
                          "2026-11-01T25:00:00", "9999-01-01", "-999-01-01", "tomorrow"}) {
    EXPECT_THAT(Refusal(std::string("start_time > ") + bad), HasSubstr("at character 14")) << bad;
  }
}

TEST(CatalogueFilter, RefusalSaysWhereAndWhatIsExpected) {
  EXPECT_THAT(Refusal("colour = 1"), HasSubstr("at character 1, 'colour' is no field; give one of "
                                               "name, rig"));
  EXPECT_THAT(Refusal("rig = a OR rig = b"), HasSubstr("at character 9, there is 'OR'"));
  EXPECT_THAT(Refusal("NOT rig = a"), HasSubstr("at character 1, 'NOT' is no field"));
  EXPECT_THAT(Refusal("(rig = a)"), HasSubstr("at character 1, '(' is no field"));
  EXPECT_THAT(Refusal("rig < a"), HasSubstr("at character 5, rig has no <; compare it by = or !="));
  EXPECT_THAT(Refusal("rig ~ a"), HasSubstr("at character 5, there is '~'"));
  EXPECT_THAT(Refusal("rig"), HasSubstr("at character 4, there is the end"));
  EXPECT_THAT(Refusal("rig = "), HasSubstr("at character 7, there is the end"));
  EXPECT_THAT(Refusal("rig = AND"), HasSubstr("at character 7, there is 'AND'"));
  EXPECT_THAT(Refusal("rig = a AND"), HasSubstr("at character 12, the end is no field"));
  EXPECT_THAT(Refusal("rig = \"a"), HasSubstr("at character 7, a quote is opened"));
  EXPECT_THAT(Refusal("state = complete"), HasSubstr("at character 9, 'complete' is unknown; give "
                                                     "one of COMPLETE, PARTIAL, DAMAGED"));
  EXPECT_THAT(Refusal("frames = 1.5"), HasSubstr("at character 10, '1.5' is no whole number"));
  EXPECT_THAT(Refusal("frames = 9223372036854775808"), HasSubstr("no whole number"));
  EXPECT_THAT(Refusal("series = a"), HasSubstr("series has no =; compare it by :"));
  EXPECT_THAT(Refusal("rig = \"\n\""), HasSubstr("at character 8, there is a control character"));
  EXPECT_THAT(Refusal(std::string(1001, ' ')), HasSubstr("1001 characters"));
  std::string many = "rig = a";
  for (int i = 0; i < 20; ++i) many += " AND rig = a";
  EXPECT_THAT(Refusal(many), HasSubstr("one condition too many"));
}

// Whatever a client sends, it is bound and never becomes part of a statement.
TEST(CatalogueFilter, ValuesNeverStandInTheStatement) {
  const std::string attack = "x'); DROP TABLE recordings; --";
  CatalogueQuery query;
  query.filter = Parsed("rig = \"" + attack + "\" AND series : \"" + attack + "\" AND name != \"" +
                        attack + "*\"");
  query.page_size = 5;
  query.after = {.start_ns = 1, .name = attack};
  for (const bool by_start_time : {false, true}) {
    query.by_start_time = by_start_time;
    const BoundSql sql = SqlOf(query);
    EXPECT_THAT(sql.where_and_order, Not(HasSubstr("DROP")));
    EXPECT_EQ(sql.values.size(), by_start_time ? 6u : 5u);
  }
}

TEST(CatalogueFilter, AnythingIsReadOrRefusedInAFewPrintableWords) {
  std::mt19937 random(7);
  const std::vector<std::string> pieces = {
      "rig", "state", "frames", "series", " ", "=",          "!=",       "<",
      ">=",  ":",     "AND",    "\"",     "'", "\\",         "*",        "(",
      "-1",  "\x01",  "\xff",   "%",      ";", "2026-11-01", "COMPLETE", std::string(1, '\0')};
  int read = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text;
    for (auto left = random() % 8; left > 0; --left) text += pieces[random() % pieces.size()];
    const auto filter = ParseFilter(text);
    if (filter.ok()) {
      ++read;
      continue;
    }
    const std::string message(filter.status().message());
    ASSERT_TRUE(absl::IsInvalidArgument(filter.status()));
    ASSERT_LT(message.size(), 400u);
    for (const char c : message) ASSERT_TRUE(c >= ' ' && c < 127) << message;
  }
  EXPECT_GT(read, 100);
}

TEST(CatalogueQuery, OrderAndTokenOfAnotherQuestionAreRefused) {
  v1::ListRecordingsRequest request;
  request.set_order_by("start_time desc");
  request.set_filter("rig = a");
  const auto query = QueryOf(request);
  ASSERT_TRUE(query.ok()) << query.status();
  EXPECT_TRUE(query->by_start_time && query->descending);
  EXPECT_EQ(query->page_size, 20);
  request.set_page_token(TokenBehind({.start_ns = 5, .name = "recordings/a/b"}, *query));
  const auto second = QueryOf(request);
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(second->after->start_ns, 5);
  EXPECT_EQ(second->after->name, "recordings/a/b");

  const auto field = [&](auto change) {
    v1::ListRecordingsRequest changed = request;
    change(changed);
    const absl::Status status = QueryOf(changed).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    return FieldOf(status);
  };
  using R = v1::ListRecordingsRequest;
  EXPECT_EQ(field([](R& r) { r.set_filter("rig = b"); }), "page_token");
  EXPECT_EQ(field([](R& r) { r.set_order_by("start_time"); }), "page_token");
  for (const char* token : {"recordings/a", "====", "MSAyIDM", "MSAyIC4uLy4u"}) {
    EXPECT_EQ(field([&](R& r) { r.set_page_token(token); }), "page_token") << token;
  }
  EXPECT_EQ(field([](R& r) { r.set_page_token(std::string(100'000, 'A')); }), "page_token");
  for (const char* order : {"size", "name asc", "desc", "name desc desc", "name, start_time"}) {
    EXPECT_EQ(field([&](R& r) { r.set_order_by(order); }), "order_by") << order;
  }
  EXPECT_EQ(field([](R& r) { r.set_page_size(101); }), "page_size");
  EXPECT_EQ(field([](R& r) { r.set_page_size(-1); }), "page_size");
}

}  // namespace
}  // namespace eyebox::service
