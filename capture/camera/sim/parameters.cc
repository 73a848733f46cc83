#include "capture/camera/sim/parameters.h"

#include <cmath>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

struct Range {
  std::string field;
  double value;
  double minimum;
  double maximum;
};

absl::Status CheckRanges(const std::vector<Range>& ranges) {
  for (const Range& range : ranges) {
    if (std::isfinite(range.value) && range.value >= range.minimum &&
        range.value <= range.maximum) {
      continue;
    }
    return BadInput("SimParameters." + range.field, "is " + std::to_string(range.value),
                    "give a value from " + std::to_string(range.minimum) + " to " +
                        std::to_string(range.maximum));
  }
  return absl::OkStatus();
}

absl::Status ValidateDisplay(const DisplayParameters& display) {
  double weight_sum = 0;
  for (const ChannelParameters& channel : display.channels) {
    weight_sum += channel.luminance_weight;
    EYEBOX_RETURN_IF_ERROR(CheckRanges({
        {"display.channels.luminance_weight", channel.luminance_weight, 0, 1},
        {"display.channels.gamma", channel.gamma, 0.3, 8},
        {"display.channels.cutoff_drive", channel.cutoff_drive, 0, 0.99},
    }));
  }
  return CheckRanges({
      {"display.channels.luminance_weight (sum)", weight_sum, 1 - 1e-9, 1 + 1e-9},
      {"display.minimum_luminance_cd_m2", display.minimum_luminance_cd_m2, 0, 1e5},
      {"display.luminance_range_cd_m2", display.luminance_range_cd_m2, 1e-9, 1e6},
  });
}

absl::Status ValidateOptics(const SimParameters& parameters) {
  const NonuniformityParameters& nonuniformity = parameters.nonuniformity;
  const ScatterParameters& scatter = parameters.scatter;
  return CheckRanges({
      {"nonuniformity.falloff", nonuniformity.falloff, 0, 5},
      {"nonuniformity.centre_s", nonuniformity.centre_s, -1, 1},
      {"nonuniformity.centre_t", nonuniformity.centre_t, -1, 1},
      {"nonuniformity.tilt_x", nonuniformity.tilt_x, -0.25, 0.25},
      {"nonuniformity.tilt_y", nonuniformity.tilt_y, -0.25, 0.25},
      {"nonuniformity.twist", nonuniformity.twist, -0.25, 0.25},
      {"scatter.core_sigma_px", scatter.core_sigma_px, 0, 100},
      {"scatter.tail_weight", scatter.tail_weight, 0, 0.9},
      {"scatter.tail_scale_px", scatter.tail_scale_px, 0.1, 1e4},
      {"scatter.tail_beta", scatter.tail_beta, 0.5, 10},
      {"scatter.tail_radius_px", static_cast<double>(scatter.tail_radius_px), 1, 4096},
      {"geometry.focal_length_px", parameters.geometry.focal_length_px, 1, 1e6},
      {"geometry.principal_x_px", parameters.geometry.principal_x_px, -1e5, 1e5},
      {"geometry.principal_y_px", parameters.geometry.principal_y_px, -1e5, 1e5},
  });
}

