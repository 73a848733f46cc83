#include "service/server/rpc_status.h"

#include <string>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr char kDomain[] = "eyebox";

google::rpc::BadRequest BadRequestOf(const std::string& field, const std::string& description) {
  google::rpc::BadRequest bad;
  google::rpc::BadRequest::FieldViolation& violation = *bad.add_field_violations();
  violation.set_field(field);
  violation.set_description(description);
  return bad;
}

std::string DetailsOf(const absl::Status& status, const std::string& message) {
  google::rpc::Status details;
  details.set_code(static_cast<int>(status.code()));
  details.set_message(message);
  google::rpc::ErrorInfo info;
  info.set_reason(absl::StatusCodeToString(status.code()));
  info.set_domain(kDomain);
  const std::string field = FieldOf(status);
  if (!field.empty()) {
    (*info.mutable_metadata())["field"] = field;
    details.add_details()->PackFrom(BadRequestOf(field, message));
  }
  details.add_details()->PackFrom(info);
  return details.SerializeAsString();
}

}  // namespace

grpc::Status ToRpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const std::string message(status.message());
  // Both number the canonical codes as google.rpc.Code does.
  return grpc::Status(static_cast<grpc::StatusCode>(status.code()), message,
                      DetailsOf(status, message));
}

}  // namespace eyebox::service
