// What decides who may call.
#ifndef EYEBOX_SERVICE_SERVER_ACCESS_OPTIONS_H_
#define EYEBOX_SERVICE_SERVER_ACCESS_OPTIONS_H_

#include <filesystem>

#include "service/server/tls_files.h"

namespace eyebox::service {

struct AccessOptions {
  TlsFiles tls;                      // all three for TCP, none for a unix socket
  std::filesystem::path token_file;  // empty: no token is asked for
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_ACCESS_OPTIONS_H_
