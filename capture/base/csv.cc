#include "capture/base/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "capture/base/file.h"
#include "capture/base/status.h"

namespace eyebox {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string_view WithoutBlanks(std::string_view field) {
  const size_t first = field.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return field.substr(first, field.find_last_not_of(" \t") - first + 1);
}

std::string Quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

// Unescapes quoted fields in place: what is written never overtakes what is read.
class CsvScanner {
 public:
  CsvScanner(const std::filesystem::path& file, std::string& text) : file_(file), text_(text) {
    if (std::string_view(text).starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  }

  int line() const { return line_; }

  // The fields of the next line that is not empty; none at the end of the text.
  absl::StatusOr<std::vector<std::string_view>> NextRow() {
    while (at_ < text_.size() && SkipLineEnd()) {
    }
    std::vector<std::string_view> fields;
    row_line_ = line_;
    if (at_ >= text_.size()) return fields;
    while (true) {
      EYEBOX_ASSIGN_OR_RETURN(fields.emplace_back(), NextField());
      if (at_ >= text_.size() || SkipLineEnd()) return fields;
      ++at_;  // the comma
    }
  }

  int row_line() const { return row_line_; }

 private:
  bool AtLineEnd() const {
    return text_[at_] == '\n' ||
           (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n');
  }

  bool SkipLineEnd() {
    if (!AtLineEnd()) return false;
    at_ += text_[at_] == '\r' ? 2 : 1;
    ++line_;
    return true;
  }

  bool AtFieldEnd() const { return at_ >= text_.size() || text_[at_] == ',' || AtLineEnd(); }

  absl::StatusOr<std::string_view> NextField() {
    if (at_ < text_.size() && text_[at_] == '"') return QuotedField();
    const size_t begin = at_;
    while (!AtFieldEnd()) {
      if (text_[at_] == '"' || text_[at_] == '\0' || text_[at_] == '\r') {
        return Wrong("has a quote or control character inside a field",
                     "put the whole field in quotes and double the quotes in it");
      }
      ++at_;
    }
    return WithoutBlanks(std::string_view(text_).substr(begin, at_ - begin));
  }

  absl::StatusOr<std::string_view> QuotedField() {
    const size_t begin = ++at_;
    size_t end = begin;
    bool closed = false;
    while (at_ < text_.size()) {
      if (text_[at_] == '"') {
        ++at_;
        closed = at_ >= text_.size() || text_[at_] != '"';
        if (closed) break;
      } else if (text_[at_] == '\n') {
        ++line_;
      }
      text_[end++] = text_[at_++];
    }
    if (!closed) return Wrong("opens a quote that nothing closes", "close it");
    if (!AtFieldEnd()) return Wrong("goes on after a closing quote", "put a comma there");
    return std::string_view(text_).substr(begin, end - begin);
  }

  absl::Status Wrong(std::string_view what, std::string_view remedy) const {
    return BadInput(file_.string() + ":" + std::to_string(row_line_), what, remedy);
  }

  const std::filesystem::path& file_;
  std::string& text_;
  size_t at_ = 0;
  int line_ = 1;
  int row_line_ = 1;
};

absl::Status CheckHeader(const std::filesystem::path& file,
                         const std::vector<std::string_view>& header) {
  if (header.empty()) {
    return BadInput(file.string(), "is empty", "give a header line with column names, then rows");
  }
  for (size_t i = 0; i < header.size(); ++i) {
    if (header[i].empty()) {
      return BadInput(file.string() + ":1", "column " + std::to_string(i + 1) + " has no name",
                      "name every column once");
    }
    if (std::count(header.begin(), header.end(), header[i]) > 1) {
      return BadInput(file.string() + ":1", "names column " + Quoted(header[i]) + " twice",
                      "name every column once");
    }
  }
  return absl::OkStatus();
}

template <typename T>
absl::StatusOr<T> Parse(const CsvTable& table, size_t row, size_t column,
                        std::string_view expected) {
  const std::string_view field = table.Field(row, column);
  T value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc() && end == field.data() + field.size()) return value;
  return BadInput(table.Where(row, column), "holds " + Quoted(field),
                  "give " + std::string(expected));
}

}  // namespace

std::optional<size_t> CsvTable::FindColumn(std::string_view name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) return std::nullopt;
  return static_cast<size_t>(found - header_.begin());
}

absl::StatusOr<size_t> CsvTable::Column(std::string_view name) const {
  if (const auto column = FindColumn(name)) return *column;
  std::string known;
  for (const std::string_view column : header_) {
    known += (known.empty() ? "" : ", ") + std::string(column);
  }
  return BadInput(file_.string() + ":1", "has no column " + Quoted(name) + ", only " + known,
                  "add the column to the header line");
}

absl::StatusOr<double> CsvTable::Number(size_t row, size_t column) const {
  constexpr std::string_view kExpected = "a finite number with a decimal point";
  EYEBOX_ASSIGN_OR_RETURN(const double value, Parse<double>(*this, row, column, kExpected));
  if (std::isfinite(value)) return value;
  return BadInput(Where(row, column), "holds " + Quoted(Field(row, column)),
                  "give " + std::string(kExpected));
}

absl::StatusOr<long> CsvTable::WholeNumber(size_t row, size_t column) const {
  return Parse<long>(*this, row, column, "a whole number");
}

std::string CsvTable::Where(size_t row, size_t column) const {
  return file_.string() + ":" + std::to_string(LineOf(row)) + ", column " +
         std::string(header_[column]);
}

absl::StatusOr<CsvTable> ReadCsv(const std::filesystem::path& file, size_t limit_bytes) {
  EYEBOX_ASSIGN_OR_RETURN(std::string text, ReadWholeFile(file, limit_bytes));
  return ParseCsv(file, std::move(text));
}

absl::StatusOr<CsvTable> ParseCsv(std::filesystem::path file, std::string text) {
  CsvTable table;
  table.file_ = std::move(file);
  table.text_ = std::make_unique<std::string>(std::move(text));
  CsvScanner scanner(table.file_, *table.text_);
  EYEBOX_ASSIGN_OR_RETURN(table.header_, scanner.NextRow());
  EYEBOX_RETURN_IF_ERROR(CheckHeader(table.file_, table.header_));
  while (true) {
    CsvTable::Row row;
    EYEBOX_ASSIGN_OR_RETURN(row.fields, scanner.NextRow());
    if (row.fields.empty()) break;
    row.line = scanner.row_line();
    if (row.fields.size() != table.header_.size()) {
      return BadInput(table.file_.string() + ":" + std::to_string(row.line),
                      "has " + std::to_string(row.fields.size()) + " fields, the header has " +
                          std::to_string(table.header_.size()),
                      "give one field for every column");
    }
    table.rows_.push_back(std::move(row));
  }
  if (table.rows_.empty()) {
    return BadInput(table.file_.string(), "has no row below its header line", "add one or more");
  }
  return table;
}

}  // namespace eyebox
