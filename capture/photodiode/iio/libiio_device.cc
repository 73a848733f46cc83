// The only file that knows libiio (0.24; 1.x has another API).
#include <iio.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "capture/base/status.h"
#include "capture/photodiode/iio/hrtimer_trigger.h"
#include "capture/photodiode/iio/iio_device.h"

namespace eyebox::capture::iio {
namespace {

struct ContextCloser {
  void operator()(iio_context* context) const { iio_context_destroy(context); }
};
struct BufferCloser {
  void operator()(iio_buffer* buffer) const { iio_buffer_destroy(buffer); }
};
using Context = std::unique_ptr<iio_context, ContextCloser>;
using Buffer = std::unique_ptr<iio_buffer, BufferCloser>;

absl::Status Failed(const std::string& where, int error_number) {
  return DeviceFailed(where, std::strerror(error_number),
                      "check that the converter is there and that you may use /dev/iio:*");
}

std::string Called(const char* text) { return text == nullptr ? "" : text; }

absl::StatusOr<Context> OpenContext() {
  Context context(iio_create_local_context());
  if (context == nullptr) return Failed("IIO", errno);
  return context;
}

absl::StatusOr<iio_device*> FindDevice(const Context& context, const std::string& name) {
  iio_device* const device = iio_context_find_device(context.get(), name.c_str());
  if (device != nullptr) return device;
  std::string known;
  for (unsigned i = 0; i < iio_context_get_devices_count(context.get()); ++i) {
    const iio_device* const other = iio_context_get_device(context.get(), i);
    if (iio_device_is_trigger(other)) continue;
    known += " " + Called(iio_device_get_id(other)) + " " + Called(iio_device_get_name(other));
  }
  return Missing("IIO device '" + name + "'", "is not there",
                 known.empty() ? "no converter is connected" : "there are:" + known);
}

absl::StatusOr<iio_channel*> FindChannel(iio_device* device, const std::string& name) {
  iio_channel* const channel = iio_device_find_channel(device, name.c_str(), false);
  if (channel != nullptr && iio_channel_is_scan_element(channel)) return channel;
  std::string known;
  for (unsigned i = 0; i < iio_device_get_channels_count(device); ++i) {
    const iio_channel* const other = iio_device_get_channel(device, i);
    if (iio_channel_is_scan_element(other)) known += " " + Called(iio_channel_get_id(other));
  }
  return Missing("IIO channel '" + name + "'",
                 channel == nullptr ? "is not there" : "cannot be read through a buffer",
                 "take one of:" + known);
}

// Attaches the named trigger; without a name leaves the one that is attached.
absl::StatusOr<const iio_device*> AttachTrigger(const Context& context, iio_device* device,
                                                const std::string& name) {
  const iio_device* trigger = nullptr;
  if (name.empty()) {
    if (iio_device_get_trigger(device, &trigger) == 0 && trigger != nullptr) return trigger;
    return Missing("IIO trigger", "none is attached", "name one: iio:DEVICE/CHANNEL?trigger=NAME");
  }
  trigger = iio_context_find_device(context.get(), name.c_str());
  if (trigger == nullptr || !iio_device_is_trigger(trigger)) {
    return Missing("IIO trigger '" + name + "'", "is not there",
                   "list them with iio_info, or leave ?trigger= away");
  }
  const int error = iio_device_set_trigger(device, trigger);
  if (error < 0) return Failed("IIO trigger '" + name + "'", -error);
  return trigger;
}

class LibiioDevice final : public IioDevice {
 public:
  LibiioDevice(Context context, iio_device* device, iio_channel* channel, iio_channel* timestamp,
               const iio_device* trigger)
      : context_(std::move(context)),
        device_(device),
        channel_(channel),
        timestamp_(timestamp),
        trigger_(trigger) {}

  std::string Name() const override {
    const std::string name = Called(iio_device_get_name(device_));
    return name.empty() ? Called(iio_device_get_id(device_)) : name;
  }

  ChannelFormat Format() const override {
    const iio_data_format* const format = iio_channel_get_data_format(channel_);
    return {.bits = static_cast<int>(format->bits), .is_signed = format->is_signed};
  }

  // Drivers name the trigger of a device after it: ads1015-dev0.
  bool TimesItself() const override {
    return Called(iio_device_get_name(trigger_))
        .starts_with(Called(iio_device_get_name(device_)) + "-dev");
  }

  absl::Status WriteAttribute(const std::string& name, const std::string& value) override {
    return Write(device_, name, value);
  }
  absl::StatusOr<std::string> ReadAttribute(const std::string& name) override {
    return ReadOf(device_, name);
  }
  absl::Status WriteTriggerAttribute(const std::string& name, const std::string& value) override {
    return Write(trigger_, name, value);
  }
  absl::StatusOr<std::string> ReadTriggerAttribute(const std::string& name) override {
    return ReadOf(trigger_, name);
  }

  absl::Status OpenBuffer(size_t samples, size_t kernel_samples) override {
    // In libiio 0.24 the kernel's buffer holds this many times what is read at once.
    const size_t blocks = std::max<size_t>(kernel_samples / samples, 2);
    const int set = iio_device_set_kernel_buffers_count(device_, static_cast<unsigned>(blocks));
    if (set < 0) return Failed(Name(), -set);
    buffer_.reset(iio_device_create_buffer(device_, samples, false));
    if (buffer_ == nullptr) return Failed(Name() + ", buffer", errno);
    const int error = iio_buffer_set_blocking_mode(buffer_.get(), false);
    return error < 0 ? Failed(Name(), -error) : absl::OkStatus();
  }

