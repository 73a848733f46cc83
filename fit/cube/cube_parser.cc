#include "fit/cube/cube_parser.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

constexpr int kSmallestSize = 2;
constexpr int kLargestSize = 129;
constexpr std::string_view kBlank = " \t";

std::string_view Trim(std::string_view text) {
  const size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// Takes the first word off `text`.
std::string_view NextWord(std::string_view& text) {
  text = Trim(text);
  const size_t end = std::min(text.find_first_of(kBlank), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

// Shown in messages, so short and printable whatever the file holds.
std::string Quoted(std::string_view text) {
  std::string shown(text.substr(0, 40));
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  return "\"" + shown + (text.size() > 40 ? "...\"" : "\"");
}

bool BeginsNumber(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

class Parser {
 public:
  explicit Parser(std::string_view name) : name_(name) {}

  absl::Status Line(std::string_view line) {
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    line = Trim(line);
    if (line.empty() || line.front() == '#') return absl::OkStatus();
    std::string_view rest = line;
    const std::string_view word = NextWord(rest);
    // "nan" and "inf" read as words; where entries are due, they are bad entries.
    if (BeginsNumber(word.front()) || ReadsAsNumber(word)) return Entry(line);
    return Keyword(word, rest);
  }

  absl::StatusOr<Cube3d> Finish() {
    EYEBOX_RETURN_IF_ERROR(CheckDomain());
    if (cube_.size == 0) {
      return Refuse("the file ends without LUT_3D_SIZE", "give the size of the table, 2 to 129");
    }
    if (cube_.entries.size() < Expected()) {
      return Refuse(absl::StrCat("the file ends after ", cube_.entries.size(), " of ", Expected(),
                                 " entries"),
                    "write it again; it was cut short or its LUT_3D_SIZE is wrong");
    }
    return std::move(cube_);
  }

 private:
  absl::Status Refuse(const std::string& what, const std::string& remedy) const {
    return BadInput(absl::StrCat(name_, ":", line_), what, remedy);
  }

  size_t Expected() const { return static_cast<size_t>(cube_.size) * cube_.size * cube_.size; }

  static bool ReadsAsNumber(std::string_view word) {
    double value = 0;
    return std::from_chars(word.data(), word.data() + word.size(), value).ec == std::errc();
  }

  absl::StatusOr<double> Number(std::string_view word) const {
    float value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error == std::errc::result_out_of_range && stop == end) {
      return Refuse(absl::StrCat(Quoted(word), " is outside the range of a 32-bit float"),
                    "write entries as ordinary decimal numbers");
    }
    if (error != std::errc() || stop != end || !std::isfinite(value)) {
      return Refuse(absl::StrCat(Quoted(word), " is not a finite decimal number"),
                    "write entries as ordinary decimal numbers");
    }
    return value;
  }

  absl::StatusOr<std::array<double, 3>> Triplet(std::string_view text) const {
    std::array<double, 3> triplet{};
    std::string_view rest = text;
    for (double& value : triplet) {
      const std::string_view word = NextWord(rest);
      if (word.empty()) return RefuseCount(text);
      EYEBOX_ASSIGN_OR_RETURN(value, Number(word));
    }
    if (!Trim(rest).empty()) return RefuseCount(text);
    return triplet;
  }

  absl::Status RefuseCount(std::string_view text) const {
    return Refuse(absl::StrCat(Quoted(text), " does not hold exactly three numbers"),
                  "write red, green and blue, parted by blanks");
  }

  absl::Status Entry(std::string_view line) {
    if (cube_.size == 0) {
      return Refuse("an entry stands before LUT_3D_SIZE", "put LUT_3D_SIZE first");
    }
    if (cube_.entries.size() == Expected()) {
      return Refuse(
          absl::StrCat("surplus entry after the ", Expected(), " of a table of size ", cube_.size),
          "correct LUT_3D_SIZE or remove the surplus");
    }
    EYEBOX_ASSIGN_OR_RETURN(const auto entry, Triplet(line));
    cube_.entries.push_back(entry);
    return absl::OkStatus();
  }

  absl::Status Keyword(std::string_view word, std::string_view rest) {
    if (!cube_.entries.empty()) {
      return Refuse(absl::StrCat(Quoted(word), " stands among the entries"),
                    "put keywords before the first entry");
    }
    if (!seen_.insert(std::string(word)).second) {
      return Refuse(absl::StrCat(Quoted(word), " is given twice"), "keep one of them");
    }
    if (word == "TITLE") return Title(Trim(rest));
    if (word == "LUT_3D_SIZE") return Size(Trim(rest));
    if (word == "DOMAIN_MIN") return Domain(rest, cube_.domain_min);
    if (word == "DOMAIN_MAX") return Domain(rest, cube_.domain_max);
    if (word == "LUT_3D_INPUT_RANGE") return InputRange(rest);
    if (word == "LUT_1D_SIZE") {
      return Refuse("the table is one-dimensional (LUT_1D_SIZE)",
                    "give a three-dimensional table (LUT_3D_SIZE)");
    }
    return Refuse(absl::StrCat(Quoted(word), " is no keyword of a 3-D .cube file"),
                  "use TITLE, LUT_3D_SIZE, DOMAIN_MIN, DOMAIN_MAX, LUT_3D_INPUT_RANGE only");
  }

  absl::Status Title(std::string_view text) {
    if (text.size() < 2 || text.front() != '"' || text.back() != '"') {
      return Refuse("the title is not in double quotes", "write TITLE \"name\"");
    }
    cube_.title = std::string(text.substr(1, text.size() - 2));
    return absl::OkStatus();
  }

  absl::Status Size(std::string_view text) {
    int size = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, size);
    if (error != std::errc() || stop != end || size < kSmallestSize || size > kLargestSize) {
      return Refuse(absl::StrCat("LUT_3D_SIZE ", Quoted(text), " is not a whole number from ",
                                 kSmallestSize, " to ", kLargestSize),
                    "give the number of entries along one axis");
    }
    cube_.size = size;
    cube_.entries.reserve(Expected());
    return absl::OkStatus();
  }

  absl::Status Domain(std::string_view text, std::array<double, 3>& limit) {
    domain_line_ = line_;
    if (seen_.contains("LUT_3D_INPUT_RANGE")) {
      return Refuse("DOMAIN stands beside LUT_3D_INPUT_RANGE", "give the domain once");
    }
    EYEBOX_ASSIGN_OR_RETURN(limit, Triplet(text));
    return absl::OkStatus();
  }

  // Resolve's own way to write a domain that is the same for all channels.
  absl::Status InputRange(std::string_view text) {
    domain_line_ = line_;
    EYEBOX_ASSIGN_OR_RETURN(const double low, Number(NextWord(text)));
    EYEBOX_ASSIGN_OR_RETURN(const double high, Number(NextWord(text)));
    if (!Trim(text).empty() || seen_.contains("DOMAIN_MIN") || seen_.contains("DOMAIN_MAX")) {
      return Refuse("LUT_3D_INPUT_RANGE holds more than two numbers or stands beside a DOMAIN",
                    "give the domain once");
    }
    cube_.domain_min.fill(low);
    cube_.domain_max.fill(high);
    return absl::OkStatus();
  }

  // Once all keywords are read, since either limit may come first or keep its default.
  absl::Status CheckDomain() const {
    for (size_t i = 0; i < 3; ++i) {
      if (cube_.domain_min[i] < cube_.domain_max[i]) continue;
      return BadInput(absl::StrCat(name_, ":", domain_line_),
                      absl::StrCat("the domain is empty, DOMAIN_MIN ", cube_.domain_min[i],
                                   " is not below DOMAIN_MAX ", cube_.domain_max[i]),
                      "exchange or correct them");
    }
    return absl::OkStatus();
  }

  std::string name_;
  int line_ = 0;
  int domain_line_ = 0;
  std::set<std::string> seen_;
  Cube3d cube_;
};

}  // namespace

absl::StatusOr<Cube3d> ParseCube(std::string_view text, std::string_view name) {
  Parser parser(name);
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    EYEBOX_RETURN_IF_ERROR(parser.Line(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.Finish();
}

}  // namespace eyebox::fit
