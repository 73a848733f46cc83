// One camera that any number of viewers look through, while no job needs it.
#ifndef EYEBOX_SERVICE_SERVER_PREVIEW_PREVIEW_HUB_H_
#define EYEBOX_SERVICE_SERVER_PREVIEW_PREVIEW_HUB_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "service/server/preview/preview_look.h"

namespace eyebox::service {

// What is looked at. Viewers of the same view share its pictures.
struct PreviewView {
  capture::RigConfig rig;
  double exposure_s = 0.02;
  double gain_db = 0;
  int most_width_px = 320;
  std::optional<double> drive = {};  // that a simulated headset shows
};
bool IsSame(const PreviewView& a, const PreviewView& b);

struct PreviewViewer {
  std::shared_ptr<PreviewLook> look;
  uint64_t listener = 0;  // to Leave() with
};

// Thread-safe. One thread takes pictures, ten a second at most; it is there only while someone
// looks, and two seconds longer, so that one who asks for single pictures need not wait for the
// camera to be opened for each.
class PreviewHub {
 public:
  PreviewHub() = default;
  ~PreviewHub() { Stop(); }

  // Waits while a camera that nobody looks through any more is closed. What opening the camera
  // gives is told by the look. Errors: FailedPrecondition (a job captures, or another view is
  // looked at: says which), Unavailable (the server stops).
  absl::StatusOr<PreviewViewer> Look(const PreviewView& view, PreviewLook::Listener listener);

  // Ends every preview, waits until the camera is closed and allows no other while it lives.
  class Hold {
   public:
    // `job` in words, for those who are refused.
    Hold(PreviewHub& hub, const std::string& job);
    ~Hold();
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

   private:
    PreviewHub& hub_;
    const std::string job_;
  };

  void Stop();

 private:
  void TakePictures(const PreviewView& view, PreviewLook& look);
  absl::Status ShowPictures(const PreviewView& view, PreviewLook& look);
  // With the lock: why no picture may be taken; OK where one may.
  absl::Status Obstacle() const;
  bool GoesOn(const PreviewLook& look);
  void EndLook(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable changed_;
  PreviewView view_;
  std::shared_ptr<PreviewLook> look_;  // null: no camera is open
  bool ending_ = false;                // the thread is to close the camera
  std::vector<std::string> held_by_;   // jobs
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_PREVIEW_PREVIEW_HUB_H_
