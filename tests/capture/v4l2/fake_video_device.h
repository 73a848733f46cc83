// A video device behind the system-call seam: it runs freely on a ManualClock, which it advances
// while one waits for it, and misbehaves on demand.
#ifndef EYEBOX_TESTS_CAPTURE_V4L2_FAKE_VIDEO_DEVICE_H_
#define EYEBOX_TESTS_CAPTURE_V4L2_FAKE_VIDEO_DEVICE_H_

#include <linux/videodev2.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "capture/base/clock.h"
#include "capture/camera/v4l2/video_syscalls.h"

namespace eyebox::capture {

struct FakeControl {
  std::string name;
  int32_t minimum = 0;
  int32_t maximum = 1;
  int32_t value = 1;
  int32_t default_value = 0;
  bool stuck = false;  // takes every value and keeps its own
};

enum class FakeFault { kNone, kLost, kSpoilt, kCutShort };

class FakeVideoDevice final : public VideoSyscalls {
 public:
  // Offers GREY and Y12 of 6 x 4 pixels at 100 and 10 frames/s, and the controls of a UVC camera,
  // everything automatic on.
  FakeVideoDevice();

  // What it is like; to be set before it is opened.
  bool multiplanar = false;
  std::string driver = "fake";
  std::vector<uint32_t> fourccs = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_Y12};
  uint32_t width = 6;
  uint32_t height = 4;
  uint32_t row_bytes = 12;  // what bytesperline says
  uint32_t field = V4L2_FIELD_NONE;
  uint32_t answers_fourcc = 0;  // to S_FMT instead of what was asked, if not 0
  uint32_t answers_width = 0;
  std::vector<uint32_t> intervals_ms = {10, 100};
  bool tells_interval = true;
  std::map<uint32_t, FakeControl> controls;
  uint32_t timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;

  // What happens while it runs.
  bool unplugged = false;
  bool silent = false;                 // delivers nothing any more
  bool interrupts = false;             // every call is interrupted once before it succeeds
  std::map<unsigned long, int> fails;  // errno value of a request
  std::function<FakeFault(uint32_t)> fault = [](uint32_t) { return FakeFault::kNone; };
  // Draws frame n; padding that it leaves alone is 0xff.
  std::function<void(uint32_t, std::span<uint8_t>)> draw = [](uint32_t, std::span<uint8_t> bytes) {
    std::ranges::fill(bytes, uint8_t{0});
  };
  std::deque<v4l2_event> events;

  ManualClock clock{1000000000};

  int open_count() const { return open_; }
  int mapped_count() const { return mapped_; }
  uint32_t interval_ms() const { return interval_ms_; }
  uint32_t fourcc() const { return fourcc_; }
  int64_t stream_began_ns() const { return stream_began_ns_; }

  int Open(const char* path) override;
  int Close(int fd) override;
  int Ioctl(int fd, unsigned long request, void* argument) override;
  int Mmap(int fd, int64_t offset, size_t length, void** address) override;
  int Munmap(void* address, size_t length) override;
  int Poll(int fd, short wanted, int timeout_ms, short* returned) override;

 private:
  struct Filled {
    uint32_t index;
    uint32_t sequence;
    int64_t start_ns;
    FakeFault fault;
  };

  bool Interrupted();
  int QueryCapability(v4l2_capability& capability) const;
  int EnumerateFormat(v4l2_fmtdesc& entry) const;
  int EnumerateSize(v4l2_frmsizeenum& entry) const;
  int EnumerateInterval(v4l2_frmivalenum& entry) const;
  int SetFormat(v4l2_format& format);
  int Parameters(v4l2_streamparm& parameters, bool set);
  int QueryControl(v4l2_queryctrl& query) const;
  int AccessControl(v4l2_control& control, bool set);
  int RequestBuffers(v4l2_requestbuffers& request);
  int QueryBuffer(v4l2_buffer& buffer) const;
  int Dequeue(v4l2_buffer& buffer);
  int Stream(bool on);
  int Subscribe(const v4l2_event_subscription& subscription);
  int NextEvent(v4l2_event& event);
  int64_t IntervalNs() const { return int64_t{interval_ms_} * 1000000; }
  size_t ImageBytes() const { return size_t{row_bytes} * height; }
  void CatchUp();

  int open_ = 0;
  int mapped_ = 0;
  bool interrupted_ = false;
  bool poll_interrupted_ = false;
  uint32_t fourcc_ = 0;
  uint32_t interval_ms_ = 10;
  std::vector<std::vector<uint8_t>> ring_;
  std::deque<uint32_t> queued_;
  std::deque<Filled> filled_;
  bool streaming_ = false;
  int64_t stream_began_ns_ = 0;
  uint32_t frame_ = 0;  // the next one to end
};

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_CAPTURE_V4L2_FAKE_VIDEO_DEVICE_H_
