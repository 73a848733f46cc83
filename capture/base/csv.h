// Comma-separated tables with a header line, read strictly: what is wrong is named by file, line
// and column.
#ifndef EYEBOX_CAPTURE_BASE_CSV_H_
#define EYEBOX_CAPTURE_BASE_CSV_H_

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox {

// Rows and columns count from 0; lines, in messages, from 1. Fields lose the blanks around them
// unless quoted.
class CsvTable {
 public:
  size_t RowCount() const { return rows_.size(); }
  std::span<const std::string_view> Header() const { return header_; }
  const std::filesystem::path& File() const { return file_; }

  // Errors: InvalidArgument (no such column: lists those there are).
  absl::StatusOr<size_t> Column(std::string_view name) const;
  std::optional<size_t> FindColumn(std::string_view name) const;

  std::string_view Field(size_t row, size_t column) const { return rows_[row].fields[column]; }
  // Errors: InvalidArgument (empty, not a number, not finite).
  absl::StatusOr<double> Number(size_t row, size_t column) const;
  absl::StatusOr<long> WholeNumber(size_t row, size_t column) const;

  // "index.csv:3, column exposure_s": how a message about a field begins.
  std::string Where(size_t row, size_t column) const;
  int LineOf(size_t row) const { return rows_[row].line; }

 private:
  friend absl::StatusOr<CsvTable> ParseCsv(std::filesystem::path file, std::string text);

  struct Row {
    int line = 0;
    std::vector<std::string_view> fields;
  };

  std::filesystem::path file_;
  std::unique_ptr<std::string> text_;  // what the fields view
  std::vector<std::string_view> header_;
  std::vector<Row> rows_;
};

// RFC 4180: quoted fields, "" for a quote, LF or CRLF; also a byte order mark and empty lines.
// Errors: those of ReadWholeFile; InvalidArgument (no header or no row, a row of another length
// than the header, a column named twice or not at all, a quote that is misplaced or left open).
absl::StatusOr<CsvTable> ReadCsv(const std::filesystem::path& file,
                                 size_t limit_bytes = size_t{16} << 20);
// The same of text already in memory; `file` is what messages name.
absl::StatusOr<CsvTable> ParseCsv(std::filesystem::path file, std::string text);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_CSV_H_
