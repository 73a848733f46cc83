// When a display has settled on a new stimulus: frames are taken and thrown away until one reads
// like another that was taken a while before.
#ifndef EYEBOX_CAPTURE_RUN_SETTLE_H_
#define EYEBOX_CAPTURE_RUN_SETTLE_H_

#include <cstdint>
#include <deque>
#include <optional>

#include "absl/status/status.h"
#include "capture/base/frame.h"
#include "capture/run/frame_mean.h"

namespace eyebox::capture {

struct SettleOptions {
  double least_s = 0;  // waits this long whatever the frames say
  double longest_s = 20;
  int most_frames = 2000;  // longest_s, should the clock of the camera stand still
  // How far apart the two are that are compared. An afterglow that falls by less than the
  // tolerance in this time passes: make it longer for slow panels.
  double window_s = 0.1;
  double agree_sigmas = 3;
  double agree_relative = 1e-3;  // of the reading; a panel's flicker is no change

  // Errors: InvalidArgument (names the field).
  absl::Status Validate() const;
};

struct Settling {
  double seconds = 0;  // from the first frame of the stimulus to the one that was found settled
  int frames = 0;      // taken meanwhile, not recorded
  bool settled = true;
  double change_relative = 0;  // that was left over the window
};

// Watches one transition. Time is the camera's own clock where it has one, else that of reception:
// neither is the wall clock.
class SettleWatch {
 public:
  explicit SettleWatch(const SettleOptions& options) : options_(options) {}

  // A frame of the new stimulus. True: that was the last one, see Result().
  bool Add(const FrameMetadata& metadata, const FrameMean& mean);
  // One that came incomplete, or of the exposure before. True: as Add().
  bool Skip();

  const Settling& Result() const { return settling_; }

 private:
  struct Seen {
    int64_t time_ns = 0;
    FrameMean mean;
  };
  bool Agrees(const FrameMean& before, const FrameMean& now);
  bool GiveUp();

  const SettleOptions options_;
  std::optional<int64_t> begin_ns_;
  std::deque<Seen> window_;  // the first is the youngest that is a window old
  Settling settling_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_SETTLE_H_
