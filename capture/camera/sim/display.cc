#include "capture/camera/sim/display.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "capture/base/status.h"
#include "capture/photodiode/sim/strobe_light.h"

namespace eyebox::capture {
namespace {

double RawNonuniformity(const NonuniformityParameters& p, double s, double t) {
  const double ds = s - p.centre_s;
  const double dt = t - p.centre_t;
  return std::exp(-p.falloff * (ds * ds + dt * dt)) *
         (1 + p.tilt_x * s + p.tilt_y * t + p.twist * s * t);
}

absl::Status CheckStimulus(const Stimulus& stimulus) {
  if (!stimulus.drive) {
    return BadInput("stimulus.drive", "is missing", "give the drive values of the three channels");
  }
  for (const double drive : *stimulus.drive) {
    if (drive >= 0 && drive <= 1) continue;
    return BadInput("stimulus.drive", "is " + std::to_string(drive), "give values from 0 to 1");
  }
  if (stimulus.pattern != StimulusPattern::kFullField &&
      !(stimulus.diameter_deg > 0 && stimulus.diameter_deg < 180)) {
    return BadInput("stimulus.diameter_deg", "is " + std::to_string(stimulus.diameter_deg),
                    "give the diameter of the disk, above 0 and below 180 deg");
  }
  if (stimulus.pattern == StimulusPattern::kCheckerboard && stimulus.diameter_deg >= 90) {
    return BadInput("stimulus.diameter_deg", "is " + std::to_string(stimulus.diameter_deg),
                    "give the side of a square, below 90 deg");
  }
  return absl::OkStatus();
}

// Share of a pixel that lies within the radius, to 1e-3 at the edge: columns, each cut exactly.
double Covered(double x_px, double y_px, double radius_px) {
  const double gap_px = radius_px - std::hypot(x_px, y_px);
  if (std::abs(gap_px) > std::numbers::sqrt2 / 2) return gap_px > 0 ? 1 : 0;
  constexpr int kColumns = 32;
  double covered = 0;
  for (int i = 0; i < kColumns; ++i) {
    const double u = x_px + (i + 0.5) / kColumns - 0.5;
    const double half = std::sqrt(std::max(radius_px * radius_px - u * u, 0.0));
    const double above = std::min(half, y_px + 0.5);
    const double below = std::max(-half, y_px - 0.5);
    covered += std::max(above - below, 0.0) / kColumns;
  }
  return covered;
}

// Pixels at the edge take the share of the luminance that the disk covers of them.
void PaintDisk(const PinholeGeometry& geometry, double diameter_deg, double luminance_cd_m2,
               Image<double>& scene) {
  const double radius_px =
      geometry.focal_length_px * std::tan(diameter_deg / 2 * std::numbers::pi / 180);
  for (int y = 0; y < scene.size().height_px; ++y) {
    for (int x = 0; x < scene.size().width_px; ++x) {
      const double covered =
          Covered(x - geometry.principal_x_px, y - geometry.principal_y_px, radius_px);
      scene.at(x, y) += covered * (luminance_cd_m2 - scene.at(x, y));
    }
  }
}

// Length of [from, to] in even squares: those from 0 to `side`, from 2 `side` to 3, and so on.
double EvenLength(double from, double to, double side) {
  const StrobeLight even = {.period_s = 2 * side, .duty = 0.5};
  return even.IntegralS(from, to);
}

// Squares of the even kind by turns along x and y; pixels across an edge take their share.
void PaintCheckerboard(const PinholeGeometry& geometry, double side_deg, double luminance_cd_m2,
                       Image<double>& scene) {
  const double side_px = geometry.focal_length_px * std::tan(side_deg * std::numbers::pi / 180);
  const auto share = [side_px](double centre_px) {
    return EvenLength(centre_px - 0.5, centre_px + 0.5, side_px);
  };
  for (int y = 0; y < scene.size().height_px; ++y) {
    const double down = share(y - geometry.principal_y_px);
    for (int x = 0; x < scene.size().width_px; ++x) {
      const double across = share(x - geometry.principal_x_px);
      const double covered = across * down + (1 - across) * (1 - down);
      scene.at(x, y) += covered * (luminance_cd_m2 - scene.at(x, y));
    }
  }
}

}  // namespace

double Activation(const ChannelParameters& channel, double drive) {
  const double above = (drive - channel.cutoff_drive) / (1 - channel.cutoff_drive);
  return above > 0 ? std::pow(above, channel.gamma) : 0;
}

double DisplayLuminance(const DisplayParameters& display, const DriveRgb& drive) {
  double activation = 0;
  for (size_t k = 0; k < drive.size(); ++k) {
    activation += display.channels[k].luminance_weight * Activation(display.channels[k], drive[k]);
  }
  return display.minimum_luminance_cd_m2 + display.luminance_range_cd_m2 * activation;
}

Image<double> Nonuniformity(const NonuniformityParameters& parameters, ImageSize size) {
  Image<double> g(size);
  const double reference = RawNonuniformity(parameters, 0, 0);
  const double half_width_px = size.width_px / 2.0;
  const double centre_x_px = (size.width_px - 1) / 2.0;
  const double centre_y_px = (size.height_px - 1) / 2.0;
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      g.at(x, y) = RawNonuniformity(parameters, (x - centre_x_px) / half_width_px,
                                    (y - centre_y_px) / half_width_px) /
                   reference;
    }
  }
  return g;
}

absl::StatusOr<Image<double>> DrawStimulus(const DisplayParameters& display,
                                           const PinholeGeometry& geometry, ImageSize size,
                                           const Stimulus& stimulus) {
  EYEBOX_RETURN_IF_ERROR(CheckStimulus(stimulus));
  const double lit = DisplayLuminance(display, *stimulus.drive);
  const double unlit = DisplayLuminance(display, {0, 0, 0});
  switch (stimulus.pattern) {
    case StimulusPattern::kFullField:
      return Image<double>(size, lit);
    case StimulusPattern::kDisk: {
      Image<double> scene(size, unlit);
      PaintDisk(geometry, stimulus.diameter_deg, lit, scene);
      return scene;
    }
    case StimulusPattern::kBlackDisk: {
      Image<double> scene(size, lit);
      PaintDisk(geometry, stimulus.diameter_deg, unlit, scene);
      return scene;
    }
    case StimulusPattern::kCheckerboard: {
      Image<double> scene(size, unlit);
      PaintCheckerboard(geometry, stimulus.diameter_deg, lit, scene);
      return scene;
    }
  }
  return BadInput("stimulus.pattern", "is not one that the simulator draws",
                  "use a full field, a disk, a black disk or a checkerboard");
}

}  // namespace eyebox::capture
