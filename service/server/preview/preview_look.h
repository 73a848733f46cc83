// The pictures of one opening of a camera.
#ifndef EYEBOX_SERVICE_SERVER_PREVIEW_PREVIEW_LOOK_H_
#define EYEBOX_SERVICE_SERVER_PREVIEW_PREVIEW_LOOK_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/frame.h"
#include "eyebox/v1/capture_service.pb.h"

namespace eyebox::service {

using PreviewPicture = std::shared_ptr<const v1::PreviewFrame>;

// The picture of a frame: means of the smallest square blocks that are no wider than
// `most_width_px` together, without what is left over at the right and below. `bits` are the
// camera's; number and dropped stay 0.
v1::PreviewFrame PictureOf(const Frame& frame, int bits, int most_width_px);

// One slot, in which a new picture takes the place of the old one. Thread-safe.
class PreviewLook {
 public:
  // Called when there is something new, and when it is over; from any thread, none of them waiting.
  using Listener = std::function<void()>;
  uint64_t Listen(Listener listener);
  void Leave(uint64_t listener);

  // nullptr before the first. Errors: why there will be no more.
  absl::StatusOr<PreviewPicture> Newest() const;

  void Publish(v1::PreviewFrame picture);  // numbers it
  void End(const absl::Status& why);
  // How long nobody has looked; 0 while someone does.
  std::chrono::steady_clock::duration Unwatched() const;

 private:
  void Tell();

  mutable std::mutex mutex_;
  std::map<uint64_t, Listener> listeners_;
  uint64_t next_listener_ = 1;
  uint64_t pictures_ = 0;
  PreviewPicture newest_;
  std::optional<absl::Status> over_;
  std::chrono::steady_clock::time_point left_ = std::chrono::steady_clock::now();
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_PREVIEW_PREVIEW_LOOK_H_
