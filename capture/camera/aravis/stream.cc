#include "capture/camera/aravis/stream.h"

#include <arv.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "capture/camera/aravis/socket_buffer.h"

namespace eyebox::capture::aravis {
namespace {

struct Slot {
  ArvBuffer* buffer = nullptr;
  std::atomic<int64_t> monotonic_time_ns = 0;
  enum { kFree, kOffered, kLent } state = kFree;
};

BufferStatus StatusOf(ArvBufferStatus status) {
  switch (status) {
    case ARV_BUFFER_STATUS_SUCCESS:
      return BufferStatus::kComplete;
    case ARV_BUFFER_STATUS_MISSING_PACKETS:
    case ARV_BUFFER_STATUS_WRONG_PACKET_ID:
      return BufferStatus::kMissingPackets;
    case ARV_BUFFER_STATUS_TIMEOUT:
      return BufferStatus::kTimedOut;
    case ARV_BUFFER_STATUS_ABORTED:
    case ARV_BUFFER_STATUS_CLEARED:
      return BufferStatus::kAborted;
    default:
      return BufferStatus::kDeviceError;
  }
}

// Aravis queues a buffer first and calls back then: who pops it may be ahead of its stamp.
int64_t AwaitStamp(const Slot& slot, const Clock& clock) {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
  while (slot.monotonic_time_ns == 0 && std::chrono::steady_clock::now() < patience) {
    std::this_thread::yield();
  }
  const int64_t stamp_ns = slot.monotonic_time_ns;
  return stamp_ns != 0 ? stamp_ns : clock.MonotonicNs();
}

}  // namespace

class BufferPool {
 public:
  BufferPool(int count, size_t bytes) {
    for (int i = 0; i < count; ++i) {
      slots_.push_back(std::make_unique<Slot>());
      slots_.back()->buffer = arv_buffer_new_full(bytes, nullptr, slots_.back().get(), nullptr);
    }
  }
  ~BufferPool() {
    for (const auto& slot : slots_) g_object_unref(slot->buffer);
  }
  BufferPool(const BufferPool&) = delete;
  BufferPool& operator=(const BufferPool&) = delete;

  Slot* Offer() {
    const std::lock_guard lock(mutex_);
    const auto free =
        std::ranges::find(slots_, Slot::kFree, [](const auto& s) { return s->state; });
    if (free == slots_.end()) return nullptr;
    (*free)->state = Slot::kOffered;
    return free->get();
  }
  void Lend(Slot& slot) { Mark(slot, Slot::kLent); }
  void Return(Slot& slot) { Mark(slot, Slot::kFree); }
  // The stream that was offered buffers is gone.
  void ReturnOffered() {
    const std::lock_guard lock(mutex_);
    for (const auto& slot : slots_) {
      if (slot->state == Slot::kOffered) slot->state = Slot::kFree;
    }
  }

 private:
  void Mark(Slot& slot, decltype(Slot::state) state) {
    const std::lock_guard lock(mutex_);
    slot.state = state;
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Slot>> slots_;
};

std::shared_ptr<BufferPool> MakeBufferPool(int count, size_t bytes) {
  return std::make_shared<BufferPool>(count, bytes);
}

struct Stream::Impl {
  ~Impl() {
    if (stream != nullptr) g_object_unref(stream);  // ends the receive thread
    pool->ReturnOffered();
  }

  // In the receive thread: stamps, nothing else.
  static void OnEvent(void* self, ArvStreamCallbackType type, ArvBuffer* buffer) {
    if (type != ARV_STREAM_CALLBACK_TYPE_BUFFER_DONE || buffer == nullptr) return;
    auto* slot = static_cast<Slot*>(const_cast<void*>(arv_buffer_get_user_data(buffer)));
    slot->monotonic_time_ns = static_cast<Impl*>(self)->clock->MonotonicNs();
  }

  uint32_t NewlyMissing() {
    if (!gige) return 0;
    const uint64_t total = arv_stream_get_info_uint64_by_name(stream, "n_missing_packets");
    return static_cast<uint32_t>(total - std::exchange(missing_packets, total));
  }

