#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "capture/base/status.h"
#include "service/server/handlers/guarded_stream.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/validate_preview.h"
#include "service/server/store/rigs.h"

namespace eyebox::service {
namespace {

absl::StatusOr<PreviewView> ViewOf(const RootFolder& data, const v1::PreviewRequest& request) {
  EYEBOX_RETURN_IF_ERROR(ValidatePreview(request));
  PreviewView view;
  if (request.has_rig()) {
    EYEBOX_ASSIGN_OR_RETURN(view.rig, ReadRig(data, request.rig()));
  } else {
    view.rig = ConfigOf(request.simulated());
  }
  if (request.exposure_s() != 0) view.exposure_s = request.exposure_s();
  view.gain_db = request.gain_db();
  if (request.most_width_px() != 0) view.most_width_px = request.most_width_px();
  if (request.has_drive()) view.drive = request.drive();
  return view;
}

// The next picture is the newest there is once the one before it is written.
class PreviewCall final : public GuardedStream<v1::PreviewFrame> {
 public:
  PreviewCall(const HandlerContext& context, grpc::CallbackServerContext* call,
              const v1::PreviewRequest& request)
      : GuardedStream(call, context.stalled_after), context_(context), request_(request) {}

  void Start() {
    context_.disk.Post([this, self = Hold()] { Begin(self); });
  }

 private:
  void Begin(const std::shared_ptr<GuardedStream>& self) {
    auto view = ViewOf(context_.recordings, request_);
    auto viewer = view.ok() ? context_.previews.Look(*view, [this, self] { Advance(); })
                            : absl::StatusOr<PreviewViewer>(view.status());
    if (!viewer.ok()) return Finish(ToRpcStatus(viewer.status()));
    {
      const std::lock_guard lock(mutex());
      viewer_ = *std::move(viewer);
    }
    Advance();
  }

  bool IsReady() const override { return viewer_.look != nullptr; }

  std::optional<grpc::Status> EndIfDue() override {
    newest_ = viewer_.look->Newest();
    if (newest_.ok()) return std::nullopt;
    return ToRpcStatus(newest_.status());
  }

  bool TakeNext(v1::PreviewFrame& picture) override {
    if (*newest_ == nullptr || (*newest_)->frame() == sent_) return false;
    picture = **newest_;
    picture.set_dropped(sent_ == 0 ? 0 : picture.frame() - sent_ - 1);
    sent_ = picture.frame();
    return true;
  }

  void Leave() override {
    if (viewer_.look) viewer_.look->Leave(viewer_.listener);
  }

  const HandlerContext& context_;
  const v1::PreviewRequest request_;
  PreviewViewer viewer_;
  absl::StatusOr<PreviewPicture> newest_ = nullptr;
  uint64_t sent_ = 0;
};

// Waits for one picture.
class OnePicture : public std::enable_shared_from_this<OnePicture> {
 public:
  OnePicture(grpc::ServerUnaryReactor* reactor, v1::PreviewFrame* response, uint64_t after)
      : reactor_(reactor), response_(response), after_(after) {}

  void Begin(const HandlerContext& context, const v1::PreviewRequest& request) {
    auto view = ViewOf(context.recordings, request);
    auto viewer =
        view.ok() ? context.previews.Look(*view, [self = shared_from_this()] { self->Advance(); })
                  : absl::StatusOr<PreviewViewer>(view.status());
    if (!viewer.ok()) return reactor_->Finish(ToRpcStatus(viewer.status()));
    {
      const std::lock_guard lock(mutex_);
      viewer_ = *std::move(viewer);
    }
    Advance();
  }

 private:
  void Advance() {
    absl::StatusOr<PreviewPicture> newest = nullptr;
    {
      const std::lock_guard lock(mutex_);
      if (!viewer_.look || finished_) return;
      newest = viewer_.look->Newest();
      if (newest.ok() && (*newest == nullptr || (*newest)->frame() == after_)) return;
      finished_ = true;
    }
    viewer_.look->Leave(viewer_.listener);
    if (newest.ok()) *response_ = **newest;
    reactor_->Finish(ToRpcStatus(newest.status()));
  }

  grpc::ServerUnaryReactor* const reactor_;
  v1::PreviewFrame* const response_;
  const uint64_t after_;
  std::mutex mutex_;
  PreviewViewer viewer_;
  bool finished_ = false;
};

}  // namespace

grpc::ServerWriteReactor<v1::PreviewFrame>* Preview(const HandlerContext& context,
                                                    grpc::CallbackServerContext* call,
                                                    const v1::PreviewRequest* request) {
  const auto preview = std::make_shared<PreviewCall>(context, call, *request);
  preview->Start();
  return preview.get();
}

grpc::ServerUnaryReactor* GetPreviewFrame(const HandlerContext& context,
                                          grpc::CallbackServerContext* call,
                                          const v1::PreviewRequest* request,
                                          v1::PreviewFrame* response) {
  grpc::ServerUnaryReactor* reactor = call->DefaultReactor();
  const auto one = std::make_shared<OnePicture>(reactor, response, request->after_frame());
  context.disk.Post([&context, one, request] { one->Begin(context, *request); });
  return reactor;
}

}  // namespace eyebox::service
