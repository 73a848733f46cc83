#include "capture/camera/v4l2/v4l2_uri.h"

#include <charconv>
#include <cmath>

#include "capture/base/status.h"
#include "capture/camera/v4l2/v4l2_format.h"

namespace eyebox::capture {
namespace {

constexpr std::string_view kScheme = "v4l2:";

// The part before `separator`, which is taken off `rest` together with it.
std::string_view TakeUntil(char separator, std::string_view& rest) {
  const size_t end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return part;
}

template <typename Number>
std::optional<Number> ToNumber(std::string_view text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

std::optional<ImageSize> ToSize(std::string_view text) {
  const auto width = ToNumber<int>(TakeUntil('x', text));
  const auto height = ToNumber<int>(text);
  if (!width || !height || *width < 1 || *height < 1) return std::nullopt;
  return ImageSize{.width_px = *width, .height_px = *height};
}

// False where the value does not fit the key.
bool Set(std::string_view key, std::string_view value, V4l2Options& options) {
  if (key == "format") {
    options.format = value;
    return FindV4l2Format(value) != nullptr;
  }
  if (key == "size") return (options.size_px = ToSize(value)).has_value();
  if (key == "gamma") return (options.gamma = ToNumber<int32_t>(value)).has_value();
  options.gain_db_per_step = ToNumber<double>(value);
  return options.gain_db_per_step && std::isfinite(*options.gain_db_per_step) &&
         *options.gain_db_per_step > 0;
}

std::string_view Expected(std::string_view key) {
  if (key == "format") return "give a raw format such as GREY, Y10, Y12, Y16, Y10P, RG12, BYR2";
  if (key == "size") return "give WIDTHxHEIGHT in pixels, for example 1280x800";
  if (key == "gamma") return "give the whole number that means linear for this camera";
  if (key == "gain_db_per_step") return "give a number above 0 from the camera's data sheet";
  return "known are format, size, gain_db_per_step and gamma";
}

}  // namespace

absl::StatusOr<V4l2Options> ParseV4l2Uri(std::string_view uri) {
  V4l2Options options;
  options.uri = uri;
  std::string_view rest = uri;
  if (!rest.starts_with(kScheme)) {
    return BadInput(uri, "is no V4L2 camera", "give a URI like v4l2:/dev/video0");
  }
  rest.remove_prefix(kScheme.size());
  options.path = TakeUntil('?', rest);
  if (!options.path.starts_with('/')) {
    return BadInput(uri, "names no device", "give its whole path, for example v4l2:/dev/video0");
  }
  while (!rest.empty()) {
    std::string_view value = TakeUntil('&', rest);
    const std::string key(TakeUntil('=', value));
    const std::string_view expected = Expected(key);
    const bool known = !expected.starts_with("known");
    if (!known || !Set(key, value, options)) {
      return BadInput(
          options.uri + " " + key,
          known ? "is '" + std::string(value) + "'" : "is not an option of v4l2:", expected);
    }
  }
  return options;
}

}  // namespace eyebox::capture
