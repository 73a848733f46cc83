// Messages as text: strict reading, stable writing.
#ifndef EYEBOX_CAPTURE_RECORDING_TEXT_FORMAT_H_
#define EYEBOX_CAPTURE_RECORDING_TEXT_FORMAT_H_

#include <google/protobuf/message.h>

#include <filesystem>
#include <string>

#include "absl/status/status.h"

namespace eyebox::capture {

// Unknown fields, repeated single fields and bad values are refused.
// Errors: InvalidArgument naming file, line and what the parser found.
absl::Status ParseText(const std::string& text, const std::filesystem::path& file,
                       google::protobuf::Message& message);

// Numbers are printed so that reading gives back the same bits.
std::string PrintText(const google::protobuf::Message& message);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_TEXT_FORMAT_H_
