#include "service/server/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "service/server/capture_service.h"
#include "service/server/credentials.h"
#include "service/server/listen.h"
#include "service/server/observe/metrics.h"
#include "service/server/observe/request_log.h"
#include "service/server/recording_service.h"
#include "service/server/run_service.h"

namespace eyebox::service {
namespace {

constexpr int kMaxRequestBytes = 1 << 20;
constexpr int kMaxMetadataBytes = 16 << 10;
constexpr int kMaxStreamsPerConnection = 128;
constexpr int kDiskThreads = 2;
constexpr std::chrono::seconds kDrainTime(5);

bool Captures(const v1::CreateJobRequest& request) {
  return request.has_capture() || (request.has_run() && request.run().has_rig());
}

// While a job captures nobody looks through a camera.
Work WithoutPreviews(Work work, std::shared_ptr<PreviewHub> previews) {
  return [work = std::move(work), previews = std::move(previews)](const Assignment& assignment,
                                                                  const Watcher& watcher) {
    std::optional<PreviewHub::Hold> hold;
    if (Captures(assignment.request)) {
      hold.emplace(*previews, "the job of request \"" + assignment.request.request_id() + "\"");
    }
    return work(assignment, watcher);
  };
}

class GrpcServer final : public Server {
 public:
  GrpcServer(const ServerOptions& options, const Clock* clock, RootFolder recordings,
             std::unique_ptr<Jobs> jobs, std::shared_ptr<PreviewHub> previews)
      : options_(options),
        clock_(clock),
        recordings_(std::move(recordings)),
        jobs_(std::move(jobs)),
        log_(options.log ? options.log : std::make_shared<ServerLog>([](const std::string&) {})),
        previews_(std::move(previews)) {}
  ~GrpcServer() override { Stop(); }

  absl::Status ExposeMetrics() {
    if (options_.metrics.empty()) return absl::OkStatus();
    EYEBOX_ASSIGN_OR_RETURN(metrics_port_, metrics_.Expose(options_.metrics));
    return absl::OkStatus();
  }

  absl::Status Listen(Endpoint endpoint,
                      const std::shared_ptr<grpc::ServerCredentials>& credentials) {
    if (!endpoint.tcp) EYEBOX_RETURN_IF_ERROR(RemoveStaleSocket(endpoint.socket));
    grpc::EnableDefaultHealthCheckService(true);
    // Named here, or the linker would drop the library and with it reflection.
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    grpc::ServerBuilder builder;
    std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> logs;
    logs.push_back(MakeRequestLog(log_.get(), &metrics_, clock_));
    builder.experimental().SetInterceptorCreators(std::move(logs));
    // Two servers on one port would share the calls between them.
    builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
    int port = 0;
    builder.AddListeningPort(endpoint.ForGrpc(), credentials, &port);
    builder.SetMaxReceiveMessageSize(kMaxRequestBytes);
    builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxMetadataBytes);
    builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreamsPerConnection);
    builder.RegisterService(&service_);
    builder.RegisterService(&job_service_);
    builder.RegisterService(&capture_service_);
    builder.RegisterService(&recording_service_);
    {
      const SocketMode mode;
      server_ = builder.BuildAndStart();
    }
    if (!server_) {
      return DeviceFailed(endpoint.ForGrpc(), "cannot listen there",
                          endpoint.tcp ? "check the name and that no one else uses the port"
                                       : "check that its folder exists and may be written to");
    }
    if (endpoint.tcp) endpoint.port = port;
    address_ = endpoint.ForGrpc();
    jobs_->Start();
    catalogue_thread_.Post([this] { PrepareCatalogue(); });
    watch_.emplace(Folders(), options_.health, [this](const auto& trouble) { Tell(trouble); });
    return absl::OkStatus();
  }

  std::string address() const override { return address_; }
  int metrics_port() const override { return metrics_port_; }

