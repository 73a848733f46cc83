// One function a call, one file a function; service.proto says what each does and its errors.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_HANDLERS_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_HANDLERS_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "eyebox/v1/results.pb.h"
#include "eyebox/v1/service.pb.h"
#include "service/server/handlers/context.h"

namespace eyebox::service {

grpc::ServerUnaryReactor* CreateRun(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::CreateRunRequest* request, v1::Job* response);
grpc::ServerUnaryReactor* GetJob(const HandlerContext& context, grpc::CallbackServerContext* call,
                                 const v1::GetJobRequest* request, v1::Job* response);
grpc::ServerUnaryReactor* ListJobs(const HandlerContext& context, grpc::CallbackServerContext* call,
                                   const v1::ListJobsRequest* request,
                                   v1::ListJobsResponse* response);
grpc::ServerWriteReactor<v1::JobEvent>* WatchJob(const HandlerContext& context,
                                                 const v1::WatchJobRequest* request);
grpc::ServerUnaryReactor* WaitJob(const HandlerContext& context, const v1::WaitJobRequest* request,
                                  v1::Job* response);
grpc::ServerUnaryReactor* CancelJob(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::CancelJobRequest* request, v1::Job* response);
grpc::ServerUnaryReactor* GetRunResult(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::GetRunResultRequest* request,
                                       v1::RunResult* response);
grpc::ServerWriteReactor<v1::ArtifactChunk>* DownloadArtifact(
    const HandlerContext& context, const v1::DownloadArtifactRequest* request);
grpc::ServerUnaryReactor* ReadArtifact(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::ReadArtifactRequest* request,
                                       v1::ArtifactChunk* response);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_HANDLERS_H_
