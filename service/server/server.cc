#include "service/server/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>

#include <chrono>
#include <utility>

#include "capture/base/status.h"
#include "service/server/listen.h"
#include "service/server/run_service.h"

namespace eyebox::service {
namespace {

constexpr int kMaxRequestBytes = 1 << 20;
constexpr int kMaxMetadataBytes = 16 << 10;
constexpr int kMaxStreamsPerConnection = 128;
constexpr int kDiskThreads = 2;
constexpr std::chrono::seconds kDrainTime(5);

class GrpcServer final : public Server {
 public:
  GrpcServer(RootFolder recordings, std::unique_ptr<Jobs> jobs)
      : recordings_(std::move(recordings)), jobs_(std::move(jobs)) {}
  ~GrpcServer() override { Stop(); }

  absl::Status Listen(const std::filesystem::path& socket) {
    EYEBOX_RETURN_IF_ERROR(RemoveStaleSocket(socket));
    grpc::EnableDefaultHealthCheckService(true);
    // Named here, or the linker would drop the library and with it reflection.
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    grpc::ServerBuilder builder;
    builder.AddListeningPort("unix:" + socket.string(), grpc::InsecureServerCredentials());
    builder.SetMaxReceiveMessageSize(kMaxRequestBytes);
    builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxMetadataBytes);
    builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreamsPerConnection);
    builder.RegisterService(&service_);
    {
      const SocketMode mode;
      server_ = builder.BuildAndStart();
    }
    if (!server_) {
      return DeviceFailed(socket.string(), "cannot listen there",
                          "check that its folder exists and may be written to");
    }
    jobs_->Start();
    SetServing(true);
    return absl::OkStatus();
  }

  void Stop() override {
    if (!server_) return;
    SetServing(false);
    jobs_->Stop();
    server_->Shutdown(std::chrono::system_clock::now() + kDrainTime);
    disk_.Stop();
    server_->Wait();
    server_.reset();
  }

 private:
  void SetServing(bool serving) {
    grpc::HealthCheckServiceInterface* health = server_->GetHealthCheckService();
    health->SetServingStatus(serving);
    health->SetServingStatus(v1::RunService::service_full_name(), serving);
  }

  const RootFolder recordings_;
  const std::unique_ptr<Jobs> jobs_;
  Executor disk_{kDiskThreads};
  RunServiceImpl service_{{*jobs_, disk_, recordings_}};
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerOptions& options, Work work,
                                                      const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(const std::filesystem::path socket, SocketOf(options.listen));
  EYEBOX_ASSIGN_OR_RETURN(RootFolder recordings, RootFolder::Open(options.data));
  EYEBOX_ASSIGN_OR_RETURN(std::unique_ptr<JobStore> store, JobStore::Open(options.state));
  EYEBOX_ASSIGN_OR_RETURN(std::unique_ptr<Jobs> jobs,
                          Jobs::Open(std::move(store), std::move(work), clock, options.jobs));
  auto server = std::make_unique<GrpcServer>(std::move(recordings), std::move(jobs));
  EYEBOX_RETURN_IF_ERROR(server->Listen(socket));
  return server;
}

}  // namespace eyebox::service
