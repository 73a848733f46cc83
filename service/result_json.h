// Result messages as JSON: names as in the proto files, every field printed, doubles that read
// back to the same bits.
#ifndef EYEBOX_SERVICE_RESULT_JSON_H_
#define EYEBOX_SERVICE_RESULT_JSON_H_

#include <google/protobuf/message.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::service {

absl::StatusOr<std::string> ToJson(const google::protobuf::Message& message);

// Errors: InvalidArgument naming `where` the text came from.
absl::Status ParseJson(std::string_view json, std::string_view where,
                       google::protobuf::Message& message);

// Errors: InvalidArgument naming the file; NotFound.
absl::Status ReadJson(const std::filesystem::path& file, google::protobuf::Message& message);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULT_JSON_H_
