#include "capture/camera/sim/truth.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "capture/base/file.h"
#include "capture/base/npy.h"
#include "capture/base/status.h"
#include "capture/camera/sim/display.h"
#include "capture/camera/sim/sim_rig.h"

namespace eyebox::capture {
namespace {

std::string Number(double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return std::string(digits.data(), end);
}

// Appends `"name": value` members, one a line, in the order of the calls.
class JsonObject {
 public:
  explicit JsonObject(std::string indent) : indent_(std::move(indent)) {}

  void Add(std::string_view name, std::string_view raw_value) {
    text_.append(text_.empty() ? "{\n" : ",\n").append(indent_).append("  \"");
    text_.append(name).append("\": ").append(raw_value);
  }
  void Add(std::string_view name, double value) { Add(name, std::string_view(Number(value))); }
  std::string Text() const { return text_ + "\n" + indent_ + "}"; }

 private:
  std::string indent_;
  std::string text_;
};

std::string ChannelsJson(const std::array<ChannelParameters, 3>& channels) {
  std::string text = "[";
  for (const ChannelParameters& channel : channels) {
    JsonObject object("    ");
    object.Add("luminance_weight", channel.luminance_weight);
    object.Add("gamma", channel.gamma);
    object.Add("cutoff_drive", channel.cutoff_drive);
    text.append(text == "[" ? "\n    " : ",\n    ").append(object.Text());
  }
  return text + "\n  ]";
}

void AddDisplay(const DisplayParameters& display, JsonObject& json) {
  json.Add("minimum_luminance_cd_m2", display.minimum_luminance_cd_m2);
  json.Add("luminance_range_cd_m2", display.luminance_range_cd_m2);
  const ChannelParameters& first = display.channels[0];
  const auto& channels = display.channels;
  if (std::ranges::all_of(channels, [&](auto& c) { return c.gamma == first.gamma; })) {
    json.Add("gamma", first.gamma);
  }
  if (std::ranges::all_of(channels,
                          [&](auto& c) { return c.cutoff_drive == first.cutoff_drive; })) {
    json.Add("cutoff_drive", first.cutoff_drive);
  }
  json.Add("channels", ChannelsJson(channels));
}

std::string NonuniformityJson(const NonuniformityParameters& nonuniformity) {
  JsonObject json("  ");
  json.Add("map", "\"truth_g.npy\"");
  json.Add("falloff", nonuniformity.falloff);
  json.Add("centre_s", nonuniformity.centre_s);
  json.Add("centre_t", nonuniformity.centre_t);
  json.Add("tilt_x", nonuniformity.tilt_x);
  json.Add("tilt_y", nonuniformity.tilt_y);
  json.Add("twist", nonuniformity.twist);
  return json.Text();
}

std::string ScatterJson(const ScatterParameters& scatter) {
  JsonObject json("  ");
  json.Add("core_sigma_px", scatter.core_sigma_px);
  json.Add("tail_weight", scatter.tail_weight);
  json.Add("tail_scale_px", scatter.tail_scale_px);
  json.Add("tail_beta", scatter.tail_beta);
  json.Add("tail_radius_px", scatter.tail_radius_px);
  return json.Text();
}

std::string GeometryJson(const SimParameters& parameters) {
  JsonObject json("  ");
  json.Add("focal_length_px", parameters.geometry.focal_length_px);
  json.Add("principal_x_px", parameters.geometry.principal_x_px);
  json.Add("principal_y_px", parameters.geometry.principal_y_px);
  json.Add("vignetting", parameters.vignetting ? "\"cos^4\"" : "\"none\"");
  return json.Text();
}

std::string SensorJson(const SensorParameters& sensor) {
  JsonObject json("  ");
  json.Add("width_px", sensor.size.width_px);
  json.Add("height_px", sensor.size.height_px);
  json.Add("bits", sensor.bits);
  json.Add("responsivity_e_s_per_cd_m2", sensor.responsivity_e_s_per_cd_m2);
  json.Add("photo_response_nonuniformity", sensor.photo_response_nonuniformity);
  json.Add("gain_dn_per_e", sensor.gain_dn_per_e);
  json.Add("bias_dn", sensor.bias_dn);
  json.Add("read_noise_e", sensor.read_noise_e);
  json.Add("offset_nonuniformity_e", sensor.offset_nonuniformity_e);
  json.Add("dark_current_e_s", sensor.dark_current_e_s);
  json.Add("dark_current_nonuniformity", sensor.dark_current_nonuniformity);
  json.Add("hot_pixel_share", sensor.hot_pixel_share);
  json.Add("hot_current_min_e_s", sensor.hot_current_min_e_s);
  json.Add("hot_current_max_e_s", sensor.hot_current_max_e_s);
  json.Add("full_well_e", sensor.full_well_e);
  return json.Text();
}

}  // namespace

SimTruth MakeSimTruth(const SimParameters& parameters, uint64_t seed) {
  const Image<double> g = Nonuniformity(parameters.nonuniformity, parameters.sensor.size);
  SimTruth truth{.parameters = parameters, .seed = seed, .g = Image<float>(g.size())};
  std::ranges::transform(g.pixels(), truth.g.pixels().begin(),
                         [](double value) { return static_cast<float>(value); });
  return truth;
}

std::string SimTruthJson(const SimTruth& truth) {
  const SimParameters& parameters = truth.parameters;
  JsonObject json("");
  json.Add("simulated", "true");
  json.Add("name", "\"" + parameters.name + "\"");
  json.Add("seed", std::to_string(truth.seed));
  AddDisplay(parameters.display, json);
  json.Add("nonuniformity", NonuniformityJson(parameters.nonuniformity));
  json.Add("scatter", ScatterJson(parameters.scatter));
  json.Add("geometry", GeometryJson(parameters));
  json.Add("sensor", SensorJson(parameters.sensor));
  return json.Text() + "\n";
}

absl::Status WriteSimTruth(const std::filesystem::path& folder, const SimTruth& truth) {
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(folder / "truth_g.npy", EncodeNpy(truth.g)));
  return WriteFileAtomically(folder / "truth.json", SimTruthJson(truth));
}

absl::Status WriteSimTruth(const std::filesystem::path& folder, const RigConfig& config) {
  EYEBOX_ASSIGN_OR_RETURN(const SimParameters parameters, SimParametersOf(config));
  return WriteSimTruth(folder, MakeSimTruth(parameters, config.seed));
}

}  // namespace eyebox::capture
