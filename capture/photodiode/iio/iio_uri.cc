#include <string_view>

#include "capture/base/status.h"
#include "capture/photodiode/iio/iio_device.h"

namespace eyebox::capture::iio {

absl::StatusOr<DeviceAddress> ParseIioUri(const std::string& uri) {
  constexpr std::string_view kScheme = "iio:";
  constexpr std::string_view kTrigger = "trigger=";
  std::string_view rest = std::string_view(uri).substr(kScheme.size());
  DeviceAddress address;
  if (const size_t query = rest.find('?'); query != std::string_view::npos) {
    std::string_view value = rest.substr(query + 1);
    if (!value.starts_with(kTrigger) || value.size() == kTrigger.size()) {
      return BadInput(uri, "has '" + std::string(value) + "' after its '?'",
                      "only ?trigger=NAME is known");
    }
    address.trigger = value.substr(kTrigger.size());
    rest = rest.substr(0, query);
  }
  const size_t slash = rest.rfind('/');
  if (slash == 0 || slash == std::string_view::npos || slash + 1 == rest.size()) {
    return BadInput(uri, "does not name device and channel", "give one like iio:ads1015/voltage0");
  }
  address.device = rest.substr(0, slash);
  address.channel = rest.substr(slash + 1);
  return address;
}

}  // namespace eyebox::capture::iio
