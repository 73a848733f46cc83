// One line in the log and one count for every call; gives each call an id that both sides see.
#ifndef EYEBOX_SERVICE_SERVER_OBSERVE_REQUEST_LOG_H_
#define EYEBOX_SERVICE_SERVER_OBSERVE_REQUEST_LOG_H_

#include <grpcpp/support/server_interceptor.h>

#include <memory>

#include "capture/base/clock.h"
#include "service/server/observe/log.h"
#include "service/server/observe/metrics.h"

namespace eyebox::service {

// The id is the metadata x-request-id of the call if the table of names lets it pass, else one that
// is made here; it returns in the trailing metadata x-request-id. All must outlive the server.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> MakeRequestLog(
    ServerLog* log, Metrics* metrics, const Clock* clock);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_OBSERVE_REQUEST_LOG_H_
