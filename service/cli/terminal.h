// What a person sees: results on stdout, progress on stderr.
#ifndef EYEBOX_SERVICE_CLI_TERMINAL_H_
#define EYEBOX_SERVICE_CLI_TERMINAL_H_

#include <google/protobuf/message.h>
#include <google/protobuf/repeated_ptr_field.h>

#include <string>

#include "absl/status/status.h"
#include "eyebox/v1/results.pb.h"
#include "service/watcher.h"

namespace eyebox::service::cli {

// The message as proto-JSON on stdout.
absl::Status PrintJson(const google::protobuf::Message& message);

// "gamma  2.301 +- 0.004", one line each.
void PrintParameters(const google::protobuf::RepeatedPtrField<v1::Parameter>& parameters);
void PrintCertificate(const v1::CubeResult& cube);
void PrintWarnings(const google::protobuf::RepeatedPtrField<std::string>& warnings);

// A bar that is redrawn on a terminal, one line per step otherwise. Cancelled by SIGINT.
Watcher TerminalWatcher();

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_TERMINAL_H_
