#include "capture/camera/sim/faults.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "capture/base/status.h"
#include "capture/photodiode/sim/strobe_light.h"

namespace eyebox::capture {
namespace {

constexpr double kLongestAutomaticS = 0.1;
constexpr double kStrobePeriodS = 1.0 / 90;
constexpr double kColdDegC = 25;
constexpr double kWarmingPresentations = 40;
constexpr double kDoublingKelvin = 7;

struct NamedFault {
  std::string_view name;
  void (*set)(SimFaults&);
};

constexpr NamedFault kNamed[] = {
    {"auto-exposure", [](SimFaults& faults) { faults.auto_exposure = true; }},
    {"gamma", [](SimFaults& faults) { faults.gamma = 0.45; }},
    {"stale-frames", [](SimFaults& faults) { faults.stale_frames = 2; }},
    {"clamped-black", [](SimFaults& faults) { faults.black_clamped = true; }},
    {"strobe", [](SimFaults& faults) { faults.strobe_period_s = kStrobePeriodS; }},
    {"rolling-shutter",
     [](SimFaults& faults) {
       faults.strobe_period_s = kStrobePeriodS;
       faults.row_time_s = 3e-4;
     }},
    {"moire", [](SimFaults& faults) { faults.display_pixel_px = 0.93; }},
    {"stuck-gain", [](SimFaults& faults) { faults.stuck_gain_db = 6; }},
    {"warming", [](SimFaults& faults) { faults.warming_kelvin = 10; }},
};

absl::Status SetFault(std::string_view name, SimFaults& faults) {
  std::string known;
  for (const NamedFault& named : kNamed) {
    if (named.name == name) {
      named.set(faults);
      return absl::OkStatus();
    }
    known.append(" ").append(named.name);
  }
  return BadInput("simulated fault '" + std::string(name) + "'", "is not known",
                  "take one of" + known);
}

// Share of the light of each pixel along one axis, mean 1.
std::vector<double> GridProfile(const SimFaults& faults, int pixels) {
  const StrobeLight aperture = {.period_s = faults.display_pixel_px,
                                .duty = faults.display_pixel_fill};
  std::vector<double> profile(static_cast<size_t>(pixels));
  for (int i = 0; i < pixels; ++i) {
    profile[static_cast<size_t>(i)] = aperture.IntegralS(i - 0.5, i + 0.5) / aperture.duty;
  }
  return profile;
}

}  // namespace

absl::StatusOr<SimFaults> ParseFaults(std::string_view query) {
  constexpr std::string_view kKey = "fault=";
  if (!query.starts_with(kKey)) {
    return BadInput("'" + std::string(query) + "' of a simulated rig", "is not known",
                    "write for example sim:rift-s-like?fault=gamma");
  }
  query.remove_prefix(kKey.size());
  SimFaults faults;
  while (true) {
    const size_t comma = query.find(',');
    EYEBOX_RETURN_IF_ERROR(SetFault(query.substr(0, comma), faults));
    if (comma == std::string_view::npos) return faults;
    query.remove_prefix(comma + 1);
  }
}

std::vector<std::string> SimFaultNames() {
  std::vector<std::string> names;
  for (const NamedFault& named : kNamed) names.emplace_back(named.name);
  return names;
}

double ExposureFault::Made(const CameraSettings& settings, const Image<double>& photo_rate_e_s) {
  if (told_s_ && *told_s_ != settings.exposure_s) {
    old_s_ = *told_s_;
    stale_left_ = faults_.stale_frames;
  }
  told_s_ = settings.exposure_s;
  if (faults_.auto_exposure) return Automatic(settings, photo_rate_e_s);
  if (stale_left_ <= 0) return settings.exposure_s;
  --stale_left_;
  return old_s_;
}

double ExposureFault::Automatic(const CameraSettings& settings,
                                const Image<double>& photo_rate_e_s) const {
  const auto rates = photo_rate_e_s.pixels();
  const double mean_e_s =
      std::accumulate(rates.begin(), rates.end(), 0.0) / static_cast<double>(rates.size());
  const double gain_dn_per_e = sensor_.gain_dn_per_e * std::pow(10, settings.gain_db / 20);
  const double wanted_dn = 0.5 * ((1 << sensor_.bits) - 1) - sensor_.bias_dn;
  return std::clamp(wanted_dn / std::max(gain_dn_per_e * mean_e_s, 1e-12), sensor_.exposure_min_s,
                    std::min(kLongestAutomaticS, sensor_.exposure_max_s));
}

Image<double> Flashed(const SimFaults& faults, const Image<double>& rate, double begin_s,
                      double exposure_s) {
  const StrobeLight light = {.period_s = faults.strobe_period_s, .duty = faults.strobe_duty};
  Image<double> flashed = rate;
  for (int y = 0; y < rate.size().height_px; ++y) {
    const double row_begin_s = begin_s + y * faults.row_time_s;
    const double lit_s = light.IntegralS(row_begin_s, row_begin_s + exposure_s);
    const double share = std::max(lit_s, 0.0) / (light.duty * exposure_s);
    for (double& value : flashed.row(y)) value *= share;
  }
  return flashed;
}

std::optional<double> SensorTemperatureDegC(const SimFaults& faults, uint64_t presentation) {
  if (faults.warming_kelvin == 0) return std::nullopt;
  const double warmed = 1 - std::exp(-static_cast<double>(presentation) / kWarmingPresentations);
  return kColdDegC + faults.warming_kelvin * warmed;
}

double DarkCurrentGrowth(std::optional<double> temperature_deg_c) {
  return temperature_deg_c ? std::exp2((*temperature_deg_c - kColdDegC) / kDoublingKelvin) : 1;
}

Image<double> DisplayGrid(const SimFaults& faults, ImageSize size) {
  const std::vector<double> across = GridProfile(faults, size.width_px);
  const std::vector<double> down = GridProfile(faults, size.height_px);
  Image<double> grid(size);
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      grid.at(x, y) = across[static_cast<size_t>(x)] * down[static_cast<size_t>(y)];
    }
  }
  return grid;
}

void Distort(const SimFaults& faults, const SensorParameters& sensor,
             std::vector<uint16_t>& counts_dn) {
  if (!faults.black_clamped && faults.gamma == 1) return;
  const double full_scale_dn = (1 << sensor.bits) - 1;
  const double taken_off_dn = faults.black_clamped ? sensor.bias_dn : 0;
  for (uint16_t& count : counts_dn) {
    const double kept_dn = std::max(count - taken_off_dn, 0.0);
    const double shown_dn = full_scale_dn * std::pow(kept_dn / full_scale_dn, faults.gamma);
    count = static_cast<uint16_t>(std::floor(shown_dn + 0.5));
  }
}

}  // namespace eyebox::capture