  void Stop() override {
    if (!server_) return;
    watch_.reset();
    SetServing(false);
    previews_->Stop();
    jobs_->Stop();
    catalogue_.Stop();
    server_->Shutdown(std::chrono::system_clock::now() + kDrainTime);
    disk_.Stop();
    catalogue_thread_.Stop();
    server_->Wait();
    server_.reset();
  }

 private:
  std::vector<std::filesystem::path> Folders() const { return {options_.data, options_.state}; }

  MomentaryFigures Now() const {
    return {.jobs_queued = jobs_->table().CountOf(v1::JOB_STATE_QUEUED),
            .jobs_running = jobs_->table().CountOf(v1::JOB_STATE_RUNNING),
            .disk_free_bytes = LeastFreeBytes(Folders()),
            .serving = serving_};
  }

  void Tell(const std::string& trouble) {
    const auto level = trouble.empty() ? ServerLog::Level::kInfo : ServerLog::Level::kWarning;
    log_->Write(level, "health",
                {{"status", trouble.empty() ? "SERVING" : "NOT_SERVING"}, {"message", trouble}});
    SetServing(trouble.empty());
  }

  void TellOfCatalogue(const std::string& what) {
    log_->Write(ServerLog::Level::kWarning, "catalogue", {{"message", what}});
  }

  // So that the first client who lists recordings does not wait for all of them to be read.
  void PrepareCatalogue() {
    const absl::Status status = catalogue_.Refresh();
    if (!status.ok() && !absl::IsCancelled(status)) TellOfCatalogue(std::string(status.message()));
  }

  void SetServing(bool serving) {
    serving_ = serving;
    grpc::HealthCheckServiceInterface* health = server_->GetHealthCheckService();
    health->SetServingStatus(serving);
    health->SetServingStatus(v1::RunService::service_full_name(), serving);
  }

  const ServerOptions options_;
  const Clock* const clock_;
  const RootFolder recordings_;
  const std::unique_ptr<Jobs> jobs_;
  const std::shared_ptr<ServerLog> log_;
  std::atomic<bool> serving_ = false;
  Metrics metrics_{[this] { return Now(); }};
  int metrics_port_ = 0;
  Executor disk_{kDiskThreads};
  Catalogue catalogue_{options_.state, &recordings_, clock_,
                       [this](const std::string& what) { TellOfCatalogue(what); }};
  Executor catalogue_thread_{1};
  const std::shared_ptr<PreviewHub> previews_;
  const HandlerContext context_ = {
      *jobs_,    disk_, recordings_, catalogue_, catalogue_thread_, options_.stalled_after,
      *previews_};
  RunServiceImpl service_{context_};
  JobServiceImpl job_service_{context_};
  CaptureServiceImpl capture_service_{context_};
  RecordingServiceImpl recording_service_{context_};
  std::unique_ptr<grpc::Server> server_;
  std::string address_;
  std::optional<HealthWatch> watch_;  // last: it tells the others
};

}  // namespace

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerOptions& options, Work work,
                                                      const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(const Endpoint endpoint, EndpointOf(options.listen));
  EYEBOX_ASSIGN_OR_RETURN(const auto credentials, MakeCredentials(options.access, endpoint.tcp));
  EYEBOX_ASSIGN_OR_RETURN(RootFolder recordings, RootFolder::Open(options.data));
  EYEBOX_ASSIGN_OR_RETURN(std::unique_ptr<JobStore> store, JobStore::Open(options.state));
  auto previews = std::make_shared<PreviewHub>();
  EYEBOX_ASSIGN_OR_RETURN(std::unique_ptr<Jobs> jobs,
                          Jobs::Open(std::move(store), WithoutPreviews(std::move(work), previews),
                                     clock, options.jobs));
  auto server = std::make_unique<GrpcServer>(options, clock, std::move(recordings), std::move(jobs),
                                             std::move(previews));
  EYEBOX_RETURN_IF_ERROR(server->ExposeMetrics());
  EYEBOX_RETURN_IF_ERROR(server->Listen(endpoint, credentials));
  return server;
}

}  // namespace eyebox::service
