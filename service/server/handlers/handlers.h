// One function a call, most in a file of their own; the protos of the services say what each does
// and its errors.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_HANDLERS_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_HANDLERS_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "eyebox/v1/capture_service.pb.h"
#include "eyebox/v1/job_service.pb.h"
#include "eyebox/v1/recording_service.pb.h"
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
                                                 grpc::CallbackServerContext* call,
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
    const HandlerContext& context, grpc::CallbackServerContext* call,
    const v1::DownloadArtifactRequest* request);
grpc::ServerUnaryReactor* ReadArtifact(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::ReadArtifactRequest* request,
                                       v1::ArtifactChunk* response);

grpc::ServerUnaryReactor* CreateJob(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::CreateJobRequest* request, v1::Job* response);

grpc::ServerUnaryReactor* MakePlan(const HandlerContext& context, grpc::CallbackServerContext* call,
                                   const v1::MakePlanRequest* request, v1::CapturePlan* response);
grpc::ServerUnaryReactor* Capture(const HandlerContext& context, grpc::CallbackServerContext* call,
                                  const v1::CaptureRequest* request, v1::CaptureReply* response);
grpc::ServerUnaryReactor* FinishCapture(const HandlerContext& context,
                                        grpc::CallbackServerContext* call,
                                        const v1::FinishCaptureRequest* request, v1::Job* response);
grpc::ServerUnaryReactor* NextStimulus(const HandlerContext& context,
                                       const v1::NextStimulusRequest* request,
                                       v1::StimulusStep* response);
grpc::ServerUnaryReactor* AckShown(const HandlerContext& context, grpc::CallbackServerContext* call,
                                   const v1::AckShownRequest* request, v1::AckShownReply* response);
grpc::ServerBidiReactor<v1::RunPlanRequest, v1::StimulusStep>* RunPlan(
    const HandlerContext& context);

grpc::ServerWriteReactor<v1::PreviewFrame>* Preview(const HandlerContext& context,
                                                    grpc::CallbackServerContext* call,
                                                    const v1::PreviewRequest* request);
grpc::ServerUnaryReactor* GetPreviewFrame(const HandlerContext& context,
                                          grpc::CallbackServerContext* call,
                                          const v1::PreviewRequest* request,
                                          v1::PreviewFrame* response);

grpc::ServerUnaryReactor* ListRigs(const HandlerContext& context, grpc::CallbackServerContext* call,
                                   const v1::ListRigsRequest* request,
                                   v1::ListRigsResponse* response);
grpc::ServerUnaryReactor* GetRig(const HandlerContext& context, grpc::CallbackServerContext* call,
                                 const v1::GetRigRequest* request, v1::RigEntry* response);
grpc::ServerUnaryReactor* ListRecordings(const HandlerContext& context,
                                         grpc::CallbackServerContext* call,
                                         const v1::ListRecordingsRequest* request,
                                         v1::ListRecordingsResponse* response);
grpc::ServerUnaryReactor* GetRecording(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::GetRecordingRequest* request,
                                       v1::RecordingEntry* response);
grpc::ServerUnaryReactor* ListCaptures(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::ListCapturesRequest* request,
                                       v1::ListCapturesResponse* response);
grpc::ServerUnaryReactor* ReadArray(const HandlerContext& context,
                                    grpc::CallbackServerContext* call,
                                    const v1::ReadArrayRequest* request, v1::ArrayChunk* response);
grpc::ServerWriteReactor<v1::ArrayChunk>* StreamArray(const HandlerContext& context,
                                                      grpc::CallbackServerContext* call,
                                                      const v1::ReadArrayRequest* request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_HANDLERS_H_
