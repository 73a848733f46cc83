#include "optics/sensor/sensor_characterisation.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/sensor/sensor_range.h"

namespace eyebox::optics {
namespace {

double ShareOf(const Image<uint8_t>& defective) {
  return static_cast<double>(std::count(defective.pixels().begin(), defective.pixels().end(), 1)) /
         static_cast<double>(defective.pixels().size());
}

absl::StatusOr<DefectMap> FindDefects(const SeriesCollector& series, const DefectOptions& options) {
  const std::array<Stack, 2> darks = {*series.shortest_dark, *series.longest_dark};
  EYEBOX_ASSIGN_OR_RETURN(DefectMap map, FindHotPixels(darks, options));
  EYEBOX_RETURN_IF_ERROR(AddDeadPixels(*series.half_bright, *series.shortest_dark, options, map));
  return map;
}

// Of steps under one light, before anything clips.
std::vector<LinearityPair> PairsOf(const Emva1288Result& emva) {
  std::map<int, std::vector<ResponsePoint>> groups;
  for (const PhotonTransferStep& step : emva.steps) {
    if (step.saturated_share > 0 || step.irradiation > emva.saturation_irradiation.value) continue;
    std::vector<ResponsePoint>& points = groups[step.group];
    points.push_back(
        {step.irradiation, step.signal_dn, step.signal_sigma_dn * step.signal_sigma_dn});
  }
  std::vector<LinearityPair> pairs;
  for (const auto& [group, points] : groups) {
    const std::vector<LinearityPair> more = PairsOfSeries(points);
    pairs.insert(pairs.end(), more.begin(), more.end());
  }
  return pairs;
}

}  // namespace

NoiseModel SensorCharacterisation::ToNoiseModel() const {
  NoiseModel noise;
  noise.gain_dn_per_e = emva.gain_dn_per_e.value;
  noise.gain_sigma_dn_per_e = emva.gain_dn_per_e.sigma;
  const double dark_dn = emva.dark_noise_dn.value;
  noise.read_variance_dn2 = std::max(dark_dn * dark_dn - noise.quantisation_variance_dn2, 0.0);
  noise.read_variance_sigma_dn2 = 2 * dark_dn * emva.dark_noise_dn.sigma;
  noise.bias_dn = emva.dark_mean_dn.value;
  noise.noise_source = emva.release;
  noise.gain_db = gain_db;
  return noise;
}

absl::StatusOr<double> SensorCharacterisation::SaturationMargin() const {
  constexpr double kLargestMargin = 0.5;
  const SensorRange full{identity.bits};
  if (identity.bits == 0 || !emva.saturation_reached) return full.saturation_margin;
  EYEBOX_RETURN_IF_ERROR(Validate(full));
  const double saturation_dn =
      emva.dark_mean_dn.value + emva.gain_dn_per_e.value * emva.saturation_e.value;
  const double margin = std::max(1 - saturation_dn / full.FullScaleDn(), full.saturation_margin);
  if (margin <= kLargestMargin) return margin;
  return BadInput("sensor",
                  absl::StrCat("it saturates at ", saturation_dn, " DN of ", full.FullScaleDn()),
                  "state the significant bits that its counts fill");
}

absl::StatusOr<SensorCharacterisation> CharacteriseSensor(const SeriesCollector& series,
                                                          const Emva1288Options& options,
                                                          const DefectOptions& defects) {
  if (!series.half_bright || !series.shortest_dark) {
    return Rejected("series", "it needs bright sets and dark sets",
                    "record both, with the same exposures");
  }
  SensorCharacterisation sensor;
  EYEBOX_ASSIGN_OR_RETURN(sensor.emva, EvaluateEmva1288(series.sets, options));
  EYEBOX_ASSIGN_OR_RETURN(sensor.defects, FindDefects(series, defects));
  sensor.gain_db = series.shortest_dark->setting.gain_db;
  auto curve = EstimateLinearity(PairsOf(sensor.emva));
  if (curve.ok()) {
    sensor.linearity = *std::move(curve);
  } else {
    sensor.emva.warnings.push_back(
        absl::StrCat("no linearity correction: ", curve.status().message()));
  }
  return sensor;
}

absl::Status ApplySensor(const SensorCharacterisation& sensor, Calibration& calibration) {
  if (sensor.defects.defective.size() != calibration.defects.defective.size()) {
    return BadInput("sensor", "its defect map has another size than the calibration's",
                    "characterise the camera with the region of interest of the recording");
  }
  if (!SameSetting({1, sensor.gain_db}, {1, calibration.noise.gain_db})) {
    return BadInput(
        "sensor",
        absl::StrCat("it was characterised at ", sensor.gain_db, " dB, the recording was made at ",
                     calibration.noise.gain_db, " dB"),
        "characterise the camera at the gain of the recording");
  }
  EYEBOX_ASSIGN_OR_RETURN(calibration.saturation_margin, sensor.SaturationMargin());
  calibration.noise = sensor.ToNoiseModel();
  calibration.linearity = sensor.linearity;
  const auto known = calibration.defects.defective.pixels();
  const auto added = sensor.defects.defective.pixels();
  for (size_t i = 0; i < known.size(); ++i) {
    known[i] = static_cast<uint8_t>(known[i] | added[i]);
  }
  calibration.defects.hot_share = ShareOf(calibration.defects.defective);
  return absl::OkStatus();
}

}  // namespace eyebox::optics