  absl::StatusOr<std::vector<RawSample>> Refill(std::chrono::milliseconds timeout) override {
    pollfd waiting = {.fd = iio_buffer_get_poll_fd(buffer_.get()), .events = POLLIN, .revents = 0};
    const int ready = poll(&waiting, 1, static_cast<int>(timeout.count()));
    if (ready < 0 && errno != EINTR) return Failed(Name(), errno);
    if (ready <= 0) return std::vector<RawSample>();
    const ssize_t bytes = iio_buffer_refill(buffer_.get());
    if (bytes == -EAGAIN) return std::vector<RawSample>();
    if (bytes < 0) return Failed(Name(), static_cast<int>(-bytes));
    return Samples();
  }

  void CloseBuffer() override { buffer_.reset(); }

 private:
  // libiio would try to create a file of that name and report what sysfs says to that.
  static absl::Status CheckHas(const iio_device* device, const std::string& name) {
    if (iio_device_find_attr(device, name.c_str()) != nullptr) return absl::OkStatus();
    return Missing(Called(iio_device_get_id(device)) + "/" + name, "is not there",
                   "use another converter or trigger");
  }

  static absl::Status Write(const iio_device* device, const std::string& name,
                            const std::string& value) {
    EYEBOX_RETURN_IF_ERROR(CheckHas(device, name));
    const ssize_t written = iio_device_attr_write(device, name.c_str(), value.c_str());
    if (written >= 0) return absl::OkStatus();
    return Failed(Called(iio_device_get_id(device)) + "/" + name, static_cast<int>(-written));
  }

  static absl::StatusOr<std::string> ReadOf(const iio_device* device, const std::string& name) {
    EYEBOX_RETURN_IF_ERROR(CheckHas(device, name));
    std::array<char, 4096> text{};
    const ssize_t read = iio_device_attr_read(device, name.c_str(), text.data(), text.size() - 1);
    if (read >= 0) return std::string(text.data());
    return Failed(Called(iio_device_get_id(device)) + "/" + name, static_cast<int>(-read));
  }

  // The value is converted to the host's order, shifted and extended to the width it is stored in.
  int64_t ValueAt(const char* source) const {
    const iio_data_format* const format = iio_channel_get_data_format(channel_);
    int64_t value = 0;
    iio_channel_convert(channel_, &value, source);
    const int unused_bits = 64 - static_cast<int>(format->length);
    const auto shifted = static_cast<uint64_t>(value) << unused_bits;
    return format->is_signed ? static_cast<int64_t>(shifted) >> unused_bits
                             : static_cast<int64_t>(shifted >> unused_bits);
  }

  std::vector<RawSample> Samples() const {
    std::vector<RawSample> samples;
    const ptrdiff_t step = iio_buffer_step(buffer_.get());
    const auto* const end = static_cast<const char*>(iio_buffer_end(buffer_.get()));
    const auto* value = static_cast<const char*>(iio_buffer_first(buffer_.get(), channel_));
    const auto* time = static_cast<const char*>(iio_buffer_first(buffer_.get(), timestamp_));
    for (; value < end && time < end; value += step, time += step) {
      RawSample sample = {.timestamp_ns = 0, .value = ValueAt(value)};
      iio_channel_convert(timestamp_, &sample.timestamp_ns, time);
      samples.push_back(sample);
    }
    return samples;
  }

  Context context_;
  iio_device* const device_;
  iio_channel* const channel_;
  iio_channel* const timestamp_;
  const iio_device* const trigger_;
  Buffer buffer_;  // after context_: destroyed before it
};

// The timer must be there before the context is made: libiio lists devices once.
absl::StatusOr<std::string> TriggerFor(const DeviceAddress& address) {
  if (!address.trigger.empty()) return address.trigger;
  EYEBOX_ASSIGN_OR_RETURN(const Context context, OpenContext());
  EYEBOX_ASSIGN_OR_RETURN(iio_device* const device, FindDevice(context, address.device));
  const iio_device* attached = nullptr;
  if (iio_device_get_trigger(device, &attached) == 0 && attached != nullptr) return std::string();
  std::string name = "eyebox-" + Called(iio_device_get_id(device));
  std::replace(name.begin(), name.end(), ':', '-');
  EYEBOX_RETURN_IF_ERROR(EnsureHrtimerTrigger(name));
  return name;
}

}  // namespace

absl::StatusOr<std::unique_ptr<IioDevice>> OpenLibiioDevice(const DeviceAddress& address) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string trigger_name, TriggerFor(address));
  EYEBOX_ASSIGN_OR_RETURN(Context context, OpenContext());
  EYEBOX_ASSIGN_OR_RETURN(iio_device* const device, FindDevice(context, address.device));
  EYEBOX_ASSIGN_OR_RETURN(iio_channel* const channel, FindChannel(device, address.channel));
  EYEBOX_ASSIGN_OR_RETURN(iio_channel* const timestamp, FindChannel(device, "timestamp"));
  EYEBOX_ASSIGN_OR_RETURN(const iio_device* const trigger,
                          AttachTrigger(context, device, trigger_name));
  for (unsigned i = 0; i < iio_device_get_channels_count(device); ++i) {
    iio_channel_disable(iio_device_get_channel(device, i));
  }
  iio_channel_enable(channel);
  iio_channel_enable(timestamp);
  return std::make_unique<LibiioDevice>(std::move(context), device, channel, timestamp, trigger);
}

}  // namespace eyebox::capture::iio
