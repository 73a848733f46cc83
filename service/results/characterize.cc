#include "service/results/characterize.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "capture/base/file.h"
#include "capture/base/npy.h"
#include "capture/base/status.h"
#include "service/artifacts.h"
#include "service/result_json.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

using Parameters = google::protobuf::RepeatedPtrField<v1::Parameter>;
using optics::Quantity;

constexpr char kJsonFile[] = "sensor.json";
constexpr char kDefectsFile[] = "defects.npy";

void Add(Parameters& parameters, std::string_view name, const Quantity& quantity,
         std::string_view unit) {
  AddParameter(parameters, name, quantity.value, quantity.sigma, unit);
}

// Of a ratio, 20 log10.
Quantity Decibels(const Quantity& ratio) {
  return {20 * std::log10(ratio.value), 20 / std::log(10) * ratio.sigma / ratio.value};
}

void AddSensitivity(const optics::Emva1288Result& emva, Parameters& parameters) {
  Add(parameters, "K", emva.gain_dn_per_e, "DN/e");
  if (emva.quantum_efficiency) {
    Add(parameters, "R", emva.responsivity_dn, "DN/photon");
    Add(parameters, "eta", *emva.quantum_efficiency, "1");
  }
  Add(parameters, "mu_y.dark", emva.dark_mean_dn, "DN");
  Add(parameters, "sigma_y.dark", emva.dark_noise_dn, "DN");
  Add(parameters, "sigma_d", emva.dark_noise_e, "e");
  Add(parameters, "mu_e.min", emva.threshold_e, "e");
  if (emva.threshold_photons) Add(parameters, "mu_p.min", *emva.threshold_photons, "photon");
  Add(parameters, "mu_e.sat", emva.saturation_e, "e");
  if (emva.quantum_efficiency) {
    Add(parameters, "mu_p.sat", emva.saturation_irradiation, "photon");
  }
  if (emva.plateau_e) Add(parameters, "full_well", *emva.plateau_e, "e");
  Add(parameters, "SNR_max", emva.snr_max, "1");
  Add(parameters, "SNR_max_dB", Decibels(emva.snr_max), "dB");
  Add(parameters, "DR", emva.dynamic_range, "1");
  Add(parameters, "DR_dB", Decibels(emva.dynamic_range), "dB");
}

void AddRest(const optics::Emva1288Result& emva, Parameters& parameters) {
  Add(parameters, "DSNU1288", emva.dsnu_e, "e");
  Add(parameters, "PRNU1288", emva.prnu, "1");
  Add(parameters, "PRNU1288_unfiltered", emva.prnu_unfiltered, "1");
  if (emva.linearity) {
    const optics::LinearityError& error = *emva.linearity;
    AddParameter(parameters, "LE", error.mean_absolute, error.sigma, "1");
    AddParameter(parameters, "LE_min", error.minimum, error.sigma, "1");
    AddParameter(parameters, "LE_max", error.maximum, error.sigma, "1");
  }
  if (!emva.dark_current) return;
  const optics::DarkCurrent& current = *emva.dark_current;
  Add(parameters, "mu_I.mean", current.from_mean_e_s, "e/s");
  if (current.from_variance_e_s) Add(parameters, "mu_I.var", *current.from_variance_e_s, "e/s");
  if (current.per_kelvin_e_s_K) Add(parameters, "mu_I.slope", *current.per_kelvin_e_s_K, "e/s/K");
  if (current.temperature_degC) {
    AddParameter(parameters, "temperature", *current.temperature_degC, 0, "degC");
  }
}

void AddSteps(const optics::Emva1288Result& emva, v1::CharacterizeResult& result) {
  for (const optics::PhotonTransferStep& step : emva.steps) {
    v1::PhotonTransferStep& described = *result.add_steps();
    described.set_exposure_s(step.exposure_s);
    described.set_irradiation(step.irradiation);
    described.set_signal_dn(step.signal_dn);
    described.set_temporal_variance_dn2(step.variance_dn2);
    described.set_saturated_share(step.saturated_share);
    if (std::isfinite(step.linearity_deviation)) {
      described.set_linearity_deviation(step.linearity_deviation);
    }
  }
}

void AddLinearity(const optics::LinearityCurve& curve, v1::CharacterizeResult& result) {
  for (size_t k = 0; k < curve.knots_dn.size(); ++k) {
    v1::LinearityKnot& knot = *result.add_linearity();
    knot.set_measured_dn(curve.knots_dn[k]);
    knot.set_corrected_dn(curve.corrected_dn[k]);
    knot.set_sigma_dn(std::sqrt(curve.variance_dn2[k]));
  }
}

Image<float> AsFloat(const Image<uint8_t>& flags) {
  Image<float> map(flags.size());
  std::copy(flags.pixels().begin(), flags.pixels().end(), map.pixels().begin());
  return map;
}

absl::StatusOr<Quantity> Find(const v1::CharacterizeResult& result, std::string_view name,
                              const std::string& where) {
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() == name) return Quantity{parameter.value(), parameter.sigma()};
  }
  return BadInput(where, absl::StrCat("it has no parameter ", std::string(name)),
                  "write it anew with characterize --out");
}

