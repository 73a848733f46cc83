#include <optional>

#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/result_files.h"
#include "service/server/handlers/stall_guard.h"
#include "service/server/rpc_status.h"

namespace eyebox::service {
namespace {

// Reads a chunk, writes it, and reads the next only when gRPC has taken it: a client that does not
// read costs one chunk of memory and no thread. One step at a time, so it needs no lock.
class DownloadCall final : public grpc::ServerWriteReactor<v1::ArtifactChunk> {
 public:
  DownloadCall(const HandlerContext& context, grpc::CallbackServerContext* call,
               const v1::DownloadArtifactRequest* request)
      : context_(context), request_(*request), guard_(call, context.stalled_after) {
    context_.disk.Post([this] { WriteNext(); });
  }

  void OnWriteDone(bool ok) override {
    guard_.WriteEnds();
    if (!ok) {
      Finish(grpc::Status(grpc::StatusCode::CANCELLED, "the client went away"));
      return;
    }
    context_.disk.Post([this] { WriteNext(); });
  }

  void OnDone() override { delete this; }

 private:
  void WriteNext() {
    const absl::Status read = ReadNext();
    if (!read.ok()) return Finish(ToRpcStatus(read));
    guard_.WriteBegins();
    if (next_ < chunk_.total_bytes()) {
      StartWrite(&chunk_);
    } else {
      StartWriteAndFinish(&chunk_, {}, grpc::Status::OK);
    }
  }

  absl::Status ReadNext() {
    if (!file_) {
      EYEBOX_ASSIGN_OR_RETURN(
          file_, ResultFile::Open(context_.jobs, request_.name(), request_.artifact()));
    }
    EYEBOX_ASSIGN_OR_RETURN(chunk_, file_->Read(next_, kStreamChunkBytes));
    next_ += chunk_.data().size();
    return absl::OkStatus();
  }

  const HandlerContext& context_;
  const v1::DownloadArtifactRequest request_;
  std::optional<ResultFile> file_;
  v1::ArtifactChunk chunk_;  // being written
  uint64_t next_ = 0;
  StallGuard guard_;
};

}  // namespace

grpc::ServerWriteReactor<v1::ArtifactChunk>* DownloadArtifact(
    const HandlerContext& context, grpc::CallbackServerContext* call,
    const v1::DownloadArtifactRequest* request) {
  return new DownloadCall(context, call, request);
}

}  // namespace eyebox::service
