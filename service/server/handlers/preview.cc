#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "capture/base/status.h"
#include "service/server/handlers/handlers.h"
#include "service/server/handlers/reply.h"
#include "service/server/handlers/stall_guard.h"
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

// As WatchCall: one picture is written at a time, and the next one is the newest there is then.
class PreviewCall final : public grpc::ServerWriteReactor<v1::PreviewFrame>,
                          public std::enable_shared_from_this<PreviewCall> {
 public:
  PreviewCall(const HandlerContext& context, grpc::CallbackServerContext* call,
              const v1::PreviewRequest& request)
      : context_(context), request_(request) {
    guard_.emplace(call, context.stalled_after);
  }

  void Start() {
    self_ = shared_from_this();
    context_.disk.Post([self = self_] { self->Begin(); });
  }

  void OnWriteDone(bool ok) override {
    guard_->WriteEnds();
    {
      const std::lock_guard lock(mutex_);
      writing_ = false;
      gone_ = gone_ || !ok;
    }
    Advance();
  }

  void OnCancel() override {
    {
      const std::lock_guard lock(mutex_);
      gone_ = true;
    }
    Advance();
  }

  void OnDone() override {
    guard_.reset();  // a listener may keep this a moment longer than the call lives
    if (viewer_.look) viewer_.look->Leave(viewer_.listener);
    self_.reset();
  }

 private:
  void Begin() {
    auto view = ViewOf(context_.recordings, request_);
    auto viewer = view.ok() ? context_.previews.Look(*view, [self = self_] { self->Advance(); })
                            : absl::StatusOr<PreviewViewer>(view.status());
    if (!viewer.ok()) return Finish(ToRpcStatus(viewer.status()));
    {
      const std::lock_guard lock(mutex_);
      viewer_ = *std::move(viewer);
    }
    Advance();
  }

  // Does the one thing that is due, if any: write the newest picture or finish.
  void Advance() {
    std::optional<grpc::Status> end;
    {
      const std::lock_guard lock(mutex_);
      if (!viewer_.look || writing_ || finished_) return;
      const absl::StatusOr<PreviewPicture> newest = viewer_.look->Newest();
      if (gone_) {
        end = grpc::Status(grpc::StatusCode::CANCELLED, "the client went away");
      } else if (!newest.ok()) {
        end = ToRpcStatus(newest.status());
      } else if (*newest == nullptr || (*newest)->frame() == sent_) {
        return;
      } else {
        picture_ = **newest;
        picture_.set_dropped(sent_ == 0 ? 0 : picture_.frame() - sent_ - 1);
        sent_ = picture_.frame();
      }
      (end ? finished_ : writing_) = true;
    }
    if (end) return Finish(*end);
    guard_->WriteBegins();
    StartWrite(&picture_);
  }

  const HandlerContext& context_;
  const v1::PreviewRequest request_;
  std::optional<StallGuard> guard_;
  std::shared_ptr<PreviewCall> self_;  // until gRPC is done with the call

  std::mutex mutex_;
  PreviewViewer viewer_;
  v1::PreviewFrame picture_;  // being written, or written last
  uint64_t sent_ = 0;
  bool writing_ = false;
  bool gone_ = false;
  bool finished_ = false;
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
