// eyebox.v1.RunService: every call goes to its handler.
#ifndef EYEBOX_SERVICE_SERVER_RUN_SERVICE_H_
#define EYEBOX_SERVICE_SERVER_RUN_SERVICE_H_

#include "eyebox/v1/service.grpc.pb.h"
#include "service/server/handlers/context.h"
#include "service/server/handlers/handlers.h"

namespace eyebox::service {

class RunServiceImpl final : public v1::RunService::CallbackService {
 public:
  explicit RunServiceImpl(const HandlerContext& context) : context_(context) {}

  grpc::ServerUnaryReactor* CreateRun(grpc::CallbackServerContext* call,
                                      const v1::CreateRunRequest* request,
                                      v1::Job* response) override {
    return service::CreateRun(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* GetJob(grpc::CallbackServerContext* call,
                                   const v1::GetJobRequest* request, v1::Job* response) override {
    return service::GetJob(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* ListJobs(grpc::CallbackServerContext* call,
                                     const v1::ListJobsRequest* request,
                                     v1::ListJobsResponse* response) override {
    return service::ListJobs(context_, call, request, response);
  }
  grpc::ServerWriteReactor<v1::JobEvent>* WatchJob(grpc::CallbackServerContext* call,
                                                   const v1::WatchJobRequest* request) override {
    return service::WatchJob(context_, call, request);
  }
  grpc::ServerUnaryReactor* WaitJob(grpc::CallbackServerContext* /*call*/,
                                    const v1::WaitJobRequest* request, v1::Job* response) override {
    return service::WaitJob(context_, request, response);
  }
  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* call,
                                      const v1::CancelJobRequest* request,
                                      v1::Job* response) override {
    return service::CancelJob(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* GetRunResult(grpc::CallbackServerContext* call,
                                         const v1::GetRunResultRequest* request,
                                         v1::RunResult* response) override {
    return service::GetRunResult(context_, call, request, response);
  }
  grpc::ServerWriteReactor<v1::ArtifactChunk>* DownloadArtifact(
      grpc::CallbackServerContext* call, const v1::DownloadArtifactRequest* request) override {
    return service::DownloadArtifact(context_, call, request);
  }
  grpc::ServerUnaryReactor* ReadArtifact(grpc::CallbackServerContext* call,
                                         const v1::ReadArtifactRequest* request,
                                         v1::ArtifactChunk* response) override {
    return service::ReadArtifact(context_, call, request, response);
  }

 private:
  const HandlerContext context_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_RUN_SERVICE_H_
