#include "service/result_json.h"

#include <google/protobuf/util/json_util.h>

#include "capture/base/file.h"
#include "capture/base/status.h"

namespace eyebox::service {

absl::StatusOr<std::string> ToJson(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(message, &json, options);
  if (!status.ok()) return absl::InternalError(status.ToString());
  return json;
}

absl::Status ParseJson(std::string_view json, std::string_view where,
                       google::protobuf::Message& message) {
  const auto status = google::protobuf::util::JsonStringToMessage(
      google::protobuf::StringPiece(json.data(), json.size()), &message);
  if (status.ok()) return absl::OkStatus();
  return BadInput(
      where,
      "is not a " + message.GetDescriptor()->name() + " in JSON: " + std::string(status.message()),
      "give what eyebox wrote");
}

absl::Status ReadJson(const std::filesystem::path& file, google::protobuf::Message& message) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ReadWholeFile(file));
  return ParseJson(json, file.string(), message);
}

}  // namespace eyebox::service
