#include "capture/camera/aravis/device.h"

#include <arv.h>

#include <atomic>
#include <mutex>

#include "capture/base/status.h"

namespace eyebox::capture::aravis {
namespace {

// Aravis' list of devices is one for the process.
std::mutex& ListMutex() {
  static std::mutex mutex;
  return mutex;
}

std::string Text(const char* text) { return text == nullptr ? "" : text; }

// Receives the error of one Aravis call. Aravis has tried six times when it says that a device does
// not answer: such a device is lost.
class Outcome {
 public:
  explicit Outcome(std::string where, std::atomic<bool>* lost = nullptr)
      : where_(std::move(where)), lost_(lost) {}
  ~Outcome() {
    if (lost_ != nullptr && (Is(ARV_DEVICE_ERROR_TIMEOUT) || Is(ARV_DEVICE_ERROR_NOT_CONNECTED) ||
                             Is(ARV_DEVICE_ERROR_NOT_CONTROLLER))) {
      *lost_ = true;
    }
    g_clear_error(&error_);
  }
  Outcome(const Outcome&) = delete;
  Outcome& operator=(const Outcome&) = delete;

  GError** error() { return &error_; }
  bool ok() const { return error_ == nullptr; }
  bool Is(ArvDeviceError code) const { return g_error_matches(error_, ARV_DEVICE_ERROR, code); }
  absl::Status ToStatus() const {
    if (ok()) return absl::OkStatus();
    return DeviceFailed(where_, "failed: " + Text(error_->message),
                        "check that the camera is connected and that no other program holds it");
  }
  template <typename T>
  absl::StatusOr<T> Or(T value) const {
    if (!ok()) return ToStatus();
    return value;
  }

 private:
  std::string where_;
  std::atomic<bool>* lost_;
  GError* error_ = nullptr;
};

void OnControlLost(ArvDevice*, void* lost) { static_cast<std::atomic<bool>*>(lost)->store(true); }

ArvCamera* OpenNative(const AravisOptions& options, GError** error) {
  const std::lock_guard lock(ListMutex());
  if (!options.fake) return arv_camera_new(options.id.c_str(), error);
  ArvDevice* device = arv_fake_device_new("fake", error);
  if (device == nullptr) return nullptr;
  ArvCamera* camera = arv_camera_new_with_device(device, error);
  g_object_unref(device);
  return camera;
}

}  // namespace

std::vector<DeviceListing> ListDevices() {
  const std::lock_guard lock(ListMutex());
  arv_update_device_list();
  std::vector<DeviceListing> devices;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    devices.push_back({.id = Text(arv_get_device_id(i)),
                       .vendor = Text(arv_get_device_vendor(i)),
                       .model = Text(arv_get_device_model(i)),
                       .serial = Text(arv_get_device_serial_nbr(i))});
  }
  return devices;
}

struct Device::Impl {
  ~Impl() {
    g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera), &lost);
    g_object_unref(camera);
  }
  Outcome Try(const std::string& feature) { return Outcome(uri + " " + feature, &lost); }

  std::string uri;
  ArvCamera* camera = nullptr;
  bool fake = false;
  std::atomic<bool> lost = false;
};