absl::Status ReadLinearity(const v1::CharacterizeResult& result, const std::string& where,
                           optics::SensorCharacterisation& sensor) {
  if (result.linearity().empty()) return absl::OkStatus();
  optics::LinearityCurve curve;
  for (const v1::LinearityKnot& knot : result.linearity()) {
    const bool first = curve.knots_dn.empty();
    const bool rises = first ? knot.measured_dn() == 0 && knot.corrected_dn() == 0
                             : knot.measured_dn() > curve.knots_dn.back() &&
                                   knot.corrected_dn() > curve.corrected_dn.back();
    if (!rises || !std::isfinite(knot.corrected_dn()) || !std::isfinite(knot.sigma_dn())) {
      return BadInput(
          where,
          absl::StrCat("linearity: the knot at ", knot.measured_dn(), " DN does not rise from 0"),
          "write it anew with characterize --out");
    }
    curve.knots_dn.push_back(knot.measured_dn());
    curve.corrected_dn.push_back(knot.corrected_dn());
    curve.variance_dn2.push_back(knot.sigma_dn() * knot.sigma_dn());
  }
  if (curve.knots_dn.size() < 2) {
    return BadInput(where, "linearity: it has a single knot",
                    "write it anew with characterize --out");
  }
  curve.from_dn = curve.knots_dn[1];
  curve.to_dn = curve.knots_dn.back();
  sensor.linearity = curve;
  return absl::OkStatus();
}

absl::Status ReadDefects(const v1::CharacterizeResult& result, const std::filesystem::path& file,
                         optics::SensorCharacterisation& sensor) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, size_t{1} << 30));
  if (result.maps().empty() || Sha256(bytes) != result.maps(0).sha256()) {
    return Corrupt(file.string(), "it is not the file that belongs to sensor.json",
                   "write both anew with characterize --out");
  }
  EYEBOX_ASSIGN_OR_RETURN(const Image<float> map, ReadNpy(file));
  sensor.defects.defective = Image<uint8_t>(map.size());
  std::transform(map.pixels().begin(), map.pixels().end(),
                 sensor.defects.defective.pixels().begin(),
                 [](float flag) { return static_cast<uint8_t>(flag != 0 ? 1 : 0); });
  sensor.defects.hot_share = result.hot_share();
  sensor.defects.dead_share = result.dead_share();
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<v1::CharacterizeResult> DescribeSensor(const CharacterizedSensor& characterized,
                                                      const std::filesystem::path& folder) {
  const optics::SensorCharacterisation& sensor = characterized.sensor;
  v1::CharacterizeResult result;
  AddSensitivity(sensor.emva, *result.mutable_parameters());
  AddRest(sensor.emva, *result.mutable_parameters());
  result.set_release(sensor.emva.release);
  result.set_source(characterized.source);
  result.set_bits(characterized.bits);
  result.set_camera_model(sensor.identity.model);
  result.set_camera_serial(sensor.identity.serial);
  result.set_pixel_format(sensor.identity.pixel_format);
  result.set_gain_db(sensor.gain_db);
  result.set_region_left_px(characterized.region.left_px);
  result.set_region_top_px(characterized.region.top_px);
  result.set_region_width_px(characterized.region.size.width_px);
  result.set_region_height_px(characterized.region.size.height_px);
  result.set_saturation_reached(sensor.emva.saturation_reached);
  result.set_dark_noise_is_quantisation(sensor.emva.dark_noise_is_quantisation);
  result.set_irradiation_unit(characterized.irradiation_unit);
  AddSteps(sensor.emva, result);
  if (sensor.linearity) AddLinearity(*sensor.linearity, result);
  const auto defective = sensor.defects.defective.pixels();
  result.set_defective_pixels(
      static_cast<int32_t>(std::count(defective.begin(), defective.end(), uint8_t{1})));
  result.set_hot_share(sensor.defects.hot_share);
  result.set_dead_share(sensor.defects.dead_share);
  EYEBOX_ASSIGN_OR_RETURN(*result.add_maps(), WriteMap(folder, kDefectsFile, "defects", "1",
                                                       AsFloat(sensor.defects.defective)));
  AddAll(*result.mutable_warnings(), sensor.emva.warnings);
  if (folder.empty()) return result;
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(result));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(folder / kJsonFile, json));
  return result;
}

absl::StatusOr<optics::SensorCharacterisation> ReadSensor(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kJsonFile;
  v1::CharacterizeResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, result));
  optics::SensorCharacterisation sensor;
  sensor.identity = {result.camera_model(), result.camera_serial(), result.pixel_format(),
                     result.bits()};
  sensor.gain_db = result.gain_db();
  sensor.emva.saturation_reached = result.saturation_reached();
  sensor.emva.release = result.release();
  EYEBOX_ASSIGN_OR_RETURN(sensor.emva.gain_dn_per_e, Find(result, "K", file.string()));
  EYEBOX_ASSIGN_OR_RETURN(sensor.emva.dark_mean_dn, Find(result, "mu_y.dark", file.string()));
  EYEBOX_ASSIGN_OR_RETURN(sensor.emva.dark_noise_dn, Find(result, "sigma_y.dark", file.string()));
  EYEBOX_ASSIGN_OR_RETURN(sensor.emva.dark_noise_e, Find(result, "sigma_d", file.string()));
  EYEBOX_ASSIGN_OR_RETURN(sensor.emva.saturation_e, Find(result, "mu_e.sat", file.string()));
  if (!(sensor.emva.gain_dn_per_e.value > 0)) {
    return BadInput(file.string(), "K is not above 0", "write it anew with characterize --out");
  }
  EYEBOX_RETURN_IF_ERROR(ReadLinearity(result, file.string(), sensor));
  EYEBOX_RETURN_IF_ERROR(ReadDefects(result, folder / kDefectsFile, sensor));
  return sensor;
}

}  // namespace eyebox::service
