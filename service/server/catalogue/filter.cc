#include "service/server/catalogue/filter.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "capture/base/status.h"
#include "eyebox/v1/recording_service.pb.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr size_t kMaxFilterCharacters = 1000;
constexpr size_t kMaxConditions = 20;

enum class Kind { kText, kNumber, kTime, kState, kOrigin, kList };

struct FieldRow {
  std::string_view name;
  FilterField field;
  Kind kind;
};
constexpr std::array kFields = {
    FieldRow{"name", FilterField::kName, Kind::kText},
    FieldRow{"rig", FilterField::kRig, Kind::kText},
    FieldRow{"camera", FilterField::kCamera, Kind::kText},
    FieldRow{"state", FilterField::kState, Kind::kState},
    FieldRow{"origin", FilterField::kOrigin, Kind::kOrigin},
    FieldRow{"start_time", FilterField::kStartTime, Kind::kTime},
    FieldRow{"captures", FilterField::kCaptures, Kind::kNumber},
    FieldRow{"frames", FilterField::kFrames, Kind::kNumber},
    FieldRow{"bytes", FilterField::kBytes, Kind::kNumber},
    FieldRow{"levels", FilterField::kLevels, Kind::kNumber},
    FieldRow{"series", FilterField::kSeries, Kind::kList},
    FieldRow{"results", FilterField::kResults, Kind::kList},
};

struct OperatorRow {
  std::string_view name;
  FilterOperator comparison;
};
// Those that begin like another come first.
constexpr std::array kOperators = {
    OperatorRow{"!=", FilterOperator::kNotEqual},
    OperatorRow{"<=", FilterOperator::kLessOrEqual},
    OperatorRow{">=", FilterOperator::kGreaterOrEqual},
    OperatorRow{"=", FilterOperator::kEqual},
    OperatorRow{"<", FilterOperator::kLess},
    OperatorRow{">", FilterOperator::kGreater},
    OperatorRow{":", FilterOperator::kHas},
};

struct Word {
  std::string_view name;
  int value;
};
constexpr std::array kStates = {Word{"COMPLETE", v1::RECORDING_STATE_COMPLETE},
                                Word{"PARTIAL", v1::RECORDING_STATE_PARTIAL},
                                Word{"DAMAGED", v1::RECORDING_STATE_DAMAGED}};
constexpr std::array kOrigins = {Word{"CAPTURED", v1::RECORDING_ORIGIN_CAPTURED},
                                 Word{"SIMULATED", v1::RECORDING_ORIGIN_SIMULATED},
                                 Word{"IMPORTED", v1::RECORDING_ORIGIN_IMPORTED}};

absl::string_view View(std::string_view text) { return {text.data(), text.size()}; }

template <typename Rows>
std::string NamesOf(const Rows& rows) {
  std::string names;
  for (const auto& row : rows) absl::StrAppend(&names, names.empty() ? "" : ", ", View(row.name));
  return names;
}

bool Suits(FilterOperator comparison, Kind kind) {
  switch (comparison) {
    case FilterOperator::kHas:
      return kind == Kind::kList;
    case FilterOperator::kEqual:
    case FilterOperator::kNotEqual:
      return kind != Kind::kList;
    default:
      return kind == Kind::kNumber || kind == Kind::kTime;
  }
}

std::string_view OperatorsOf(Kind kind) {
  switch (kind) {
    case Kind::kList:
      return ":";
    case Kind::kNumber:
    case Kind::kTime:
      return "= != < <= > >=";
    default:
      return "= or !=";
  }
}

bool IsNameCharacter(char c) {
  return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '_';
}
bool IsBareCharacter(char c) {
  return IsNameCharacter(c) || std::string_view(".:/+*-").find(c) != std::string_view::npos;
}