Device::Device(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Device::~Device() = default;

absl::StatusOr<std::unique_ptr<Device>> Device::Open(const AravisOptions& options) {
  Outcome outcome(options.uri);
  ArvCamera* camera = OpenNative(options, outcome.error());
  if (camera == nullptr) {
    if (!outcome.ok() && !outcome.Is(ARV_DEVICE_ERROR_NOT_FOUND)) return outcome.ToStatus();
    return Missing(options.uri, "is not there",
                   "connect and power it; `eyebox devices` lists what answers");
  }
  auto impl = std::make_unique<Impl>();
  impl->uri = options.uri;
  impl->camera = camera;
  impl->fake = options.fake;
  arv_camera_set_register_cache_policy(camera, ARV_REGISTER_CACHE_POLICY_DISABLE);
  g_signal_connect(arv_camera_get_device(camera), "control-lost", G_CALLBACK(OnControlLost),
                   &impl->lost);
  return std::unique_ptr<Device>(new Device(std::move(impl)));
}

const std::string& Device::uri() const { return impl_->uri; }
bool Device::is_fake() const { return impl_->fake; }
bool Device::is_gige() const { return arv_camera_is_gv_device(impl_->camera); }
bool Device::lost() const { return impl_->lost; }

bool Device::Answers() {
  // Both GigE Vision and USB3 Vision keep their version at address 0.
  Outcome outcome = impl_->Try("version");
  guint32 version = 0;
  arv_device_read_register(arv_camera_get_device(impl_->camera), 0, &version, outcome.error());
  if (!outcome.ok()) impl_->lost = true;
  return outcome.ok();
}

void* Device::native() const { return impl_->camera; }

bool Device::Has(const std::string& feature) const {
  return arv_camera_is_feature_available(impl_->camera, feature.c_str(), nullptr);
}

bool Device::Offers(const std::string& enumeration, const std::string& choice) const {
  return Has(enumeration) && arv_camera_is_enumeration_entry_available(
                                 impl_->camera, enumeration.c_str(), choice.c_str(), nullptr);
}

absl::StatusOr<double> Device::GetFloat(const std::string& feature) const {
  Outcome outcome = impl_->Try(feature);
  const double value = arv_camera_get_float(impl_->camera, feature.c_str(), outcome.error());
  return outcome.Or(value);
}

absl::StatusOr<int64_t> Device::GetInteger(const std::string& feature) const {
  Outcome outcome = impl_->Try(feature);
  const int64_t value = arv_camera_get_integer(impl_->camera, feature.c_str(), outcome.error());
  return outcome.Or(value);
}

absl::StatusOr<bool> Device::GetSwitch(const std::string& feature) const {
  Outcome outcome = impl_->Try(feature);
  const bool value = arv_camera_get_boolean(impl_->camera, feature.c_str(), outcome.error());
  return outcome.Or(value);
}

absl::StatusOr<std::string> Device::GetText(const std::string& feature) const {
  Outcome outcome = impl_->Try(feature);
  const char* value = arv_camera_get_string(impl_->camera, feature.c_str(), outcome.error());
  return outcome.Or(Text(value));
}

absl::StatusOr<std::vector<std::string>> Device::Choices(const std::string& enumeration) const {
  Outcome outcome = impl_->Try(enumeration);
  unsigned count = 0;
  const char** names = arv_camera_dup_available_enumerations_as_strings(
      impl_->camera, enumeration.c_str(), &count, outcome.error());
  std::vector<std::string> choices;
  if (names != nullptr) choices.assign(names, names + count);
  g_free(names);
  return outcome.Or(std::move(choices));
}

absl::StatusOr<std::vector<int64_t>> Device::ChoiceValues(const std::string& enumeration) const {
  Outcome outcome = impl_->Try(enumeration);
  unsigned count = 0;
  int64_t* values = arv_camera_dup_available_enumerations(impl_->camera, enumeration.c_str(),
                                                          &count, outcome.error());
  std::vector<int64_t> choices;
  if (values != nullptr) choices.assign(values, values + count);
  g_free(values);
  return outcome.Or(std::move(choices));
}

absl::StatusOr<Limits<double>> Device::FloatLimits(const std::string& feature) const {
  Outcome outcome = impl_->Try(feature);
  Limits<double> limits;
  arv_camera_get_float_bounds(impl_->camera, feature.c_str(), &limits.minimum, &limits.maximum,
                              outcome.error());
  return outcome.Or(limits);
}

absl::StatusOr<Limits<int64_t>> Device::IntegerLimits(const std::string& feature) const {
  Outcome outcome = impl_->Try(feature);
  Limits<int64_t> limits;
  arv_camera_get_integer_bounds(impl_->camera, feature.c_str(), &limits.minimum, &limits.maximum,
                                outcome.error());
  return outcome.Or(limits);
}

absl::Status Device::SetFloat(const std::string& feature, double value) {
  Outcome outcome = impl_->Try(feature);
  arv_camera_set_float(impl_->camera, feature.c_str(), value, outcome.error());
  return outcome.ToStatus();
}

absl::Status Device::SetInteger(const std::string& feature, int64_t value) {
  Outcome outcome = impl_->Try(feature);
  arv_camera_set_integer(impl_->camera, feature.c_str(), value, outcome.error());
  return outcome.ToStatus();
}

absl::Status Device::SetSwitch(const std::string& feature, bool value) {
  Outcome outcome = impl_->Try(feature);
  arv_camera_set_boolean(impl_->camera, feature.c_str(), value, outcome.error());
  return outcome.ToStatus();
}

absl::Status Device::SetText(const std::string& feature, const std::string& value) {
  Outcome outcome = impl_->Try(feature);
  arv_camera_set_string(impl_->camera, feature.c_str(), value.c_str(), outcome.error());
  return outcome.ToStatus();
}

absl::Status Device::Execute(const std::string& command) {
  Outcome outcome = impl_->Try(command);
  arv_camera_execute_command(impl_->camera, command.c_str(), outcome.error());
  return outcome.ToStatus();
}

absl::StatusOr<double> Device::ExposureS() const {
  Outcome outcome = impl_->Try("exposure time");
  const double exposure_us = arv_camera_get_exposure_time(impl_->camera, outcome.error());
  return outcome.Or(exposure_us / 1e6);
}

absl::StatusOr<Limits<double>> Device::ExposureLimitsS() const {
  Outcome outcome = impl_->Try("limits of the exposure time");
  Limits<double> limits;
  arv_camera_get_exposure_time_bounds(impl_->camera, &limits.minimum, &limits.maximum,
                                      outcome.error());
  return outcome.Or(Limits<double>{limits.minimum / 1e6, limits.maximum / 1e6});
}

absl::Status Device::SetExposureS(double exposure_s) {
  Outcome outcome = impl_->Try("exposure time");
  arv_camera_set_exposure_time(impl_->camera, exposure_s * 1e6, outcome.error());
  return outcome.ToStatus();
}

bool Device::HasBlackLevel() const {
  return arv_camera_is_black_level_available(impl_->camera, nullptr);
}

absl::StatusOr<double> Device::BlackLevel() const {
  Outcome outcome = impl_->Try("black level");
  const double level = arv_camera_get_black_level(impl_->camera, outcome.error());
  return outcome.Or(level);
}

absl::StatusOr<Limits<double>> Device::BlackLevelLimits() const {
  Outcome outcome = impl_->Try("limits of the black level");
  Limits<double> limits;
  arv_camera_get_black_level_bounds(impl_->camera, &limits.minimum, &limits.maximum,
                                    outcome.error());
  return outcome.Or(limits);
}

absl::Status Device::SetBlackLevel(double level) {
  Outcome outcome = impl_->Try("black level");
  arv_camera_set_black_level(impl_->camera, level, outcome.error());
  return outcome.ToStatus();
}

absl::Status Device::SetPacketSize(int bytes) {
  Outcome outcome = impl_->Try("packet size");
  arv_camera_gv_set_packet_size_adjustment(impl_->camera, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  arv_camera_gv_set_packet_size(impl_->camera, bytes, outcome.error());
  return outcome.ToStatus();
}

absl::Status Device::SetPacketDelay(int64_t delay_ns) {
  Outcome outcome = impl_->Try("packet delay");
  arv_camera_gv_set_packet_delay(impl_->camera, delay_ns, outcome.error());
  return outcome.ToStatus();
}

std::string Device::Serial() const {
  Outcome outcome = impl_->Try("serial number");
  const char* serial = arv_camera_get_device_serial_number(impl_->camera, outcome.error());
  return outcome.ok() ? Text(serial) : "";
}

}  // namespace eyebox::capture::aravis
