#include "service/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "service/report/report.h"

namespace eyebox::service::report {
namespace {

constexpr std::string_view kMinus = "\u2212";

std::string_view Superscript(char digit) {
  constexpr std::array<std::string_view, 10> kDigits = {"⁰", "¹", "²", "³", "⁴",
                                                        "⁵", "⁶", "⁷", "⁸", "⁹"};
  return digit == '-' ? "⁻" : kDigits[static_cast<size_t>(digit - '0')];
}

// The power of ten to factor out, 0 where plain decimals read well.
int CommonExponent(double value, double sigma) {
  const double size = std::max(std::abs(value), sigma);
  if (size == 0 || (size >= 1e-3 && size < 1e6)) return 0;
  return static_cast<int>(std::floor(std::log10(size)));
}

// Decimals that show `sigma` with two significant digits, as it reads after rounding.
int DecimalsOfSigma(double sigma) {
  const int exponent = static_cast<int>(std::floor(std::log10(sigma)));
  const double rounded = std::round(sigma * std::pow(10.0, 1 - exponent));
  return 1 - exponent - (rounded >= 100 ? 1 : 0);
}

std::string RoundedTo(double value, int decimals) {
  if (decimals >= 0) return Decimal(value, decimals);
  const double unit = std::pow(10.0, -decimals);
  return Decimal(std::round(value / unit) * unit, 0);
}

std::string TimesPowerOfTen(std::string_view mantissa, int exponent) {
  std::string text = fmt::format("{} × 10", mantissa);
  for (const char digit : fmt::format("{}", exponent)) text += Superscript(digit);
  return text;
}

}  // namespace

std::string Escape(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size() + text.size() / 8);
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        if (static_cast<uint8_t>(c) < 0x20 && c != '\n' && c != '\t') {
          escaped += "\uFFFD";
        } else {
          escaped += c;
        }
    }
  }
  return escaped;
}

std::string WithUnit(std::string_view quantity, std::string_view unit) {
  if (unit.empty() || unit == "1") return std::string(quantity);
  return fmt::format("{} ({})", quantity, unit == "cd/m2" ? "cd/m²" : unit);
}

std::string Decimal(double value, int decimals) {
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? fmt::format("{}{}", kMinus, digits) : digits;
}

std::string WithSigma(double value, double sigma) {
  const int exponent = CommonExponent(value, sigma);
  const double scale = std::pow(10.0, -exponent);
  if (!(sigma > 0)) {
    const std::string plain = fmt::format("{:.5g}", value * scale);
    return exponent == 0 ? plain : TimesPowerOfTen(plain, exponent);
  }
  const int decimals = DecimalsOfSigma(sigma * scale);
  const std::string both = fmt::format("{} ± {}", RoundedTo(value * scale, decimals),
                                       RoundedTo(sigma * scale, decimals));
  return exponent == 0 ? both : TimesPowerOfTen(fmt::format("({})", both), exponent);
}

std::string Percent(double fraction) { return fmt::format("{:.3g} %", 100 * fraction); }

}  // namespace eyebox::service::report
