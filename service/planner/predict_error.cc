#include "service/planner/predict_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"
#include "fit/activation/level_design.h"
#include "fit/base/relative_floor.h"
#include "fit/cube/design_table.h"
#include "fit/cube/goal.h"
#include "service/planner/measure_setting.h"

namespace eyebox::service {
namespace {

constexpr size_t kPlaces = 200;
constexpr double kCovered = 0.95;
constexpr int kBisections = 60;
constexpr double kPixelsPerMpx = 1e6;

double MeanSquare(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double Square(double x) { return x * x; }

double QuadraticForm(const std::vector<double>& matrix, const std::vector<double>& x) {
  double sum = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    for (size_t j = 0; j < x.size(); ++j) sum += x[i] * matrix[x.size() * i + j] * x[j];
  }
  return sum;
}

// P(|e| <= bound) of a normal e.
double Within(double bound, double mean, double sigma) {
  if (sigma == 0) return std::abs(mean) <= bound ? 1 : 0;
  const double scale = sigma * std::sqrt(2.0);
  return 0.5 * (std::erf((bound - mean) / scale) + std::erf((bound + mean) / scale));
}

// Of equally likely normal errors.
double BoundOf(const std::vector<std::pair<double, double>>& mean_and_sigma) {
  double low = 0;
  double high = 0;
  for (const auto& [mean, sigma] : mean_and_sigma) {
    high = std::max(high, std::abs(mean) + 3 * sigma);
  }
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    double within = 0;
    for (const auto& [mean, sigma] : mean_and_sigma) within += Within(middle, mean, sigma);
    (within < kCovered * static_cast<double>(mean_and_sigma.size()) ? low : high) = middle;
  }
  return high;
}

// What the errors of levels depend on.
std::vector<double> LevelKey(const Setting& setting) {
  std::vector<double> key = {static_cast<double>(setting.model),
                             static_cast<double>(setting.calibration_frames),
                             static_cast<double>(setting.table_size)};
  for (const LevelFrames& level : setting.levels) {
    key.push_back(level.drive);
    key.insert(key.end(), level.frames.begin(), level.frames.end());
  }
  for (const ShownFrames& thing : setting.shown) {
    key.insert(key.end(), thing.drive.begin(), thing.drive.end());
    key.insert(key.end(), thing.frames.begin(), thing.frames.end());
  }
  // With a map the readings relative to it count.
  if (!setting.shown.empty()) key.push_back(setting.tier == FieldTier::kNone ? 0 : 1);
  return key;
}

// What the errors of the field depend on.
std::vector<double> FieldKey(const Setting& setting) {
  std::vector<double> key = {
      static_cast<double>(setting.tier), static_cast<double>(setting.tier_size),
      static_cast<double>(setting.calibration_frames), setting.primaries ? 1.0 : 0.0};
  if (setting.tier == FieldTier::kNone) return key;
  const std::vector<int>& white = MapFrames(setting);
  key.insert(key.end(), white.begin(), white.end());
  if (setting.shown.empty()) return key;
  const DriveRgb drive = setting.levels.empty() ? setting.shown.back().drive : DriveRgb{1, 1, 1};
  key.insert(key.end(), drive.begin(), drive.end());
  return key;
}

}  // namespace

Predictor::Predictor(Pilot pilot, const Need& need, const Costs& costs)
    : pilot_(std::move(pilot)), need_(need), costs_(costs), u_(LooksAt(need)) {
  const std::vector<size_t> region = RegionPixels(pilot_.size, pilot_.geometry, need.radius_deg);
  const auto width = static_cast<size_t>(pilot_.size.width_px);
  const size_t step = std::max<size_t>(1, region.size() / kPlaces);
  for (size_t i = 0; i < region.size(); i += step) {
    const double response = pilot_.response.pixels()[region[i]];
    if (!std::isfinite(response)) continue;
    const auto x = static_cast<double>(region[i] % width);
    const auto y = static_cast<double>(region[i] / width);
    places_.push_back({x, y, response, pilot_.white_smooth.At(x, y)});
  }
}

