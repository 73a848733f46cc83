#include "service/server/observe/request_log.h"

#include <atomic>
#include <random>
#include <string>

#include "absl/strings/str_format.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

using grpc::experimental::InterceptionHookPoints;

constexpr char kRequestId[] = "x-request-id";
constexpr double kNsPerSecond = 1e9;

// Differs between servers and counts within one: "5f3c9a1e-42".
std::string NewRequestId() {
  static const unsigned server = std::random_device()();
  static std::atomic<uint64_t> last = 0;
  return absl::StrFormat("%08x-%d", server, ++last);
}

class CallLog final : public grpc::experimental::Interceptor {
 public:
  CallLog(const char* method, ServerLog* log, Metrics* metrics, const Clock* clock)
      : method_(method), log_(log), metrics_(metrics), clock_(clock) {
    metrics_->CallOpened();
  }
  ~CallLog() override { metrics_->CallClosed(); }

  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::POST_RECV_INITIAL_METADATA)) {
      TakeId(*methods->GetRecvInitialMetadata());
    }
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) {
      methods->GetSendTrailingMetadata()->emplace(kRequestId, id_);
      Report(methods->GetSendStatus());
    }
    methods->Proceed();
  }

 private:
  void TakeId(const std::multimap<grpc::string_ref, grpc::string_ref>& metadata) {
    const auto sent = metadata.find(kRequestId);
    if (sent == metadata.end()) return;
    auto id = CheckName(kRequestIdRule, kRequestId,
                        std::string_view(sent->second.data(), sent->second.size()));
    if (id.ok()) id_ = *std::move(id);
  }

  void Report(const grpc::Status& status) {
    const double seconds = static_cast<double>(clock_->MonotonicNs() - begin_ns_) / kNsPerSecond;
    const std::string code =
        absl::StatusCodeToString(static_cast<absl::StatusCode>(status.error_code()));
    metrics_->CountCall(method_, code, seconds);
    const auto level = status.ok() ? ServerLog::Level::kInfo : ServerLog::Level::kWarning;
    log_->Write(level, "call",
                {{"request_id", id_},
                 {"method", method_},
                 {"code", code},
                 {"seconds", absl::StrFormat("%.6f", seconds)},
                 {"message", status.error_message()}});
  }

  const std::string method_;
  ServerLog* const log_;
  Metrics* const metrics_;
  const Clock* const clock_;
  const int64_t begin_ns_ = clock_->MonotonicNs();
  std::string id_ = NewRequestId();
};

class CallLogs final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  CallLogs(ServerLog* log, Metrics* metrics, const Clock* clock)
      : log_(log), metrics_(metrics), clock_(clock) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override {
    return new CallLog(info->method(), log_, metrics_, clock_);
  }

 private:
  ServerLog* const log_;
  Metrics* const metrics_;
  const Clock* const clock_;
};

}  // namespace

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> MakeRequestLog(
    ServerLog* log, Metrics* metrics, const Clock* clock) {
  return std::make_unique<CallLogs>(log, metrics, clock);
}

}  // namespace eyebox::service
