// A GenICam camera as named features. The only file, with stream and fake_scene, that knows Aravis.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_DEVICE_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_DEVICE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/aravis/aravis_uri.h"

namespace eyebox::capture::aravis {

template <typename T>
struct Limits {
  T minimum{};
  T maximum{};
};

struct DeviceListing {
  std::string id;
  std::string vendor;
  std::string model;
  std::string serial;
};

// What answers now, over every interface that Aravis knows; takes about a second. Not what this
// process simulates. Thread-safe.
std::vector<DeviceListing> ListDevices();

// Every call goes to the device, nothing is cached. One thread only, lost() excepted.
// Errors of all calls: Unavailable (names the feature and what Aravis says of it).
class Device {
 public:
  // Errors: NotFound (no such camera), Unavailable (another program controls it).
  static absl::StatusOr<std::unique_ptr<Device>> Open(const AravisOptions& options);
  ~Device();

  const std::string& uri() const;
  bool is_fake() const;
  bool is_gige() const;
  // The heartbeat failed, or the device did not answer. It stays lost: open another.
  bool lost() const;
  // Asks it; one that does not answer is lost, which takes Aravis three seconds to find out.
  bool Answers();
  void* native() const;  // the ArvCamera, for stream and fake_scene

  // Implemented, and available in the present state.
  bool Has(const std::string& feature) const;
  bool Offers(const std::string& enumeration, const std::string& choice) const;

  absl::StatusOr<double> GetFloat(const std::string& feature) const;
  absl::StatusOr<int64_t> GetInteger(const std::string& feature) const;
  absl::StatusOr<bool> GetSwitch(const std::string& feature) const;
  absl::StatusOr<std::string> GetText(const std::string& feature) const;  // also enumerations
  absl::StatusOr<std::vector<std::string>> Choices(const std::string& enumeration) const;
  absl::StatusOr<std::vector<int64_t>> ChoiceValues(const std::string& enumeration) const;
  absl::StatusOr<Limits<double>> FloatLimits(const std::string& feature) const;
  absl::StatusOr<Limits<int64_t>> IntegerLimits(const std::string& feature) const;

  absl::Status SetFloat(const std::string& feature, double value);
  absl::Status SetInteger(const std::string& feature, int64_t value);
  absl::Status SetSwitch(const std::string& feature, bool value);
  absl::Status SetText(const std::string& feature, const std::string& value);
  absl::Status Execute(const std::string& command);

  // Makers name and scale these differently; Aravis knows how.
  absl::StatusOr<double> ExposureS() const;
  absl::StatusOr<Limits<double>> ExposureLimitsS() const;
  absl::Status SetExposureS(double exposure_s);
  bool HasBlackLevel() const;
  absl::StatusOr<double> BlackLevel() const;
  absl::StatusOr<Limits<double>> BlackLevelLimits() const;
  absl::Status SetBlackLevel(double level);
  // GigE Vision only.
  absl::Status SetPacketSize(int bytes);
  absl::Status SetPacketDelay(int64_t delay_ns);
  std::string Serial() const;  // empty where the camera does not tell

 private:
  struct Impl;
  explicit Device(std::unique_ptr<Impl> impl);
  const std::unique_ptr<Impl> impl_;
};

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_DEVICE_H_