  std::shared_ptr<BufferPool> pool;
  const Clock* clock = nullptr;
  ArvStream* stream = nullptr;
  bool gige = false;
  bool fake = false;
  uint64_t missing_packets = 0;
};

Stream::Stream(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Stream::~Stream() = default;

absl::StatusOr<std::unique_ptr<Stream>> Stream::Open(Device& device, const AravisOptions& options,
                                                     std::shared_ptr<BufferPool> pool,
                                                     const Clock* clock) {
  auto* camera = static_cast<ArvCamera*>(device.native());
  auto impl = std::make_unique<Impl>();
  impl->pool = std::move(pool);
  impl->clock = clock;
  impl->gige = device.is_gige();
  impl->fake = device.is_fake();
  if (impl->gige && !options.packet_socket) {
    arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  }
  GError* error = nullptr;
  impl->stream = arv_camera_create_stream(camera, Impl::OnEvent, impl.get(), &error);
  if (impl->stream == nullptr) {
    const std::string why = error == nullptr ? "" : std::string(": ") + error->message;
    g_clear_error(&error);
    return DeviceFailed(device.uri(), "gives no stream" + why, "connect it again");
  }
  if (impl->gige && !options.packet_socket) {
    EYEBOX_RETURN_IF_ERROR(EnlargeSocketBuffer(device.uri(),
                                               arv_gv_stream_get_port(ARV_GV_STREAM(impl->stream)),
                                               options.socket_buffer_mib << 20));
  }
  return std::unique_ptr<Stream>(new Stream(std::move(impl)));
}

int Stream::OfferOne() {
  Slot* slot = impl_->pool->Offer();
  if (slot == nullptr) return 0;
  slot->monotonic_time_ns = 0;
  arv_stream_push_buffer(impl_->stream, ARV_BUFFER(g_object_ref(slot->buffer)));
  return 1;
}

int Stream::OfferAll() {
  int offered = 0;
  while (OfferOne() == 1) ++offered;
  return offered;
}

int Stream::Waiting() const {
  int waiting = 0;
  arv_stream_get_n_buffers(impl_->stream, &waiting, nullptr);
  return waiting;
}

std::optional<Arrival> Stream::Pop(std::chrono::microseconds timeout) {
  ArvBuffer* buffer = timeout.count() > 0
                          ? arv_stream_timeout_pop_buffer(impl_->stream, timeout.count())
                          : arv_stream_try_pop_buffer(impl_->stream);
  if (buffer == nullptr) return std::nullopt;
  auto* slot = static_cast<Slot*>(const_cast<void*>(arv_buffer_get_user_data(buffer)));
  g_object_unref(buffer);  // the pool has its own reference
  impl_->pool->Lend(*slot);
  Arrival arrival;
  arrival.owner = {slot, [pool = impl_->pool](Slot* lent) { pool->Return(*lent); }};
  arrival.status = StatusOf(arv_buffer_get_status(buffer));
  arrival.device_id = arv_buffer_get_frame_id(buffer);
  arrival.monotonic_time_ns = AwaitStamp(*slot, *impl_->clock);
  arrival.missing_packets = impl_->NewlyMissing();
  if (arrival.status != BufferStatus::kComplete) {
    // Aravis says timeout when it gave up waiting for packets.
    if (arrival.missing_packets > 0) arrival.status = BufferStatus::kMissingPackets;
    return arrival;
  }
  arrival.missing_packets = 0;
  arrival.device_time_ns = static_cast<int64_t>(arv_buffer_get_timestamp(buffer));
  if (arv_buffer_get_n_parts(buffer) != 1) {
    arrival.status = BufferStatus::kDeviceError;
    return arrival;
  }
  int padding_x = 0;
  arv_buffer_get_image_padding(buffer, &padding_x, nullptr);
  arrival.padding_bytes = static_cast<size_t>(std::max(padding_x, 0));
  arrival.pfnc = arv_buffer_get_image_pixel_format(buffer);
  arrival.size = {.width_px = arv_buffer_get_image_width(buffer),
                  .height_px = arv_buffer_get_image_height(buffer)};
  size_t size = 0;
  const auto* data = static_cast<const std::byte*>(arv_buffer_get_image_data(buffer, &size));
  // Who draws into the fake camera's buffers cannot tell Aravis how much was drawn.
  if (impl_->fake) size = arrival.size.PixelCount() * (arrival.pfnc >> 16 & 0xFF) / 8;
  arrival.bytes = {data, size};
  return arrival;
}

}  // namespace eyebox::capture::aravis
