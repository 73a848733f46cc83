// eyebox.v1.CaptureService and JobService: every call goes to its handler.
#ifndef EYEBOX_SERVICE_SERVER_CAPTURE_SERVICE_H_
#define EYEBOX_SERVICE_SERVER_CAPTURE_SERVICE_H_

#include "eyebox/v1/capture_service.grpc.pb.h"
#include "eyebox/v1/job_service.grpc.pb.h"
#include "service/server/handlers/context.h"
#include "service/server/handlers/handlers.h"

namespace eyebox::service {

class JobServiceImpl final : public v1::JobService::CallbackService {
 public:
  explicit JobServiceImpl(const HandlerContext& context) : context_(context) {}

  grpc::ServerUnaryReactor* CreateJob(grpc::CallbackServerContext* call,
                                      const v1::CreateJobRequest* request,
                                      v1::Job* response) override {
    return service::CreateJob(context_, call, request, response);
  }

 private:
  const HandlerContext context_;
};

class CaptureServiceImpl final : public v1::CaptureService::CallbackService {
 public:
  explicit CaptureServiceImpl(const HandlerContext& context) : context_(context) {}

  grpc::ServerUnaryReactor* MakePlan(grpc::CallbackServerContext* call,
                                     const v1::MakePlanRequest* request,
                                     v1::CapturePlan* response) override {
    return service::MakePlan(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* Capture(grpc::CallbackServerContext* call,
                                    const v1::CaptureRequest* request,
                                    v1::CaptureReply* response) override {
    return service::Capture(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* FinishCapture(grpc::CallbackServerContext* call,
                                          const v1::FinishCaptureRequest* request,
                                          v1::Job* response) override {
    return service::FinishCapture(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* NextStimulus(grpc::CallbackServerContext* /*call*/,
                                         const v1::NextStimulusRequest* request,
                                         v1::StimulusStep* response) override {
    return service::NextStimulus(context_, request, response);
  }
  grpc::ServerUnaryReactor* AckShown(grpc::CallbackServerContext* call,
                                     const v1::AckShownRequest* request,
                                     v1::AckShownReply* response) override {
    return service::AckShown(context_, call, request, response);
  }
  grpc::ServerBidiReactor<v1::RunPlanRequest, v1::StimulusStep>* RunPlan(
      grpc::CallbackServerContext* /*call*/) override {
    return service::RunPlan(context_);
  }
  grpc::ServerWriteReactor<v1::PreviewFrame>* Preview(grpc::CallbackServerContext* call,
                                                      const v1::PreviewRequest* request) override {
    return service::Preview(context_, call, request);
  }
  grpc::ServerUnaryReactor* GetPreviewFrame(grpc::CallbackServerContext* call,
                                            const v1::PreviewRequest* request,
                                            v1::PreviewFrame* response) override {
    return service::GetPreviewFrame(context_, call, request, response);
  }

 private:
  const HandlerContext context_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CAPTURE_SERVICE_H_
