// Forty names that no client has a reason to send, and every field of a request that takes a name.
#ifndef EYEBOX_TESTS_SERVICE_SERVER_HOSTILE_NAMES_H_
#define EYEBOX_TESTS_SERVICE_SERVER_HOSTILE_NAMES_H_

#include <grpcpp/grpcpp.h>

#include <functional>
#include <string>
#include <vector>

#include "eyebox/v1/service.grpc.pb.h"

namespace eyebox::service {

// protobuf itself refuses strings that are no UTF-8, so those here are.
const std::vector<std::string>& HostileNames();

struct NameField {
  std::string call;   // for messages
  std::string field;  // that the refusal must name
  std::function<grpc::Status(v1::RunService::Stub&, const std::string& name)> send;
};
const std::vector<NameField>& NameFields();

// The field that the details of `status` name, empty if none.
std::string ViolatedField(const grpc::Status& status);

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_SERVER_HOSTILE_NAMES_H_
