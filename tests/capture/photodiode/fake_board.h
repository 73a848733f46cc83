// An Arduino with the Eyebox sketch, at the other end of a pseudo-terminal. It answers requests in
// a thread of its own and sends samples, and anything else, when the test says so.
#ifndef EYEBOX_TESTS_CAPTURE_PHOTODIODE_FAKE_BOARD_H_
#define EYEBOX_TESTS_CAPTURE_PHOTODIODE_FAKE_BOARD_H_

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/clock.h"
#include "capture/photodiode/serial/messages.h"

namespace eyebox::capture::serial {

class FakeBoard {
 public:
  // `micros_at_start` is what its clock shows now.
  explicit FakeBoard(uint32_t micros_at_start = 0,
                     State state = {.bits = 10, .minimum_period_us = 200})
      : state_(state), start_ns_(SystemClock()->MonotonicNs()), micros_at_start_(micros_at_start) {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) std::abort();
    device_ = ptsname(master_);
    // Held open, so that the terminal lives when nobody else has it open; not read from.
    slave_ = open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    thread_ = std::jthread([this](const std::stop_token& stop) { Answer(stop); });
  }
  ~FakeBoard() { Unplug(); }

  std::string uri() const { return "serial:" + device_; }

  uint32_t Micros() const {
    return micros_at_start_ +
           static_cast<uint32_t>((SystemClock()->MonotonicNs() - start_ns_) / 1000);
  }

  // One frame of `count` conversions that ended just now, numbered from `sequence`, counts alike.
  void SendSamples(uint32_t sequence, int count = 4) {
    Samples samples = {.sequence = sequence, .samples = {}};
    const uint32_t now_us = Micros();
    for (int i = 0; i < count; ++i) {
      const auto before_us = static_cast<uint32_t>((count - 1 - i) * 100);
      samples.samples.push_back(
          {.micros = now_us - before_us, .counts = static_cast<uint16_t>(sequence + i)});
    }
    SendRaw(EncodeFrame(EncodeSamples(samples)));
  }

  void SendRaw(const Bytes& bytes) {
    const std::lock_guard lock(write_mutex_);
    for (size_t at = 0; at < bytes.size();) {
      const ssize_t count = write(master_, bytes.data() + at, bytes.size() - at);
      if (count <= 0) return;
      at += static_cast<size_t>(count);
    }
  }

  // As after a reset: not running, and its clock starts over.
  void Restart() {
    const std::lock_guard lock(state_mutex_);
    state_.running = false;
  }

  void Unplug() {
    thread_ = std::jthread();
    if (slave_ >= 0) close(slave_);
    if (master_ >= 0) close(master_);
    slave_ = master_ = -1;
  }

  std::atomic<bool> mute = false;            // does not answer
  std::atomic<bool> deaf_to_period = false;  // keeps its own period

 private:
  void Answer(const std::stop_token& stop) {
    FrameSplitter splitter;
    while (!stop.stop_requested()) {
      pollfd waiting = {.fd = master_, .events = POLLIN, .revents = 0};
      if (poll(&waiting, 1, 10) <= 0) continue;
      uint8_t buffer[256];
      const ssize_t count = read(master_, buffer, sizeof buffer);
      if (count <= 0) continue;
      std::vector<Bytes> payloads;
      splitter.Feed(std::span(buffer, static_cast<size_t>(count)), payloads);
      for (const Bytes& payload : payloads) {
        if (const auto request = DecodeRequest(payload)) Answer(*request);
      }
    }
  }

  void Answer(const Request& request) {
    if (mute) return;
    State answer;
    {
      const std::lock_guard lock(state_mutex_);
      if (request.type == RequestType::kConfigure && !deaf_to_period) {
        state_.period_us = request.period_us;
      }
      if (request.type == RequestType::kStart) state_.running = true;
      if (request.type == RequestType::kStop) state_.running = false;
      state_.token = request.token;
      state_.micros = Micros();
      answer = state_;
    }
    SendRaw(EncodeFrame(EncodeState(answer)));
  }

  std::mutex state_mutex_;
  State state_;
  const int64_t start_ns_;
  const uint32_t micros_at_start_;
  std::mutex write_mutex_;
  int master_ = -1;
  int slave_ = -1;
  std::string device_;
  std::jthread thread_;
};

}  // namespace eyebox::capture::serial

#endif  // EYEBOX_TESTS_CAPTURE_PHOTODIODE_FAKE_BOARD_H_