absl::StatusOr<Predictor> Predictor::Make(Pilot pilot, const Need& need, const Costs& costs) {
  Predictor predictor(std::move(pilot), need, costs);
  predictor.costs_.compute_s_per_mpx = predictor.pilot_.compute_s_per_mpx;
  if (!predictor.places_.empty()) return predictor;
  return Rejected("region of the scene", "no pixel of it has a value",
                  "choose a wider one, or check where the camera looks");
}

absl::StatusOr<fit::ActivationFit> Predictor::FitOf(const Setting& setting,
                                                    const fit::ActivationFit& pilot) const {
  const fit::Activation& display = pilot.activation;
  fit::ActivationProblem problem;
  problem.model = setting.model;
  for (const LevelFrames& level : setting.levels) {
    const double luminance = display.Luminance(level.drive);
    const double variance = LuminanceVariance(pilot_, luminance, pilot_.response_at_reference,
                                              level.frames, setting.calibration_frames);
    const double sigma = std::sqrt(variance / static_cast<double>(pilot_.reference_pixels));
    if (!std::isfinite(sigma)) {
      return Rejected(setting.name, "a level saturates or vanishes in every exposure it has",
                      "give it another exposure");
    }
    problem.readings.push_back({level.drive, luminance, 1 / sigma});
  }
  fit::ActivationSolution solution{display, display, 0, ""};
  if (setting.model != pilot.model) {
    EYEBOX_ASSIGN_OR_RETURN(
        solution, fit::SolveModel(problem, fit::StartingPoints(problem),
                                  fit::kRelativeFloor * problem.readings.back().luminance));
  }
  fit::ActivationFit fit;
  fit.model = setting.model;
  fit.activation = solution.activation;
  EYEBOX_ASSIGN_OR_RETURN(fit.covariance, fit::ActivationCovariance(problem, solution));
  EYEBOX_ASSIGN_OR_RETURN(fit.response, fit::ActivationResponse(problem, solution));
  return fit;
}

absl::StatusOr<std::vector<double>> Predictor::TableErrors(int size) {
  const auto known = tables_.find(size);
  if (known != tables_.end()) return known->second;
  const fit::Activation& display = pilot_.activation.activation;
  EYEBOX_ASSIGN_OR_RETURN(
      const fit::TableDesign table,
      fit::DesignTable(display, fit::TableTarget::kHdrp, size, {.u_from = need_.u_from}));
  std::vector<double> errors;
  for (const double u : u_) {
    errors.push_back(fit::RelativeError(display, fit::DriveThroughTable(table, u), u));
  }
  return tables_.emplace(size, std::move(errors)).first->second;
}

absl::StatusOr<Predictor::LevelErrors> Predictor::OfPrimaries(const Setting& setting) const {
  if (pilot_.primaries.empty()) {
    return Rejected("pilot", "it did not measure red, green and blue", "measure them too");
  }
  std::vector<fit::ActivationFit> fits;
  for (const fit::ActivationFit& primary : pilot_.primaries) {
    EYEBOX_ASSIGN_OR_RETURN(fits.emplace_back(), FitOf(setting, primary));
  }
  const auto count = static_cast<double>(fits.size());
  LevelErrors errors;
  for (const DriveRgb& u : need_.colours) {
    DriveRgb drive;
    double variance = 0;
    for (size_t c = 0; c < fits.size(); ++c) {
      const fit::Activation& a = fits[c].activation;
      drive[c] = std::min(fit::DriveForLuminance(a, u[c] * a.Luminance(1)), 1.0);
      std::vector<double> gradient = fit::ParameterGradient(fits[c].model, a, drive[c]);
      gradient[0] -= (count - 1) / count;  // black counts once
      variance += QuadraticForm(fits[c].covariance, gradient);
    }
    const double stated = StatedLuminance(fits, drive);
    errors.model.push_back(StatedLuminance(pilot_.primaries, drive) / stated - 1);
    errors.variance.push_back(variance / Square(stated));
  }
  errors.bias = errors.model;
  errors.departure = errors.variance;
  return errors;
}

