#include "capture/photodiode/serial/link.h"

#include <array>
#include <utility>
#include <vector>

namespace eyebox::capture::serial {
namespace {

constexpr size_t kMaxWaiting = 65536;
constexpr auto kPollInterval = std::chrono::milliseconds(20);  // how fast the thread can be stopped

}  // namespace

Link::Link(std::unique_ptr<Port> port, const Clock* clock)
    : port_(std::move(port)),
      clock_(clock),
      thread_([this](const std::stop_token& stop) { ReadUntilStopped(stop); }) {}

Link::~Link() = default;

absl::Status Link::Send(const Request& request) {
  return port_->Write(EncodeFrame(EncodeRequest(request)));
}

absl::StatusOr<std::optional<Arrival>> Link::Next(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [this] { return !arrivals_.empty() || !lost_.ok(); });
  if (arrivals_.empty()) {
    if (!lost_.ok()) return lost_;
    return std::optional<Arrival>();
  }
  std::optional<Arrival> next = std::move(arrivals_.front());
  arrivals_.pop_front();
  return next;
}

uint64_t Link::damaged_frames() const {
  const std::lock_guard lock(mutex_);
  return damaged_;
}

void Link::ReadUntilStopped(const std::stop_token& stop) {
  FrameSplitter splitter;
  std::array<uint8_t, 4096> buffer;
  while (!stop.stop_requested()) {
    const absl::StatusOr<size_t> count = port_->Read(buffer, kPollInterval);
    const int64_t arrival_ns = clock_->MonotonicNs();
    if (!count.ok()) {
      const std::lock_guard lock(mutex_);
      lost_ = count.status();
      changed_.notify_all();
      return;
    }
    std::vector<Bytes> payloads;
    splitter.Feed(std::span(buffer).first(*count), payloads);
    Deliver(payloads, arrival_ns, splitter.damaged());
  }
}

void Link::Deliver(const std::vector<Bytes>& payloads, int64_t arrival_ns, uint64_t damaged) {
  const std::lock_guard lock(mutex_);
  damaged_ = damaged;
  for (const Bytes& payload : payloads) {
    std::optional<Message> message = DecodeMessage(payload);
    if (!message) {
      ++damaged_;
      continue;
    }
    if (arrivals_.size() == kMaxWaiting) arrivals_.pop_front();
    arrivals_.push_back({*std::move(message), arrival_ns});
  }
  if (!payloads.empty()) changed_.notify_all();
}

}  // namespace eyebox::capture::serial
