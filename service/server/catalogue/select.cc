#include "service/server/catalogue/select.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace eyebox::service {
namespace {

constexpr char kStart[] = "ifnull(start_ns, 0)";

const char* ColumnOf(FilterField field) {
  switch (field) {
    case FilterField::kName:
      return "name";
    case FilterField::kRig:
      return "rig";
    case FilterField::kCamera:
      return "camera";
    case FilterField::kState:
      return "state";
    case FilterField::kOrigin:
      return "origin";
    case FilterField::kStartTime:
      return "start_ns";  // NULL where it is not known: no comparison holds
    case FilterField::kCaptures:
      return "captures";
    case FilterField::kFrames:
      return "frames";
    case FilterField::kBytes:
      return "bytes";
    case FilterField::kLevels:
      return "levels";
    case FilterField::kSeries:
      return "series";
    case FilterField::kResults:
      return "results";
  }
  return "NULL";
}

const char* SymbolOf(FilterOperator comparison) {
  switch (comparison) {
    case FilterOperator::kEqual:
      return "=";
    case FilterOperator::kNotEqual:
      return "<>";
    case FilterOperator::kLess:
      return "<";
    case FilterOperator::kLessOrEqual:
      return "<=";
    case FilterOperator::kGreater:
      return ">";
    case FilterOperator::kGreaterOrEqual:
      return ">=";
    case FilterOperator::kHas:
      return "";
  }
  return "";
}

std::string Bind(std::variant<int64_t, std::string> value, BoundSql& sql) {
  sql.values.push_back(std::move(value));
  return absl::StrCat("?", sql.values.size());
}

std::string TermOf(const FilterCondition& condition, BoundSql& sql) {
  const char* column = ColumnOf(condition.field);
  if (condition.comparison == FilterOperator::kHas) {
    const std::string name = kNameFence + std::get<std::string>(condition.value) + kNameFence;
    return absl::StrCat("instr(", column, ", ", Bind(name, sql), ") > 0");
  }
  const std::string value = Bind(condition.value, sql);
  const char* symbol = SymbolOf(condition.comparison);
  if (!condition.any_rest) return absl::StrCat(column, " ", symbol, " ", value);
  return absl::StrCat("substr(", column, ", 1, length(", value, ")) ", symbol, " ", value);
}

}  // namespace

BoundSql SqlOf(const CatalogueQuery& query) {
  BoundSql sql;
  std::vector<std::string> terms;
  for (const FilterCondition& condition : query.filter) terms.push_back(TermOf(condition, sql));
  const std::string key = query.by_start_time ? absl::StrCat(kStart, ", name") : "name";
  if (query.after) {
    const std::string start =
        query.by_start_time ? Bind(query.after->start_ns, sql) + ", " : std::string();
    const std::string name = Bind(query.after->name, sql);
    terms.push_back(
        absl::StrCat("(", key, ") ", query.descending ? "<" : ">", " (", start, name, ")"));
  }
  const char* direction = query.descending ? " DESC" : "";
  if (!terms.empty()) {
    sql.where_and_order = absl::StrCat(" WHERE ", absl::StrJoin(terms, " AND "));
  }
  absl::StrAppend(&sql.where_and_order, " ORDER BY ",
                  query.by_start_time ? absl::StrCat(kStart, direction, ", ") : "", "name",
                  direction, " LIMIT ", Bind(int64_t{query.page_size} + 1, sql));
  return sql;
}

}  // namespace eyebox::service
