#include "fit/cube/gamma_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "fit/cube/cube_text.h"

namespace eyebox::fit {
namespace {

constexpr size_t kRows = 256;
constexpr size_t kLargestBytes = size_t{1} << 20;
constexpr std::string_view kBlank = " \t";

absl::Status Refuse(std::string_view name, size_t line, const std::string& what) {
  return BadInput(absl::StrCat(std::string(name), ":", line), what,
                  "give 256 rows of red, green and blue from 0 to 1, parted by blanks");
}

// Takes the first word off `text`.
std::string_view NextWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlank));
  text.remove_prefix(word.size());
  return word;
}

absl::StatusOr<std::array<double, 3>> Row(std::string_view text, std::string_view name,
                                          size_t line) {
  std::array<double, 3> row{};
  for (double& value : row) {
    const std::string_view word = NextWord(text);
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (word.empty() || error != std::errc() || stop != end) {
      return Refuse(name, line, "the row does not hold three decimal numbers");
    }
    if (!(value >= 0 && value <= 1)) {
      return Refuse(name, line, absl::StrCat(value, " is outside [0, 1]"));
    }
  }
  if (!NextWord(text).empty()) return Refuse(name, line, "the row holds more than three numbers");
  return row;
}

}  // namespace

absl::StatusOr<std::string> EncodeGammaTable(const TableDesign& table) {
  if (table.target != TableTarget::kPtb || table.entries.size() != kRows) {
    return BadInput("gamma table",
                    absl::StrCat("the table was designed for ", std::string(NameOf(table.target)),
                                 " with ", table.entries.size(), " entries"),
                    "design it for ptb with 256");
  }
  std::string text;
  for (double entry : table.entries) {
    if (!(entry >= 0 && entry <= 1)) {
      return BadInput("gamma table", absl::StrCat("entry ", entry, " is outside [0, 1]"),
                      "give drive values");
    }
    AppendTriplet(text, {entry, entry, entry});
  }
  return text;
}

absl::StatusOr<GammaTable> ParseGammaTable(std::string_view text, std::string_view name) {
  GammaTable table;
  for (size_t line = 1; !text.empty(); ++line) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view row = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (table.size() == kRows) {
      if (row.find_first_not_of(kBlank) == std::string_view::npos) continue;
      return Refuse(name, line, "surplus row after the 256");
    }
    EYEBOX_ASSIGN_OR_RETURN(const auto values, Row(row, name, line));
    table.push_back(values);
  }
  if (table.size() == kRows) return table;
  return Refuse(name, table.size(), absl::StrCat("the file ends after ", table.size(), " rows"));
}

absl::StatusOr<GammaTable> ReadGammaTable(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file, kLargestBytes));
  return ParseGammaTable(text, file.string());
}

}  // namespace eyebox::fit