std::vector<double> Predictor::WithWhite(const fit::ActivationFit& fit, fit::ErrorAtU error,
                                         const Setting& setting) const {
  const size_t readings = setting.levels.size();
  const double white = pilot_.activation.activation.Luminance(1);
  const double variance = ReadingVariance(setting.levels.back().frames, setting);
  std::vector<double> covariances;
  for (const double u : u_) {
    const std::vector<double> gradient = fit::ErrorGradient(fit, error, u);
    double by_white = 0;  // d(error) / d(relative error of the reading of white)
    for (size_t i = 0; i < gradient.size(); ++i) {
      by_white += gradient[i] * fit.response[readings * i + readings - 1] * white;
    }
    covariances.push_back(by_white * variance);
  }
  return covariances;
}

absl::StatusOr<Predictor::LevelErrors> Predictor::OfShown(const Setting& setting) const {
  const double white = LuminanceOf(pilot_, {1, 1, 1});
  const bool own_map = setting.tier != FieldTier::kNone && setting.levels.empty();
  LevelErrors errors;
  for (const ShownFrames& thing : setting.shown) {
    const double level = LuminanceOf(pilot_, thing.drive) / white;
    errors.variance.push_back(ReadingVariance(thing.frames, setting, level));
  }
  const double brightest = errors.variance.back();
  double sum = *std::ranges::max_element(errors.variance);
  if (!setting.levels.empty()) sum += ReadingVariance(MapFrames(setting), setting);
  if (!std::isfinite(sum)) {
    return Rejected(setting.name, "something shown saturates or vanishes in every exposure it has",
                    "give it another exposure");
  }
  if (own_map) {
    // The map is of the brightest, whose reading cancels.
    for (double& variance : errors.variance) variance += brightest;
    errors.variance.back() = 0;
  }
  errors.departure = errors.variance;
  errors.model.assign(errors.variance.size(), 0);
  errors.bias = errors.model;
  return errors;
}

absl::StatusOr<Predictor::LevelErrors> Predictor::OfLevels(const Setting& setting) {
  if (!setting.shown.empty()) return OfShown(setting);
  if (!need_.colours.empty()) return OfPrimaries(setting);
  EYEBOX_ASSIGN_OR_RETURN(const fit::ActivationFit fit, FitOf(setting, pilot_.activation));
  LevelErrors errors;
  EYEBOX_ASSIGN_OR_RETURN(errors.bias, TableErrors(setting.table_size));
  const fit::Activation& display = pilot_.activation.activation;
  const double white = fit.activation.Luminance(1);
  for (size_t i = 0; i < u_.size(); ++i) {
    const double drive = fit::DriveForLuminance(fit.activation, u_[i] * white);
    errors.model.push_back(display.Luminance(drive) / (u_[i] * white) - 1);
    errors.bias[i] += errors.model[i];
  }
  errors.variance_with_white = WithWhite(fit, fit::ErrorAtU::kLuminance, setting);
  errors.departure_with_white = WithWhite(fit, fit::ErrorAtU::kDeparture, setting);
  errors.variance = fit::ErrorVariances(fit, fit::ErrorAtU::kLuminance, u_);
  errors.departure = fit::ErrorVariances(fit, fit::ErrorAtU::kDeparture, u_);
  return errors;
}

absl::StatusOr<Predictor::Parts> Predictor::PartsOf(const Setting& setting) {
  Parts parts;
  const std::vector<double> level_key = LevelKey(setting);
  auto levels = levels_.find(level_key);
  if (levels == levels_.end()) {
    EYEBOX_ASSIGN_OR_RETURN(LevelErrors errors, OfLevels(setting));
    levels = levels_.emplace(level_key, std::move(errors)).first;
  }
  const std::vector<double> field_key = FieldKey(setting);
  auto field = fields_.find(field_key);
  if (field == fields_.end()) {
    EYEBOX_ASSIGN_OR_RETURN(FieldErrors errors, OfField(setting));
    field = fields_.emplace(field_key, std::move(errors)).first;
  }
  parts.levels = &levels->second;
  parts.field = &field->second;
  parts.glare = OfGlare(setting);
  parts.level_variance = LevelVariance(setting, *parts.levels);
  return parts;
}

