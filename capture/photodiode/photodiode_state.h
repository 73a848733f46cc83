// The rules that every photodiode follows, whatever makes its counts.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_PHOTODIODE_STATE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_PHOTODIODE_STATE_H_

#include <string>
#include <utility>

#include "absl/status/status.h"
#include "capture/photodiode/photodiode.h"

namespace eyebox::capture {

// Which call is allowed when. The errors are those of Photodiode.
class PhotodiodeState {
 public:
  explicit PhotodiodeState(std::string uri) : uri_(std::move(uri)) {}

  // Whether these settings may be set now; Configured() notes those that were read back.
  absl::Status CheckConfigure(const PhotodiodeInfo& info, const PhotodiodeSettings& settings) const;
  void Configured(const PhotodiodeSettings& read_back);
  absl::Status Start(int64_t now_ns);
  absl::Status CheckRead() const;
  void Stop() { running_ = false; }

  // Read() noted: something came, or nothing did. A timed converter that is silent for a second
  // and ten sample periods is lost (Unavailable); before that, and when pulses start the
  // conversions, waiting was merely in vain (DeadlineExceeded).
  void Heard(int64_t now_ns) { heard_ns_ = now_ns; }
  absl::Status Silence(int64_t now_ns) const;

  bool running() const { return running_; }
  const PhotodiodeSettings& settings() const { return settings_; }

 private:
  std::string uri_;
  PhotodiodeSettings settings_;
  bool configured_ = false;
  bool running_ = false;
  int64_t heard_ns_ = 0;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_PHOTODIODE_STATE_H_
