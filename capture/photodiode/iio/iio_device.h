// The seam to an IIO converter: what libiio gives us, in values. libiio_device.cc is its only use
// of iio.h; tests put a device of their own in its place.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_IIO_IIO_DEVICE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_IIO_IIO_DEVICE_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::capture::iio {

struct ChannelFormat {
  int bits = 0;
  bool is_signed = false;
};

struct RawSample {
  int64_t timestamp_ns = 0;  // of the clock named by "current_timestamp_clock"
  int64_t value = 0;         // shifted and sign-extended
};

// Every call may fail with Unavailable (unplugged, refused by the driver); the message names the
// device.
class IioDevice {
 public:
  virtual ~IioDevice() = default;

  virtual std::string Name() const = 0;
  virtual ChannelFormat Format() const = 0;
  // Whether its trigger is its own (data ready), so that its own rate is that of the conversions.
  virtual bool TimesItself() const = 0;

  // Attributes of the device. Errors: NotFound (there is none of this name).
  virtual absl::Status WriteAttribute(const std::string& name, const std::string& value) = 0;
  virtual absl::StatusOr<std::string> ReadAttribute(const std::string& name) = 0;
  // Attributes of its trigger, "sampling_frequency" above all. Errors: NotFound.
  virtual absl::Status WriteTriggerAttribute(const std::string& name, const std::string& value) = 0;
  virtual absl::StatusOr<std::string> ReadTriggerAttribute(const std::string& name) = 0;

  // Channel and timestamp, `samples` at a time where they come fast, with room for
  // `kernel_samples` in the kernel.
  virtual absl::Status OpenBuffer(size_t samples, size_t kernel_samples) = 0;
  // What has arrived, in order; empty after `timeout`.
  virtual absl::StatusOr<std::vector<RawSample>> Refill(std::chrono::milliseconds timeout) = 0;
  virtual void CloseBuffer() = 0;
};

struct DeviceAddress {
  std::string device;   // name, label or id, like "ads1015" or "iio:device0"
  std::string channel;  // name or id, like "voltage0"
  std::string trigger;  // name; empty: the one it has, else an hrtimer trigger of ours
};

// "iio:DEVICE/CHANNEL[?trigger=NAME]". Errors: InvalidArgument.
absl::StatusOr<DeviceAddress> ParseIioUri(const std::string& uri);

// Opens it through libiio's local backend, with channel and timestamp enabled and the trigger
// attached. Errors: NotFound (device, channel or trigger: lists those there are), Unavailable.
absl::StatusOr<std::unique_ptr<IioDevice>> OpenLibiioDevice(const DeviceAddress& address);

}  // namespace eyebox::capture::iio

#endif  // EYEBOX_CAPTURE_PHOTODIODE_IIO_IIO_DEVICE_H_
