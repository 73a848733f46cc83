#include "capture/recording/text_format.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

// Keeps the first error; lines and columns come counted from 0.
class FirstError final : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, google::protobuf::io::ColumnNumber, const std::string& what) override {
    if (!what_.empty()) return;
    line_ = line;
    what_ = what;
  }

  absl::Status ToStatus(const std::filesystem::path& file) const {
    const std::string line = line_ < 0 ? "" : ":" + std::to_string(line_ + 1);
    return BadInput(file.string() + line, what_.empty() ? "cannot be read" : what_,
                    "mend the line; proto/eyebox/v1/recording.proto lists the fields");
  }

 private:
  int line_ = -1;
  std::string what_;
};

}  // namespace

absl::Status ParseText(const std::string& text, const std::filesystem::path& file,
                       google::protobuf::Message& message) {
  FirstError error;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  return parser.ParseFromString(text, &message) ? absl::OkStatus() : error.ToStatus(file);
}

std::string PrintText(const google::protobuf::Message& message) {
  std::string text;
  google::protobuf::TextFormat::Printer printer;
  printer.SetUseUtf8StringEscaping(true);
  printer.PrintToString(message, &text);
  return text;
}

}  // namespace eyebox::capture
