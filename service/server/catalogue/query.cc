#include "service/server/catalogue/query.h"

#include <algorithm>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "capture/base/status.h"
#include "capture/recording/checksum.h"
#include "service/server/store/paging.h"
#include "service/server/store/served.h"

namespace eyebox::service {
namespace {

constexpr size_t kMaxTokenCharacters = 2000;

absl::Status ReadOrder(const std::string& order, CatalogueQuery& query) {
  const std::vector<std::string> words = absl::StrSplit(order, ' ', absl::SkipEmpty());
  if (words.empty()) return absl::OkStatus();
  query.by_start_time = words[0] == "start_time";
  query.descending = words.size() == 2 && words[1] == "desc";
  if ((query.by_start_time || words[0] == "name") && words.size() == 1u + query.descending) {
    return absl::OkStatus();
  }
  return BadField("order_by", Quoted(order) + " is no order",
                  "give name or start_time, or either with ' desc' behind it");
}

absl::StatusOr<CataloguePlace> ReadToken(const std::string& token, uint64_t question) {
  const auto refusal = [&](const std::string& what) {
    return BadField("page_token", what,
                    "give the next_page_token of the page before with its filter and order_by, or "
                    "none for the first page");
  };
  std::string text;
  if (token.size() > kMaxTokenCharacters || !absl::WebSafeBase64Unescape(token, &text)) {
    return refusal(Quoted(token) + " is no token");
  }
  const std::vector<std::string> parts = absl::StrSplit(text, ' ');
  CataloguePlace place;
  uint64_t asked = 0;
  if (parts.size() != 3 || !absl::SimpleHexAtoi(parts[0], &asked) ||
      !absl::SimpleAtoi(parts[1], &place.start_ns) ||
      !CheckName(kRecordingNameRule, "page_token", parts[2]).ok()) {
    return refusal(Quoted(token) + " is no token");
  }
  if (asked != question) return refusal("belongs to another filter or order_by");
  place.name = parts[2];
  return place;
}

}  // namespace

absl::StatusOr<CatalogueQuery> QueryOf(const v1::ListRecordingsRequest& request) {
  CatalogueQuery query;
  EYEBOX_ASSIGN_OR_RETURN(query.page_size, PageSizeOf(request.page_size()));
  EYEBOX_ASSIGN_OR_RETURN(query.filter, ParseFilter(request.filter()));
  EYEBOX_RETURN_IF_ERROR(ReadOrder(request.order_by(), query));
  query.question = capture::Checksum(
      absl::StrCat(request.filter(), "\n", query.by_start_time, query.descending));
  if (request.page_token().empty()) return query;
  EYEBOX_ASSIGN_OR_RETURN(query.after, ReadToken(request.page_token(), query.question));
  return query;
}

std::string TokenBehind(const CataloguePlace& last, const CatalogueQuery& query) {
  return absl::WebSafeBase64Escape(
      absl::StrCat(absl::Hex(query.question), " ", last.start_ns, " ", last.name));
}

CataloguePlace PlaceOf(const v1::RecordingEntry& entry) {
  return {.start_ns = std::max<int64_t>(entry.header().created_real_ns(), 0), .name = entry.name()};
}

}  // namespace eyebox::service
