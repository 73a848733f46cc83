#include "capture/camera/aravis/aravis_uri.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "capture/base/status.h"

namespace eyebox::capture::aravis {
namespace {

constexpr std::string_view kScheme = "aravis:";
constexpr std::string_view kFake = "fake";
constexpr int kLargestSide = 65535;

template <typename T>
bool ParseAll(std::string_view text, T& value) {
  const char* const end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && read == end;
}

// What stands before the first `mark`, and what behind it; the whole where there is none.
std::pair<std::string_view, std::string_view> SplitAt(std::string_view text, char mark) {
  const size_t at = text.find(mark);
  if (at == std::string_view::npos) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

template <typename T>
absl::Status ParseWhole(const std::string& where, std::string_view text, T minimum, T maximum,
                        T& value) {
  if (ParseAll(text, value) && value >= minimum && value <= maximum) {
    return absl::OkStatus();
  }
  return BadInput(
      where, "is '" + std::string(text) + "'",
      "give a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum));
}

absl::Status ParseRegion(const std::string& where, std::string_view text, AravisOptions& options) {
  const auto [width, behind_width] = SplitAt(text, 'x');
  const auto [height, offsets] = SplitAt(behind_width, '+');
  const auto [x, y] = SplitAt(offsets, '+');
  Region region;
  if (!ParseAll(width, region.size.width_px) || !ParseAll(height, region.size.height_px) ||
      !ParseAll(x, region.x_px) || !ParseAll(y, region.y_px)) {
    return BadInput(where, "is '" + std::string(text) + "'", "write it like 512x512+8+16");
  }
  if (region.size.width_px < 1 || region.size.height_px < 1 || region.x_px < 0 || region.y_px < 0 ||
      std::max({region.size.width_px, region.size.height_px, region.x_px, region.y_px}) >
          kLargestSide) {
    return BadInput(where, "is '" + std::string(text) + "'", "stay within the sensor");
  }
  options.region = region;
  return absl::OkStatus();
}

absl::Status ParseRate(const std::string& where, std::string_view text, double& rate_hz) {
  if (ParseAll(text, rate_hz) && rate_hz >= 0.1 && rate_hz <= 1e5) return absl::OkStatus();
  return BadInput(where, "is '" + std::string(text) + "'", "give a rate from 0.1 to 100000 Hz");
}

absl::Status ParseOption(std::string_view name, std::string_view value, AravisOptions& options) {
  const std::string where = options.uri + " " + std::string(name);
  if (name == "pixel_format") {
    EYEBOX_ASSIGN_OR_RETURN(options.pixel_format, FindPixelFormat(value));
    return absl::OkStatus();
  }
  if (name == "region") return ParseRegion(where, value, options);
  if (name == "buffers") return ParseWhole(where, value, 2, 4096, options.buffers);
  if (name == "packet_size") return ParseWhole(where, value, 576, 65000, options.packet_size_bytes);
  if (name == "packet_delay_ns") {
    return ParseWhole(where, value, int64_t{0}, int64_t{1000000000}, options.packet_delay_ns);
  }
  if (name == "socket_buffer_mib")
    return ParseWhole(where, value, 4, 32, options.socket_buffer_mib);
  if (name == "packet_socket") {
    int flag = 0;
    EYEBOX_RETURN_IF_ERROR(ParseWhole(where, value, 0, 1, flag));
    options.packet_socket = flag == 1;
    return absl::OkStatus();
  }
  if (name == "fake_rate_hz" && options.fake) return ParseRate(where, value, options.fake_rate_hz);
  return BadInput(where, "is no option of this camera",
                  "use pixel_format, region, buffers, packet_size, packet_delay_ns, "
                  "socket_buffer_mib or packet_socket");
}

}  // namespace

absl::StatusOr<AravisOptions> ParseAravisUri(std::string_view uri) {
  AravisOptions options;
  options.uri = std::string(uri);
  const auto [name, behind] = SplitAt(uri, '?');
  if (!name.starts_with(kScheme) || name == kScheme) {
    return BadInput(options.uri, "names no Aravis camera",
                    "give a URI like aravis:ID; `eyebox devices` lists what is connected");
  }
  options.id = std::string(name.substr(kScheme.size()));
  options.fake = options.id == kFake;
  if (options.fake) options.id.clear();
  for (std::string_view rest = behind; !rest.empty();) {
    const auto [option, others] = SplitAt(rest, '&');
    const auto [key, value] = SplitAt(option, '=');
    EYEBOX_RETURN_IF_ERROR(ParseOption(key, value, options));
    rest = others;
  }
  return options;
}

}  // namespace eyebox::capture::aravis
