#include "capture/camera/aravis/verified.h"

#include <cmath>

#include "capture/base/status.h"

namespace eyebox::capture::aravis {
namespace {

std::string Show(const std::string& value) { return "'" + value + "'"; }
std::string Show(bool value) { return value ? "on" : "off"; }
std::string Show(int64_t value) { return std::to_string(value); }
std::string Show(double value) { return std::to_string(value); }

template <typename T>
bool Same(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, double>) return std::abs(a - b) <= 1e-6 * std::abs(b);
  return a == b;
}

template <typename T, typename Get, typename Set>
absl::Status Hold(const Device& device, const std::string& feature, const T& value, Get get,
                  Set set) {
  EYEBOX_ASSIGN_OR_RETURN(const T before, get());
  if (Same(before, value)) return absl::OkStatus();
  EYEBOX_RETURN_IF_ERROR(set());
  EYEBOX_ASSIGN_OR_RETURN(const T after, get());
  if (Same(after, value)) return absl::OkStatus();
  return DeviceFailed(device.uri() + " " + feature,
                      "reads back " + Show(after) + " after " + Show(value) + " was written",
                      "set it with the maker's software, or measure with another camera");
}

}  // namespace

absl::Status HoldText(Device& device, const std::string& feature, const std::string& value) {
  return Hold(
      device, feature, value, [&] { return device.GetText(feature); },
      [&] { return device.SetText(feature, value); });
}

absl::Status HoldSwitch(Device& device, const std::string& feature, bool value) {
  return Hold(
      device, feature, value, [&] { return device.GetSwitch(feature); },
      [&] { return device.SetSwitch(feature, value); });
}

absl::Status HoldInteger(Device& device, const std::string& feature, int64_t value) {
  return Hold(
      device, feature, value, [&] { return device.GetInteger(feature); },
      [&] { return device.SetInteger(feature, value); });
}

absl::Status HoldFloat(Device& device, const std::string& feature, double value) {
  return Hold(
      device, feature, value, [&] { return device.GetFloat(feature); },
      [&] { return device.SetFloat(feature, value); });
}

}  // namespace eyebox::capture::aravis