absl::Status ValidateSensor(const SensorParameters& sensor) {
  return CheckRanges({
      {"sensor.size.width_px", static_cast<double>(sensor.size.width_px), 1, 16384},
      {"sensor.size.height_px", static_cast<double>(sensor.size.height_px), 1, 16384},
      {"sensor.bits", static_cast<double>(sensor.bits), 8, 16},
      {"sensor.responsivity_e_s_per_cd_m2", sensor.responsivity_e_s_per_cd_m2, 1e-6, 1e12},
      {"sensor.photo_response_nonuniformity", sensor.photo_response_nonuniformity, 0, 0.1},
      {"sensor.gain_dn_per_e", sensor.gain_dn_per_e, 1e-6, 1e3},
      {"sensor.bias_dn", sensor.bias_dn, 0, 65535},
      {"sensor.read_noise_e", sensor.read_noise_e, 0, 1e6},
      {"sensor.offset_nonuniformity_e", sensor.offset_nonuniformity_e, 0, 1e6},
      {"sensor.dark_current_e_s", sensor.dark_current_e_s, 0, 1e6},
      {"sensor.dark_current_nonuniformity", sensor.dark_current_nonuniformity, 0, 1},
      {"sensor.hot_pixel_share", sensor.hot_pixel_share, 0, 0.5},
      {"sensor.hot_current_min_e_s", sensor.hot_current_min_e_s, 1e-3, 1e9},
      {"sensor.hot_current_max_e_s", sensor.hot_current_max_e_s, sensor.hot_current_min_e_s, 1e9},
      {"sensor.full_well_e", sensor.full_well_e, 1, 1e12},
      {"sensor.exposure_min_s", sensor.exposure_min_s, 1e-9, 1e3},
      {"sensor.exposure_max_s", sensor.exposure_max_s, sensor.exposure_min_s, 1e5},
      {"sensor.gain_max_db", sensor.gain_max_db, 0, 60},
  });
}

absl::Status ValidateFaults(const SimFaults& faults) {
  return CheckRanges({
      {"faults.gamma", faults.gamma, 0.1, 10},
      {"faults.stale_frames", static_cast<double>(faults.stale_frames), 0, 100},
      {"faults.strobe_period_s", faults.strobe_period_s, 0, 10},
      {"faults.strobe_duty", faults.strobe_duty, 1e-6, 1},
      {"faults.row_time_s", faults.row_time_s, 0, 1},
      {"faults.display_pixel_px", faults.display_pixel_px, 0, 1e4},
      {"faults.display_pixel_fill", faults.display_pixel_fill, 1e-6, 1},
      {"faults.stuck_gain_db", faults.stuck_gain_db, 0, 60},
      {"faults.warming_kelvin", faults.warming_kelvin, 0, 60},
  });
}

SimParameters RiftSLikeCutoff() {
  SimParameters parameters;
  parameters.name = "rift-s-like-cutoff";
  for (ChannelParameters& channel : parameters.display.channels) channel.cutoff_drive = 0.03;
  return parameters;
}

SimParameters Ideal() {
  SimParameters parameters;
  parameters.name = "ideal";
  parameters.nonuniformity = {
      .falloff = 0, .centre_s = 0, .centre_t = 0, .tilt_x = 0, .tilt_y = 0, .twist = 0};
  parameters.scatter.core_sigma_px = 0;
  parameters.scatter.tail_weight = 0;
  parameters.vignetting = false;
  SensorParameters& sensor = parameters.sensor;
  sensor.bits = 16;
  sensor.responsivity_e_s_per_cd_m2 = 2.03e7;
  sensor.photo_response_nonuniformity = 0;
  sensor.gain_dn_per_e = 0.003;
  sensor.bias_dn = 200;
  sensor.read_noise_e = 200;
  sensor.offset_nonuniformity_e = 0;
  sensor.dark_current_e_s = 0;
  sensor.dark_current_nonuniformity = 0;
  sensor.hot_pixel_share = 0;
  sensor.full_well_e = 2.2e7;
  return parameters;
}

}  // namespace

absl::Status SimParameters::Validate() const {
  EYEBOX_RETURN_IF_ERROR(ValidateDisplay(display));
  EYEBOX_RETURN_IF_ERROR(ValidateOptics(*this));
  EYEBOX_RETURN_IF_ERROR(ValidateFaults(faults));
  return ValidateSensor(sensor);
}

absl::StatusOr<SimParameters> NamedSimParameters(std::string_view name) {
  std::string known;
  for (const SimParameters& parameters : {SimParameters{}, RiftSLikeCutoff(), Ideal()}) {
    if (parameters.name == name) return parameters;
    known += " sim:" + parameters.name;
  }
  return BadInput("sim:" + std::string(name), "is not a simulated rig", "choose one of" + known);
}

std::vector<std::string> SimNames() { return {"rift-s-like", "rift-s-like-cutoff", "ideal"}; }

}  // namespace eyebox::capture
