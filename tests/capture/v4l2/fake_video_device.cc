#include "tests/capture/v4l2/fake_video_device.h"

#include <errno.h>
#include <poll.h>

#include <algorithm>
#include <cstring>

namespace eyebox::capture {
namespace {

constexpr int kFd = 7;
constexpr int64_t kPageBytes = 4096;

template <typename T>
T& As(void* argument) {
  return *static_cast<T*>(argument);
}

}  // namespace

FakeVideoDevice::FakeVideoDevice() {
  controls[V4L2_CID_EXPOSURE_AUTO] = {"Auto Exposure", 0, 3, 3, 3};
  controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY] = {"Exposure, Dynamic Framerate"};
  controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {"Exposure Time, Absolute", 1, 5000, 156, 156};
  controls[V4L2_CID_AUTOGAIN] = {"Gain, Automatic"};
  controls[V4L2_CID_GAIN] = {"Gain", 10, 110, 50, 50};
  controls[V4L2_CID_AUTO_WHITE_BALANCE] = {"White Balance, Automatic"};
  controls[V4L2_CID_BACKLIGHT_COMPENSATION] = {"Backlight Compensation", 0, 2, 1, 1};
  controls[V4L2_CID_POWER_LINE_FREQUENCY] = {"Power Line Frequency", 0, 2, 1, 1};
  controls[V4L2_CID_BRIGHTNESS] = {"Brightness", -64, 64, 17, 0};
}

bool FakeVideoDevice::Interrupted() {
  interrupted_ = interrupts && !interrupted_;
  return interrupted_;
}

int FakeVideoDevice::Open(const char*) {
  if (Interrupted()) return -EINTR;
  if (unplugged) return -ENOENT;
  ++open_;
  return kFd;
}

int FakeVideoDevice::Close(int) {
  --open_;
  return 0;
}

