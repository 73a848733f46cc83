#include "service/cli/share.h"

#include <charconv>

#include "capture/base/status.h"

namespace eyebox::service::cli {
namespace {

absl::StatusOr<double> NumberOf(std::string_view option, std::string_view text,
                                std::string_view digits, std::string_view remedy) {
  double value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error == std::errc() && stop == end) return value;
  return BadInput(std::string(option), "\"" + std::string(text) + "\" is no number",
                  std::string(remedy));
}

}  // namespace

absl::StatusOr<double> ShareOf(std::string_view option, std::string_view text) {
  std::string_view digits = text;
  const bool is_percent = digits.ends_with('%');
  if (is_percent) digits.remove_suffix(1);
  EYEBOX_ASSIGN_OR_RETURN(const double value,
                          NumberOf(option, text, digits, "give a share such as 0.02 or 2%"));
  return is_percent ? value / 100 : value;
}

absl::StatusOr<double> SecondsOf(std::string_view option, std::string_view text) {
  constexpr std::string_view kMinutes = "min";
  constexpr double kSecondsPerMinute = 60;
  std::string_view digits = text;
  double unit = 1;
  if (digits.ends_with(kMinutes)) {
    digits.remove_suffix(kMinutes.size());
    unit = kSecondsPerMinute;
  } else if (digits.ends_with('s')) {
    digits.remove_suffix(1);
  }
  EYEBOX_ASSIGN_OR_RETURN(const double value,
                          NumberOf(option, text, digits, "give a time such as 120s or 2min"));
  return unit * value;
}

}  // namespace eyebox::service::cli