std::vector<double> Predictor::LevelVariance(const Setting& setting,
                                             const LevelErrors& levels) const {
  const bool no_map = setting.tier == FieldTier::kNone;
  std::vector<double> variance = no_map || setting.primaries ? levels.variance : levels.departure;
  if (!setting.shown.empty()) return variance;
  if (need_.disk_deg == 0 || setting.disk_frames == 0) return variance;
  // The disk's reading is divided by that of white, which has a part in the levels, or in the map.
  for (size_t i = 0; i < variance.size(); ++i) {
    if (setting.primaries) {
      variance[i] += no_map ? 0 : 2 * ReadingVariance(setting.levels.back().frames, setting);
    } else {
      variance[i] += 2 * (no_map ? levels.variance_with_white : levels.departure_with_white)[i];
    }
  }
  return variance;
}

std::vector<std::pair<double, double>> Predictor::ErrorsOf(const Parts& parts) const {
  std::vector<std::pair<double, double>> errors;
  errors.reserve(places_.size() * parts.levels->bias.size());
  for (size_t p = 0; p < places_.size(); ++p) {
    for (size_t i = 0; i < parts.levels->bias.size(); ++i) {
      const double mean =
          (1 + parts.levels->bias[i]) * (1 + parts.field->bias[p]) * (1 + parts.glare.bias) - 1;
      const double variance =
          parts.level_variance[i] + parts.field->variance[p] + parts.glare.variance;
      errors.emplace_back(mean, std::sqrt(variance));
    }
  }
  return errors;
}

absl::StatusOr<double> Predictor::PredictRms(const Setting& setting) {
  EYEBOX_ASSIGN_OR_RETURN(const Parts parts, PartsOf(setting));
  // The mean square of (1 + a) (1 + b) (1 + c) - 1, whose factors do not depend on each other.
  const double glare = 1 + parts.glare.bias;
  const double mean = (1 + Mean(parts.levels->bias)) * (1 + Mean(parts.field->bias)) * glare;
  const double square = (1 + 2 * Mean(parts.levels->bias) + MeanSquare(parts.levels->bias)) *
                        (1 + 2 * Mean(parts.field->bias) + MeanSquare(parts.field->bias)) *
                        Square(glare);
  return std::sqrt(std::max(square - 2 * mean + 1, 0.0) + Mean(parts.level_variance) +
                   Mean(parts.field->variance) + parts.glare.variance);
}

absl::StatusOr<double> Predictor::ShareWithin(const Setting& setting, double tolerance) {
  EYEBOX_ASSIGN_OR_RETURN(const Parts parts, PartsOf(setting));
  const auto errors = ErrorsOf(parts);
  double within = 0;
  for (const auto& [mean, sigma] : errors) within += Within(tolerance, mean, sigma);
  return within / static_cast<double>(errors.size());
}

absl::StatusOr<Prediction> Predictor::Predict(const Setting& setting) {
  EYEBOX_ASSIGN_OR_RETURN(const Parts parts, PartsOf(setting));
  Prediction prediction;
  EYEBOX_ASSIGN_OR_RETURN(prediction.rms, PredictRms(setting));
  prediction.bound_95 = BoundOf(ErrorsOf(parts));
  prediction.level_noise = std::sqrt(Mean(parts.level_variance));
  prediction.level_bias = std::sqrt(MeanSquare(parts.levels->bias));
  prediction.field_noise = std::sqrt(Mean(parts.field->variance));
  prediction.field_bias = std::sqrt(MeanSquare(parts.field->bias));
  prediction.glare_noise = std::sqrt(parts.glare.variance);
  prediction.glare_bias = parts.glare.bias;
  prediction.departure_rms =
      std::sqrt(Mean(parts.levels->departure) + MeanSquare(parts.levels->model));
  prediction.capture_s = CaptureSeconds(setting, pilot_.exposures_s, costs_);
  prediction.compute_s = costs_.compute_s_per_mpx * FrameCount(setting) *
                         static_cast<double>(pilot_.size.PixelCount()) / kPixelsPerMpx;
  return prediction;
}

}  // namespace eyebox::service
