// What a setting will cost and what error it will leave, from the pilot of a rig.
#ifndef EYEBOX_SERVICE_PLANNER_PREDICT_ERROR_H_
#define EYEBOX_SERVICE_PLANNER_PREDICT_ERROR_H_

#include <map>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/level_design.h"
#include "service/planner/pilot.h"
#include "service/planner/setting.h"

namespace eyebox::service {

// Relative errors of the luminance that a scene shows at places and levels of its region, see
// ErrorsOf(). The parts are rms over places and levels.
struct Prediction {
  double rms = 0;          // of the whole
  double bound_95 = 0;     // 95 % of errors lie within +- this
  double level_noise = 0;  // from the frames of the levels
  double level_bias = 0;   // of model and table
  double field_noise = 0;  // from the frames of the white field and the flat
  double field_bias = 0;   // of what the tier cannot follow
  double glare_noise = 0;
  double glare_bias = 0;     // where glare is left in
  double departure_rms = 0;  // see DeparturesOf: levels and model alone
  double capture_s = 0;
  double compute_s = 0;  // of reduction, which is most of it
};

// Variance of a luminance that exposures of `frames` give at a place with this response (DN/s of
// 1 cd/m2), of the sensor alone: photons, read-out, quantisation and the darks. Infinite where
// every exposure saturates or vanishes.
double LuminanceVariance(const Pilot& pilot, double luminance, double response,
                         const std::vector<int>& frames, int dark_frames);

// Luminance at the reference point, as the pilot has it. Colours ask for its primaries.
double LuminanceOf(const Pilot& pilot, const DriveRgb& drive);

class Predictor {
 public:
  // Errors: FailedPrecondition (no pixel of the region has a value).
  static absl::StatusOr<Predictor> Make(Pilot pilot, const Need& need, const Costs& costs);

  const Pilot& pilot() const { return pilot_; }
  const Need& need() const { return need_; }
  const Costs& costs() const { return costs_; }

  // Errors: FailedPrecondition (levels that saturate every exposure, that do not determine the
  // model); those of DesignTable and of FitSmoothField.
  absl::StatusOr<Prediction> Predict(const Setting& setting);
  // Its rms alone. Quick: what settings have in common is computed once.
  absl::StatusOr<double> PredictRms(const Setting& setting);
  // The share of errors within +- `tolerance`.
  absl::StatusOr<double> ShareWithin(const Setting& setting, double tolerance);

 private:
  struct Place {
    double x_px = 0;
    double y_px = 0;
    double response = 0;
    double white = 0;  // luminance
  };
  struct LevelErrors {
    // Of every thing looked at: [u], or [colours].
    std::vector<double> model;      // bias of the model
    std::vector<double> bias;       // of model and table
    std::vector<double> variance;   // of the luminance
    std::vector<double> departure;  // variance of the luminance over that of white
    // Covariance of either with the relative error of the reading of white.
    std::vector<double> variance_with_white;
    std::vector<double> departure_with_white;
  };
  struct FieldErrors {
    std::vector<double> bias;      // [places], true over stated luminance - 1
    std::vector<double> variance;  // [places]
  };

  struct GlareErrors {
    double bias = 0;
    double variance = 0;
  };

  Predictor(Pilot pilot, const Need& need, const Costs& costs);
  // Of a display that answers like `pilot`.
  absl::StatusOr<fit::ActivationFit> FitOf(const Setting& setting,
                                           const fit::ActivationFit& pilot) const;
  absl::StatusOr<std::vector<double>> TableErrors(int size);
  struct Parts {
    const LevelErrors* levels = nullptr;
    const FieldErrors* field = nullptr;
    GlareErrors glare;
    std::vector<double> level_variance;  // the one that counts, with what it shares with the glare
  };

  absl::StatusOr<Parts> PartsOf(const Setting& setting);
  std::vector<double> LevelVariance(const Setting& setting, const LevelErrors& levels) const;
  // Covariance, [u], of the error with the relative one of the reading of white.
  std::vector<double> WithWhite(const fit::ActivationFit& fit, fit::ErrorAtU error,
                                const Setting& setting) const;
  absl::StatusOr<LevelErrors> OfLevels(const Setting& setting);
  absl::StatusOr<LevelErrors> OfPrimaries(const Setting& setting) const;
  absl::StatusOr<LevelErrors> OfShown(const Setting& setting) const;
  double FlatVariance(double response, int frames) const;
  // Luminance of the image that the map is made of, over that of white.
  double MapLevel(const Setting& setting) const;
  absl::StatusOr<const optics::SmoothField*> SmoothOf(int order);
  std::vector<double> BlockBias(int side_px) const;
  absl::StatusOr<FieldErrors> OfField(const Setting& setting);
  // Relative, of a reading at the reference point of `level` of white.
  double ReadingVariance(const std::vector<int>& frames, const Setting& setting,
                         double level = 1) const;
  GlareErrors OfGlare(const Setting& setting) const;
  // Mean and sigma of the error at every place of every thing looked at.
  std::vector<std::pair<double, double>> ErrorsOf(const Parts& parts) const;

  Pilot pilot_;
  Need need_;
  Costs costs_;
  std::vector<double> u_;
  std::vector<Place> places_;
  std::map<int, std::vector<double>> tables_;
  std::map<int, optics::SmoothField> smooth_;
  std::map<int, std::vector<double>> blocks_;
  std::map<std::vector<double>, LevelErrors> levels_;
  std::map<std::vector<double>, FieldErrors> fields_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_PREDICT_ERROR_H_