// A time of the forms "2026-11-01", "2026-11-01T09:30:00" and with Z, +01:00 or a fraction.
bool ReadTime(const std::string& text, int64_t& nanoseconds) {
  constexpr size_t kYearCharacters = 4;
  // Other years than those of four digits have no place among nanoseconds.
  if (text.find_first_not_of("0123456789") != kYearCharacters) return false;
  absl::Time time;
  for (const char* form : {"%Y-%m-%d", "%Y-%m-%dT%H:%M:%E*S", absl::RFC3339_full}) {
    if (!absl::ParseTime(form, text, &time, nullptr)) continue;
    nanoseconds = absl::ToUnixNanos(time);
    return absl::FromUnixNanos(nanoseconds) == time;
  }
  return false;
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  absl::StatusOr<Filter> Parse() {
    Filter filter;
    SkipSpace();
    while (at_ < text_.size()) {
      if (filter.size() == kMaxConditions) {
        return Refuse(at_, "one condition too many begins",
                      absl::StrCat("give at most ", kMaxConditions));
      }
      if (!filter.empty()) EYEBOX_RETURN_IF_ERROR(ReadAnd());
      EYEBOX_ASSIGN_OR_RETURN(FilterCondition condition, ReadCondition());
      filter.push_back(std::move(condition));
      SkipSpace();
    }
    return filter;
  }

 private:
  static absl::Status Refuse(size_t at, const std::string& what, const std::string& remedy) {
    return BadField("filter", absl::StrCat("at character ", at + 1, ", ", what), remedy);
  }

  void SkipSpace() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  // What stands at `at_`, as far as it looks like one thing; for messages.
  std::string Here() const {
    if (at_ >= text_.size()) return "the end";
    size_t end = at_;
    while (end < text_.size() && IsNameCharacter(text_[end])) ++end;
    return Quoted(text_.substr(at_, std::max<size_t>(end - at_, 1)));
  }

  std::string_view ReadName() {
    const size_t begin = at_;
    while (at_ < text_.size() && IsNameCharacter(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  absl::Status ReadAnd() {
    const size_t begin = at_;
    const std::string here = Here();
    if (ReadName() != "AND") {
      return Refuse(begin, "there is " + here + " where AND or the end was expected",
                    "join conditions by AND; there is no OR, NOT or parenthesis");
    }
    SkipSpace();
    return absl::OkStatus();
  }

  absl::StatusOr<FilterCondition> ReadCondition() {
    EYEBOX_ASSIGN_OR_RETURN(const FieldRow field, ReadField());
    SkipSpace();
    FilterCondition condition = {.field = field.field, .value = std::string()};
    EYEBOX_ASSIGN_OR_RETURN(condition.comparison, ReadOperator(field));
    SkipSpace();
    const size_t begin = at_;
    EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadText());
    EYEBOX_RETURN_IF_ERROR(SetValue(begin, field, text, condition));
    return condition;
  }

  absl::StatusOr<FieldRow> ReadField() {
    const size_t begin = at_;
    const std::string here = Here();
    const std::string_view name = ReadName();
    for (const FieldRow& row : kFields) {
      if (row.name == name) return row;
    }
    return Refuse(begin, here + " is no field", "give one of " + NamesOf(kFields));
  }

  absl::StatusOr<FilterOperator> ReadOperator(const FieldRow& field) {
    for (const OperatorRow& row : kOperators) {
      if (!text_.substr(at_).starts_with(row.name)) continue;
      if (!Suits(row.comparison, field.kind)) {
        return Refuse(at_, absl::StrCat(View(field.name), " has no ", View(row.name)),
                      absl::StrCat("compare it by ", View(OperatorsOf(field.kind))));
      }
      at_ += row.name.size();
      return row.comparison;
    }
    return Refuse(
        at_, "there is " + Here() + " where an operator was expected",
        absl::StrCat("compare ", View(field.name), " by ", View(OperatorsOf(field.kind))));
  }

  absl::StatusOr<std::string> ReadText() {
    if (at_ < text_.size() && (text_[at_] == '"' || text_[at_] == '\'')) return ReadQuoted();
    const size_t begin = at_;
    while (at_ < text_.size() && IsBareCharacter(text_[at_])) ++at_;
    const std::string text(text_.substr(begin, at_ - begin));
    if (!text.empty() && text != "AND") return text;
    at_ = begin;
    return Refuse(begin, "there is " + Here() + " where a value was expected",
                  "give a number, a word, or text within quotes");
  }

  absl::StatusOr<std::string> ReadQuoted() {
    const size_t begin = at_;
    const char quote = text_[at_++];
    std::string text;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == quote) {
        ++at_;
        return text;
      }
      if (absl::ascii_iscntrl(static_cast<unsigned char>(text_[at_]))) {
        return Refuse(at_, "there is a control character", "leave it out");
      }
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      text += text_[at_];
    }
    return Refuse(begin, "a quote is opened and never closed",
                  R"(close it; within quotes, \" stands for " and \\ for \)");
  }

  static absl::Status SetWord(size_t begin, std::span<const Word> words, const std::string& text,
                              FilterCondition& condition) {
    for (const Word& word : words) {
      if (word.name != text) continue;
      condition.value = int64_t{word.value};
      return absl::OkStatus();
    }
    return Refuse(begin, Quoted(text) + " is unknown", "give one of " + NamesOf(words));
  }

  static absl::Status SetValue(size_t begin, const FieldRow& field, const std::string& text,
                               FilterCondition& condition) {
    int64_t number = 0;
    switch (field.kind) {
      case Kind::kText:
        condition.any_rest = text.ends_with('*');
        condition.value = condition.any_rest ? text.substr(0, text.size() - 1) : text;
        return absl::OkStatus();
      case Kind::kList:
        condition.value = text;
        return absl::OkStatus();
      case Kind::kState:
        return SetWord(begin, kStates, text, condition);
      case Kind::kOrigin:
        return SetWord(begin, kOrigins, text, condition);
      case Kind::kNumber:
        condition.value = number;
        if (absl::SimpleAtoi(text, &std::get<int64_t>(condition.value))) return absl::OkStatus();
        return Refuse(begin, Quoted(text) + " is no whole number", "give one, such as 100");
      case Kind::kTime:
        condition.value = number;
        if (ReadTime(text, std::get<int64_t>(condition.value))) return absl::OkStatus();
        return Refuse(begin, Quoted(text) + " is no time",
                      "give a date or a time, such as 2026-11-01 or 2026-11-01T09:30:00Z");
    }
    return absl::OkStatus();
  }

  const std::string_view text_;
  size_t at_ = 0;
};

}  // namespace

absl::StatusOr<Filter> ParseFilter(std::string_view filter) {
  if (filter.size() > kMaxFilterCharacters) {
    return BadField("filter", absl::StrCat("is ", filter.size(), " characters long"),
                    absl::StrCat("give at most ", kMaxFilterCharacters));
  }
  return Parser(filter).Parse();
}

}  // namespace eyebox::service
