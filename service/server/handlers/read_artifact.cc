#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/result_files.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

absl::StatusOr<v1::ArtifactChunk> Read(Jobs& jobs, const v1::ReadArtifactRequest& request) {
  if (request.limit_bytes() > kMaxChunkBytes) {
    return BadField("limit_bytes", "is " + std::to_string(request.limit_bytes()),
                    "give at most " + std::to_string(kMaxChunkBytes) + ", or 0 for that");
  }
  EYEBOX_ASSIGN_OR_RETURN(const ResultFile file,
                          ResultFile::Open(jobs, request.name(), request.artifact()));
  return file.Read(request.offset(),
                   request.limit_bytes() == 0 ? kMaxChunkBytes : request.limit_bytes());
}

}  // namespace

grpc::ServerUnaryReactor* ReadArtifact(const HandlerContext& context,
                                       grpc::CallbackServerContext* call,
                                       const v1::ReadArtifactRequest* request,
                                       v1::ArtifactChunk* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  context.disk.Post([&context, reactor, request, response] {
    Reply(reactor, Read(context.jobs, *request), response);
  });
  return reactor;
}

}  // namespace eyebox::service
