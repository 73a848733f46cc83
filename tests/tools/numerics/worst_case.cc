#include "tests/tools/numerics/worst_case.h"

#include <cmath>
#include <limits>

#include "absl/strings/str_format.h"

namespace eyebox::numerics {
namespace {

constexpr double kSmallestNormal = std::numeric_limits<double>::min();

double UlpOf(double value) {
  const double size = std::abs(value);
  return std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
}

std::string TextOf(Arguments arguments) {
  std::string text;
  for (const auto& [name, value] : arguments) {
    absl::StrAppendFormat(&text, "%s%s %.6g", text.empty() ? "" : ", ", name, value);
  }
  return text;
}

}  // namespace

WorstCase::WorstCase(std::string function, double promised, Measure measure) {
  row_.function = std::move(function);
  row_.promised = promised;
  row_.measure = measure;
}

void WorstCase::Compare(double value, const Digits50& exact, Arguments arguments, double scale) {
  ++row_.points;
  const auto nearest = static_cast<double>(exact);
  double error = std::numeric_limits<double>::infinity();
  double ulp = error;
  if (std::isfinite(value) && std::isfinite(nearest)) {
    const auto difference = static_cast<double>(abs(Digits50(value) - exact));
    ulp = difference / UlpOf(nearest);
    if (row_.measure == Measure::kOfScale) {
      error = difference / std::abs(scale);
    } else if (std::abs(nearest) >= kSmallestNormal) {
      error = difference / std::abs(nearest);
    } else {
      error = std::abs(value) <= kSmallestNormal ? 0 : 1;
      ulp = 0;
    }
  } else if (value == nearest) {
    error = ulp = 0;  // the same infinity
  }
  if (!(error > row_.worst)) return;
  row_.worst = error;
  row_.worst_ulp = ulp;
  row_.where = TextOf(arguments);
}

std::vector<Row> AllRows(Density density) {
  std::vector<Row> rows;
  AddActivationRows(density, rows);
  AddGradientRows(density, rows);
  AddRenderRows(density, rows);
  AddTableRows(density, rows);
  AddMaterialRows(density, rows);
  AddGeometryRows(density, rows);
  AddScatterRows(density, rows);
  AddDistributionRows(density, rows);
  AddVarianceRows(density, rows);
  return rows;
}

std::vector<double> LogSteps(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(i + 1 == count ? high : low * std::pow(high / low, i / (count - 1.0)));
  }
  return values;
}

}  // namespace eyebox::numerics
