#include "service/report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "service/report/text.h"

namespace eyebox::service::report {
namespace {

double NiceStep(double rough) {
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double ratio = rough / power;
  if (ratio <= 1) return power;
  if (ratio <= 2) return 2 * power;
  return ratio <= 5 ? 5 * power : 10 * power;
}

std::string LogarithmicLabel(double value) {
  return value >= 1e-3 && value < 1e5 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
}

}  // namespace

double Axis::Position(double value) const {
  const bool logarithmic = scale == Scale::kLogarithmic;
  const auto on_scale = [logarithmic](double v) { return logarithmic ? std::log10(v) : v; };
  const double low = on_scale(values.minimum);
  const double high = on_scale(values.maximum);
  return from + (to - from) * (on_scale(value) - low) / (high - low);
}

std::vector<Tick> LinearTicks(Range values, int count) {
  const double step = NiceStep((values.maximum - values.minimum) / count);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  const double slack = 1e-9 * step;
  for (double n = std::ceil((values.minimum - slack) / step); n * step <= values.maximum + slack;
       ++n) {
    ticks.push_back({n * step, Decimal(n * step, decimals)});
  }
  return ticks;
}

std::vector<Tick> LogarithmicTicks(Range values) {
  const double decades = std::log10(values.maximum / values.minimum);
  std::vector<Tick> ticks;
  for (double power = std::floor(std::log10(values.minimum));
       std::pow(10.0, power) <= values.maximum; ++power) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * std::pow(10.0, power);
      if (value < values.minimum * (1 - 1e-9) || value > values.maximum * (1 + 1e-9)) continue;
      const bool labelled = digit == 1 || (decades < 3 && (digit == 2 || digit == 5));
      ticks.push_back({value, labelled ? LogarithmicLabel(value) : ""});
    }
  }
  return ticks;
}

Axis LinearAxis(Range values, double from, double to, int tick_count) {
  return {Scale::kLinear, values, from, to, LinearTicks(values, tick_count)};
}

Axis LogarithmicAxis(Range values, double from, double to) {
  return {Scale::kLogarithmic, values, from, to, LogarithmicTicks(values)};
}

Range Widened(Range values, double share) {
  double margin = share * (values.maximum - values.minimum);
  if (!(margin > 0)) margin = std::max(1e-6, 0.01 * std::abs(values.maximum));
  return {values.minimum - margin, values.maximum + margin};
}

}  // namespace eyebox::service::report