int FakeVideoDevice::Ioctl(int fd, unsigned long request, void* argument) {
  if (fd != kFd) return -EBADF;
  if (unplugged) return -ENODEV;
  if (Interrupted()) return -EINTR;
  if (const auto fail = fails.find(request); fail != fails.end()) return -fail->second;
  switch (request) {
    case VIDIOC_QUERYCAP:
      return QueryCapability(As<v4l2_capability>(argument));
    case VIDIOC_ENUM_FMT:
      return EnumerateFormat(As<v4l2_fmtdesc>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return EnumerateSize(As<v4l2_frmsizeenum>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return EnumerateInterval(As<v4l2_frmivalenum>(argument));
    case VIDIOC_G_FMT:
      return 0;
    case VIDIOC_S_FMT:
      return SetFormat(As<v4l2_format>(argument));
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
      return Parameters(As<v4l2_streamparm>(argument), request == VIDIOC_S_PARM);
    case VIDIOC_QUERYCTRL:
      return QueryControl(As<v4l2_queryctrl>(argument));
    case VIDIOC_G_CTRL:
    case VIDIOC_S_CTRL:
      return AccessControl(As<v4l2_control>(argument), request == VIDIOC_S_CTRL);
    case VIDIOC_REQBUFS:
      return RequestBuffers(As<v4l2_requestbuffers>(argument));
    case VIDIOC_QUERYBUF:
      return QueryBuffer(As<v4l2_buffer>(argument));
    case VIDIOC_QBUF:
      queued_.push_back(As<v4l2_buffer>(argument).index);
      return 0;
    case VIDIOC_DQBUF:
      return Dequeue(As<v4l2_buffer>(argument));
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      return Stream(request == VIDIOC_STREAMON);
    case VIDIOC_SUBSCRIBE_EVENT:
      return Subscribe(As<v4l2_event_subscription>(argument));
    case VIDIOC_UNSUBSCRIBE_EVENT:
      events.clear();
      return 0;
    case VIDIOC_DQEVENT:
      return NextEvent(As<v4l2_event>(argument));
    default:
      return -ENOTTY;
  }
}

int FakeVideoDevice::QueryCapability(v4l2_capability& capability) const {
  std::strncpy(reinterpret_cast<char*>(capability.driver), driver.c_str(), 15);
  std::strncpy(reinterpret_cast<char*>(capability.card), "Fake camera", 31);
  capability.device_caps =
      V4L2_CAP_STREAMING | (multiplanar ? V4L2_CAP_VIDEO_CAPTURE_MPLANE : V4L2_CAP_VIDEO_CAPTURE);
  capability.capabilities = capability.device_caps | V4L2_CAP_DEVICE_CAPS;
  return 0;
}

int FakeVideoDevice::EnumerateFormat(v4l2_fmtdesc& entry) const {
  if (entry.index >= fourccs.size()) return -EINVAL;
  entry.pixelformat = fourccs[entry.index];
  return 0;
}

int FakeVideoDevice::EnumerateSize(v4l2_frmsizeenum& entry) const {
  if (entry.index > 1) return -EINVAL;
  entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
  entry.discrete = {.width = entry.index == 0 ? 2 : width, .height = entry.index == 0 ? 2 : height};
  return 0;
}

int FakeVideoDevice::EnumerateInterval(v4l2_frmivalenum& entry) const {
  if (entry.index >= intervals_ms.size()) return -EINVAL;
  entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
  entry.discrete = {.numerator = intervals_ms[entry.index], .denominator = 1000};
  return 0;
}

int FakeVideoDevice::SetFormat(v4l2_format& format) {
  const auto answer = [this](auto& pix) {
    if (answers_fourcc != 0) pix.pixelformat = answers_fourcc;
    if (answers_width != 0) pix.width = answers_width;
    pix.field = field;
    fourcc_ = pix.pixelformat;
  };
  if (multiplanar) {
    answer(format.fmt.pix_mp);
    format.fmt.pix_mp.num_planes = 1;
    format.fmt.pix_mp.plane_fmt[0].bytesperline = row_bytes;
    format.fmt.pix_mp.plane_fmt[0].sizeimage = static_cast<uint32_t>(ImageBytes());
  } else {
    answer(format.fmt.pix);
    format.fmt.pix.bytesperline = row_bytes;
    format.fmt.pix.sizeimage = static_cast<uint32_t>(ImageBytes());
  }
  return 0;
}

int FakeVideoDevice::Parameters(v4l2_streamparm& parameters, bool set) {
  if (!tells_interval) return -ENOTTY;
  v4l2_fract& interval = parameters.parm.capture.timeperframe;
  if (set) {
    const uint32_t asked_ms = interval.numerator * 1000 / interval.denominator;
    const auto fits = std::ranges::lower_bound(intervals_ms, asked_ms);
    interval_ms_ = fits == intervals_ms.end() ? intervals_ms.back() : *fits;
  }
  interval = {.numerator = interval_ms_, .denominator = 1000};
  return 0;
}

int FakeVideoDevice::QueryControl(v4l2_queryctrl& query) const {
  const auto found = controls.find(query.id);
  if (found == controls.end()) return -EINVAL;
  const FakeControl& control = found->second;
  std::strncpy(reinterpret_cast<char*>(query.name), control.name.c_str(), 31);
  query.minimum = control.minimum;
  query.maximum = control.maximum;
  query.step = 1;
  query.default_value = control.default_value;
  query.flags = 0;
  return 0;
}

int FakeVideoDevice::AccessControl(v4l2_control& control, bool set) {
  const auto found = controls.find(control.id);
  if (found == controls.end()) return -EINVAL;
  FakeControl& held = found->second;
  if (!set) {
    control.value = held.value;
    return 0;
  }
  if (control.value < held.minimum || control.value > held.maximum) return -ERANGE;
  if (!held.stuck) held.value = control.value;
  return 0;
}

int FakeVideoDevice::RequestBuffers(v4l2_requestbuffers& request) {
  if (mapped_ != 0) return -EBUSY;  // a buffer that is still mapped cannot be given back
  ring_.assign(request.count, std::vector<uint8_t>(ImageBytes(), 0xff));
  queued_.clear();
  filled_.clear();
  return 0;
}

int FakeVideoDevice::QueryBuffer(v4l2_buffer& buffer) const {
  if (buffer.index >= ring_.size()) return -EINVAL;
  const auto length = static_cast<uint32_t>(ImageBytes());
  const auto offset = static_cast<uint32_t>(buffer.index * kPageBytes);
  if (multiplanar) {
    buffer.m.planes[0].length = length;
    buffer.m.planes[0].m.mem_offset = offset;
  } else {
    buffer.length = length;
    buffer.m.offset = offset;
  }
  return 0;
}

int FakeVideoDevice::Mmap(int, int64_t offset, size_t, void** address) {
  ++mapped_;
  *address = ring_.at(static_cast<size_t>(offset / kPageBytes)).data();
  return 0;
}

int FakeVideoDevice::Munmap(void*, size_t) {
  --mapped_;
  return 0;
}

int FakeVideoDevice::Stream(bool on) {
  streaming_ = on;
  stream_began_ns_ = clock.MonotonicNs();
  frame_ = 0;
  if (!on) {
    queued_.clear();
    filled_.clear();
  }
  return 0;
}

// Ends every frame that ends up to now. One for which no buffer is queued is lost.
void FakeVideoDevice::CatchUp() {
  if (!streaming_ || silent) return;
  for (;; ++frame_) {
    const int64_t start_ns = stream_began_ns_ + frame_ * IntervalNs();
    if (start_ns + IntervalNs() > clock.MonotonicNs()) return;
    const FakeFault fate = fault(frame_);
    if (queued_.empty() || fate == FakeFault::kLost) continue;
    const uint32_t index = queued_.front();
    queued_.pop_front();
    draw(frame_, ring_[index]);
    filled_.push_back({index, frame_, start_ns, fate});
  }
}

int FakeVideoDevice::Dequeue(v4l2_buffer& buffer) {
  CatchUp();
  if (filled_.empty()) return -EAGAIN;
  const Filled filled = filled_.front();
  filled_.pop_front();
  const bool at_start = (timestamp_flags & V4L2_BUF_FLAG_TSTAMP_SRC_SOE) != 0;
  const int64_t stamp_ns = filled.start_ns + (at_start ? 0 : IntervalNs());
  buffer.index = filled.index;
  buffer.sequence = filled.sequence;
  buffer.flags = timestamp_flags;
  if (filled.fault == FakeFault::kSpoilt) buffer.flags |= V4L2_BUF_FLAG_ERROR;
  buffer.timestamp = {.tv_sec = stamp_ns / 1000000000, .tv_usec = stamp_ns / 1000 % 1000000};
  const auto used = static_cast<uint32_t>(ImageBytes());
  uint32_t& bytesused = multiplanar ? buffer.m.planes[0].bytesused : buffer.bytesused;
  bytesused = filled.fault == FakeFault::kCutShort ? used / 2 : used;
  return 0;
}

int FakeVideoDevice::Subscribe(const v4l2_event_subscription& subscription) {
  if ((subscription.flags & V4L2_EVENT_SUB_FL_SEND_INITIAL) == 0) return 0;
  v4l2_event event = {};
  event.type = V4L2_EVENT_CTRL;
  event.id = subscription.id;
  event.u.ctrl.changes = V4L2_EVENT_CTRL_CH_VALUE;
  event.u.ctrl.value = controls.at(subscription.id).value;
  events.push_back(event);
  return 0;
}

int FakeVideoDevice::NextEvent(v4l2_event& event) {
  if (events.empty()) return -ENOENT;
  event = events.front();
  events.pop_front();
  return 0;
}

int FakeVideoDevice::Poll(int, short, int timeout_ms, short* returned) {
  poll_interrupted_ = interrupts && !poll_interrupted_;
  if (poll_interrupted_) return -EINTR;
  *returned = 0;
  if (unplugged) {
    *returned = POLLERR | POLLHUP;
    return 1;
  }
  CatchUp();
  const int64_t limit_ns = clock.MonotonicNs() + int64_t{timeout_ms} * 1000000;
  while (filled_.empty() && clock.MonotonicNs() < limit_ns) {
    clock.AdvanceNs(std::min<int64_t>(1000000, limit_ns - clock.MonotonicNs()));
    CatchUp();
  }
  if (filled_.empty()) return 0;
  *returned = POLLIN;
  return 1;
}

}  // namespace eyebox::capture
