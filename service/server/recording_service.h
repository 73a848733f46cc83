// eyebox.v1.RecordingService: every call goes to its handler.
#ifndef EYEBOX_SERVICE_SERVER_RECORDING_SERVICE_H_
#define EYEBOX_SERVICE_SERVER_RECORDING_SERVICE_H_

#include "eyebox/v1/recording_service.grpc.pb.h"
#include "service/server/handlers/context.h"
#include "service/server/handlers/handlers.h"

namespace eyebox::service {

class RecordingServiceImpl final : public v1::RecordingService::CallbackService {
 public:
  explicit RecordingServiceImpl(const HandlerContext& context) : context_(context) {}

  grpc::ServerUnaryReactor* ListRigs(grpc::CallbackServerContext* call,
                                     const v1::ListRigsRequest* request,
                                     v1::ListRigsResponse* response) override {
    return service::ListRigs(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* GetRig(grpc::CallbackServerContext* call,
                                   const v1::GetRigRequest* request,
                                   v1::RigEntry* response) override {
    return service::GetRig(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* ListRecordings(grpc::CallbackServerContext* call,
                                           const v1::ListRecordingsRequest* request,
                                           v1::ListRecordingsResponse* response) override {
    return service::ListRecordings(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* GetRecording(grpc::CallbackServerContext* call,
                                         const v1::GetRecordingRequest* request,
                                         v1::RecordingEntry* response) override {
    return service::GetRecording(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* ListCaptures(grpc::CallbackServerContext* call,
                                         const v1::ListCapturesRequest* request,
                                         v1::ListCapturesResponse* response) override {
    return service::ListCaptures(context_, call, request, response);
  }
  grpc::ServerUnaryReactor* ReadArray(grpc::CallbackServerContext* call,
                                      const v1::ReadArrayRequest* request,
                                      v1::ArrayChunk* response) override {
    return service::ReadArray(context_, call, request, response);
  }
  grpc::ServerWriteReactor<v1::ArrayChunk>* StreamArray(
      grpc::CallbackServerContext* call, const v1::ReadArrayRequest* request) override {
    return service::StreamArray(context_, call, request);
  }

 private:
  const HandlerContext context_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_RECORDING_SERVICE_H_
