#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "service/report/axis.h"
#include "service/report/figures.h"
#include "service/report/svg.h"
#include "service/report/text.h"

namespace eyebox::service::report {
namespace {

constexpr double kLeft = 78;
constexpr double kRight = 640;
constexpr Range kUpperPanel = {14, 330};  // from top to bottom
constexpr Range kLowerPanel = {356, 490};
constexpr double kPointRadius = 3.6;

double RelativeSigma(const FitLevel& level) {
  const double fitted = level.luminance / (1 + level.relative_residual);
  return fitted != 0 ? level.luminance_sigma / std::abs(fitted) : 0;
}

Range DriveRange(const FitFigure& fit) {
  Range range{fit.levels.front().drive, fit.levels.front().drive};
  const auto include = [&range](double drive) {
    range = {std::min(range.minimum, drive), std::max(range.maximum, drive)};
  };
  for (const FitLevel& level : fit.levels) include(level.drive);
  for (const FitCurvePoint& point : fit.curve) include(point.drive);
  return Widened(range, 0.02);
}

Axis LuminanceAxis(const FitFigure& fit) {
  Range range{fit.levels.front().luminance, fit.levels.front().luminance};
  const auto include = [&range](double luminance) {
    range = {std::min(range.minimum, luminance), std::max(range.maximum, luminance)};
  };
  for (const FitLevel& level : fit.levels) include(level.luminance);
  for (const FitCurvePoint& point : fit.curve) include(point.luminance);
  if (range.minimum <= 0) {
    return LinearAxis(Widened(range, 0.05), kUpperPanel.maximum, kUpperPanel.minimum);
  }
  const double margin = std::pow(std::max(range.maximum / range.minimum, 1.1), 0.05);
  return LogarithmicAxis({range.minimum / margin, range.maximum * margin}, kUpperPanel.maximum,
                         kUpperPanel.minimum);
}

Axis ResidualAxis(const FitFigure& fit) {
  double extent = 0;
  for (const FitLevel& level : fit.levels) {
    extent = std::max(extent, std::abs(level.relative_residual) + RelativeSigma(level));
  }
  const double percent = extent > 0 ? 115 * extent : 1;
  return LinearAxis({-percent, percent}, kLowerPanel.maximum, kLowerPanel.minimum, 5);
}

void DrawErrorBar(Svg& svg, const Panel& panel, double x, double low, double high) {
  const double at = panel.x.Position(x);
  const double bottom = panel.y.Position(std::max(low, panel.y.values.minimum));
  const double top = panel.y.Position(std::min(high, panel.y.values.maximum));
  // Caps would cover the point itself where the bar is shorter than it.
  if (bottom - top > 2 * kPointRadius) svg.Line({{at, bottom}, {at, top}}, "error-bar");
}

void DrawLuminance(Svg& svg, const Panel& panel, const FitFigure& fit) {
  DrawGrid(svg, panel);
  std::vector<Point> curve;
  for (const FitCurvePoint& p : fit.curve) curve.push_back(panel.At(p.drive, p.luminance));
  svg.Polyline(curve, "curve curve-0");
  for (const FitLevel& level : fit.levels) {
    DrawErrorBar(svg, panel, level.drive, level.luminance - level.luminance_sigma,
                 level.luminance + level.luminance_sigma);
    svg.Circle(panel.At(level.drive, level.luminance), kPointRadius, "point");
  }
  DrawFrame(svg, panel);
}

void DrawResiduals(Svg& svg, const Panel& panel, const FitFigure& fit) {
  DrawGrid(svg, panel);
  svg.Line({{panel.x.from, panel.y.Position(0)}, {panel.x.to, panel.y.Position(0)}},
           "curve curve-0");
  for (const FitLevel& level : fit.levels) {
    const double residual = 100 * level.relative_residual;
    const double sigma = 100 * RelativeSigma(level);
    DrawErrorBar(svg, panel, level.drive, residual - sigma, residual + sigma);
    svg.Circle(panel.At(level.drive, residual), kPointRadius, "point");
  }
  DrawFrame(svg, panel);
}

}  // namespace

std::string DrawFit(const FitFigure& fit) {
  const Axis drive = LinearAxis(DriveRange(fit), kLeft, kRight, 10);
  Svg svg(kRight + 16, kLowerPanel.maximum + 50, fit.title);
  DrawLuminance(svg, {drive, LuminanceAxis(fit), "", WithUnit("luminance", fit.luminance_unit)},
                fit);
  DrawResiduals(svg, {drive, ResidualAxis(fit), "drive value v", "residual (%)"}, fit);
  return std::move(svg).Finish();
}

}  // namespace eyebox::service::report
