// What the sensor, the map of the field and glare add to the errors of a setting.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "capture/base/status.h"
#include "service/planner/measure_setting.h"
#include "service/planner/predict_error.h"

namespace eyebox::service {
namespace {

constexpr double kRailSigmas = 3;  // as ReduceOptions has it

double Square(double x) { return x * x; }

}  // namespace

double LuminanceVariance(const Pilot& pilot, double luminance, double response,
                         const std::vector<int>& frames, int dark_frames) {
  double weights = 0;
  for (size_t k = 0; k < frames.size(); ++k) {
    if (frames[k] == 0) continue;
    const double exposure_s = pilot.exposures_s[k];
    const double excess = luminance * response * exposure_s + pilot.dark_dn[k];
    const double guard = kRailSigmas * std::sqrt(pilot.noise.MeanVariance(excess, 1));
    const double count = pilot.noise.bias_dn + excess;
    if (count + guard >= pilot.saturation_dn || count - guard <= 0) continue;
    const double variance = pilot.noise.MeanVariance(excess, frames[k]) +
                            pilot.noise.MeanVariance(pilot.dark_dn[k], dark_frames);
    weights += Square(response * exposure_s) / variance;
  }
  return weights > 0 ? 1 / weights : std::numeric_limits<double>::infinity();
}

double LuminanceOf(const Pilot& pilot, const DriveRgb& drive) {
  if (drive[0] == drive[1] && drive[1] == drive[2]) {
    return pilot.activation.activation.Luminance(drive[0]);
  }
  return StatedLuminance(pilot.primaries, drive);
}

double Predictor::MapLevel(const Setting& setting) const {
  if (!setting.levels.empty()) return 1;
  return LuminanceOf(pilot_, setting.shown.back().drive) / LuminanceOf(pilot_, {1, 1, 1});
}

double Predictor::FlatVariance(double response, int frames) const {
  const std::vector<int> all(pilot_.exposures_s.size(), frames);
  return LuminanceVariance(pilot_, pilot_.flat_luminance, response, all, frames) /
         Square(pilot_.flat_luminance);
}

absl::StatusOr<const optics::SmoothField*> Predictor::SmoothOf(int order) {
  const auto known = smooth_.find(order);
  if (known != smooth_.end()) return &known->second;
  EYEBOX_ASSIGN_OR_RETURN(
      optics::SmoothField smooth,
      optics::FitSmoothField(pilot_.white, optics::FieldModel::kPolynomial, order));
  return &smooth_.emplace(order, std::move(smooth)).first->second;
}

std::vector<double> Predictor::BlockBias(int side_px) const {
  std::vector<double> bias;
  for (const Place& place : places_) {
    const int left = static_cast<int>(place.x_px) / side_px * side_px;
    const int top = static_cast<int>(place.y_px) / side_px * side_px;
    double sum = 0;
    int count = 0;
    for (int y = top; y < std::min(top + side_px, pilot_.size.height_px); ++y) {
      for (int x = left; x < std::min(left + side_px, pilot_.size.width_px); ++x) {
        sum += pilot_.white_smooth.At(x, y);
        ++count;
      }
    }
    bias.push_back(place.white * count / sum - 1);
  }
  return bias;
}

absl::StatusOr<Predictor::FieldErrors> Predictor::OfField(const Setting& setting) {
  FieldErrors errors;
  if (setting.tier == FieldTier::kNone) {
    const double reference = pilot_.activation.activation.Luminance(1);
    const double flat = FlatVariance(pilot_.response_at_reference, setting.calibration_frames) /
                        static_cast<double>(pilot_.reference_pixels);
    for (const Place& place : places_) errors.bias.push_back(place.white / reference - 1);
    errors.variance.assign(places_.size(), flat);
    return errors;
  }
  const optics::SmoothField* smooth = nullptr;
  if (setting.tier == FieldTier::kSmooth) {
    EYEBOX_ASSIGN_OR_RETURN(smooth, SmoothOf(setting.tier_size));
  } else if (!blocks_.contains(setting.tier_size)) {
    blocks_[setting.tier_size] = BlockBias(setting.tier_size);
  }
  const std::vector<int> pilot_frames(pilot_.exposures_s.size(), pilot_.frames);
  // Grey levels are taken relative to white, which the map holds; colours and readings to its
  // reading.
  const bool by_reading = setting.primaries || (!setting.shown.empty() && !setting.levels.empty());
  const double reference = by_reading ? ReadingVariance(MapFrames(setting), setting) : 0;
  const double level = MapLevel(setting);
  for (size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    const auto of_pixel = [&](double at, const std::vector<int>& frames, int calibration_frames) {
      return LuminanceVariance(pilot_, at, place.response, frames, calibration_frames) /
                 Square(at) +
             FlatVariance(place.response, calibration_frames);
    };
    const double variance =
        of_pixel(level * place.white, MapFrames(setting), setting.calibration_frames);
    if (smooth == nullptr) {
      errors.bias.push_back(blocks_[setting.tier_size][i]);
      errors.variance.push_back(variance / Square(setting.tier_size) + reference);
      continue;
    }
    const double value = smooth->At(place.x_px, place.y_px);
    const double sigma = smooth->SigmaAt(place.x_px, place.y_px) / value;
    errors.bias.push_back(place.white / value - 1);
    errors.variance.push_back(Square(sigma) / std::max(smooth->reduced_chi2, 1.0) * variance /
                                  of_pixel(place.white, pilot_frames, pilot_.calibration_frames) +
                              reference);
  }
  return errors;
}

double Predictor::ReadingVariance(const std::vector<int>& frames, const Setting& setting,
                                  double level) const {
  const double luminance = level * pilot_.activation.activation.Luminance(1);
  return LuminanceVariance(pilot_, luminance, pilot_.response_at_reference, frames,
                           setting.calibration_frames) /
         (Square(luminance) * static_cast<double>(pilot_.reference_pixels));
}

Predictor::GlareErrors Predictor::OfGlare(const Setting& setting) const {
  if (need_.disk_deg == 0 || !setting.shown.empty()) return {};  // readings hold it
  if (setting.disk_frames == 0) return {GlareFactorOf(pilot_, need_.disk_deg) - 1, 0};
  return {0, ReadingVariance(setting.levels.back().frames, setting) +
                 ReadingVariance(DiskFrames(setting), setting)};
}

}  // namespace eyebox::service
