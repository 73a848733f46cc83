#include "service/planner/explain_plan.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/field/common_exponent.h"

namespace eyebox::service {
namespace {

constexpr double kPercent = 100;

class Explainer {
 public:
  Explainer(Predictor& predictor, const Planned& planned, const SceneNeed& scene, double tolerance,
            v1::MeasurementPlan& plan)
      : predictor_(predictor),
        planned_(planned),
        scene_(scene),
        tolerance_(tolerance),
        plan_(plan) {}

  absl::Status All() {
    Colour();
    EYEBOX_RETURN_IF_ERROR(Field());
    EYEBOX_RETURN_IF_ERROR(Scatter());
    Levels();
    Calibration();
    Table();
    Precision();
    return absl::OkStatus();
  }

 private:
  void Add(const char* about, std::string choice, std::string reason, bool left_out = false) {
    v1::PlanDecision& decision = *plan_.add_decisions();
    decision.set_about(about);
    decision.set_choice(std::move(choice));
    decision.set_reason(std::move(reason));
    decision.set_left_out(left_out);
  }

  // rms in percent that `change` of the setting would leave.
  template <typename Change>
  absl::StatusOr<double> PercentWith(const Change& change) {
    Setting changed = planned_.setting;
    change(changed);
    EYEBOX_ASSIGN_OR_RETURN(const double rms, predictor_.PredictRms(changed));
    return kPercent * rms;
  }

  void Colour() {
    if (!scene_.need.colours.empty() && !planned_.setting.primaries) {
      return Add("colour", "the scene's own colours",
                 "they do not vary, so red, green and blue need not be measured by themselves");
    }
    if (planned_.setting.primaries) {
      return Add("colour", "red, green, blue and white",
                 absl::StrFormat("%d of the scene's patches are looked at in colour",
                                 scene_.need.colours.size()));
    }
    Add("colour", "grey alone", "nothing in the scene has a colour", true);
  }

  absl::Status Field() {
    const Setting& setting = planned_.setting;
    EYEBOX_ASSIGN_OR_RETURN(const double without,
                            PercentWith([](Setting& s) { s.tier = FieldTier::kNone; }));
    const std::string region =
        scene_.anywhere ? "the whole field"
                        : absl::StrFormat("the central %.3g deg", scene_.need.radius_deg);
    if (setting.tier == FieldTier::kNone) {
      Add("field", "no map", absl::StrFormat("over %s that leaves %.3g %% in all", region, without),
          true);
      return absl::OkStatus();
    }
    const std::string choice = setting.tier == FieldTier::kSmooth
                                   ? absl::StrFormat("a polynomial of order %d", setting.tier_size)
                                   : absl::StrFormat("a map of blocks of %d x %d px",
                                                     setting.tier_size, setting.tier_size);
    Add("field", choice,
        absl::StrFormat("%s is used; without a map %.3g %% would be left, with it %.3g %% of bias "
                        "and %.3g %% of noise",
                        region, without, kPercent * planned_.prediction.field_bias,
                        kPercent * planned_.prediction.field_noise));
    return absl::OkStatus();
  }

  absl::Status Scatter() {
    if (scene_.need.disk_deg == 0) {
      Add("scatter", "no disk", "nothing stands on black", true);
      return absl::OkStatus();
    }
    if (!planned_.setting.shown.empty()) {
      Add("scatter", absl::StrFormat("read at its own size, %.3g deg", scene_.need.disk_deg),
          "what is read so has the glare of what is looked at");
      return absl::OkStatus();
    }
    EYEBOX_ASSIGN_OR_RETURN(const double without,
                            PercentWith([](Setting& s) { s.disk_frames = 0; }));
    const double factor = GlareFactorOf(predictor_.pilot(), scene_.need.disk_deg);
    const std::string loss = absl::StrFormat("%.3g deg on black show %.3g %% of a full field",
                                             scene_.need.disk_deg, kPercent * factor);
    if (planned_.setting.disk_frames == 0) {
      Add("scatter", "left in", absl::StrFormat("%s; in all %.3g %% are left", loss, without),
          true);
      return absl::OkStatus();
    }
    Add("scatter", absl::StrFormat("a disk of that size, %d frames", planned_.setting.disk_frames),
        absl::StrFormat("%s; left in, %.3g %% would be left in all", loss, without));
    return absl::OkStatus();
  }

  void Shown() {
    int frames = 0;
    for (const ShownFrames& thing : planned_.setting.shown) {
      for (const int count : thing.frames) frames += count;
    }
    Add("levels",
        absl::StrFormat("what the scene shows: %d, %d frames in all", planned_.setting.shown.size(),
                        frames),
        absl::StrFormat("it does not vary; noise of the readings %.3g %%",
                        kPercent * planned_.prediction.level_noise));
    Add("activation", "none", "every drive value that the scene shows is read", true);
  }

  void Levels() {
    if (!planned_.setting.shown.empty()) return Shown();
    const auto& levels = planned_.setting.levels;
    int least = std::numeric_limits<int>::max();
    int most = 0;
    for (const LevelFrames& level : levels) {
      int frames = 0;
      for (const int count : level.frames) frames += count;
      least = std::min(least, frames);
      most = std::max(most, frames);
    }
    const auto used = ExposuresInUse(planned_.setting);
    Add("levels",
        absl::StrFormat("%d levels, %d to %d frames each, %d of %d exposures", levels.size(), least,
                        most, std::ranges::count(used, true), used.size()),
        absl::StrFormat("noise of the levels %.3g %%, %s",
                        kPercent * planned_.prediction.level_noise, Name(planned_.setting.model)));
  }

  static std::string Name(fit::ActivationModel model) {
    std::string name(fit::NameOf(model));
    std::ranges::replace(name, '_', ' ');
    return name;
  }

  void Calibration() {
    Add("darks and flats", absl::StrFormat("%d of each", planned_.setting.calibration_frames),
        "the fewest with which such a plan keeps the tolerance");
  }

  void Table() {
    if (!planned_.setting.shown.empty()) {
      return Add("table", "none", "luminance is stated for the drive values as they are", true);
    }
    Add("table", absl::StrFormat("%d knots", planned_.setting.table_size),
        planned_.setting.primaries
            ? "for each primary; luminance is stated for what the table shows, so its error is no "
              "part of the promise"
            : absl::StrFormat("model and table leave %.3g %%",
                              kPercent * planned_.prediction.level_bias));
  }

  // PlanMeasurement() takes no tolerance that would ask for more.
  void Precision() {
    Add("precision", "single",
        absl::StrFormat("it loses less than %g %% of a luminance, and a tenth of the tolerance is "
                        "%.3g %%",
                        kPercent * fit::kSinglePrecisionLoss, kPercent * tolerance_ / 10));
  }

  Predictor& predictor_;
  const Planned& planned_;
  const SceneNeed& scene_;
  const double tolerance_;
  v1::MeasurementPlan& plan_;
};

}  // namespace

void Describe(const Prediction& prediction, v1::ErrorParts& parts) {
  parts.set_level_noise(prediction.level_noise);
  parts.set_level_bias(prediction.level_bias);
  parts.set_field_noise(prediction.field_noise);
  parts.set_field_bias(prediction.field_bias);
  parts.set_glare_noise(prediction.glare_noise);
  parts.set_glare_bias(prediction.glare_bias);
}

absl::Status ExplainPlan(Predictor& predictor, const Planned& planned, const SceneNeed& need,
                         double tolerance, v1::MeasurementPlan& plan) {
  return Explainer(predictor, planned, need, tolerance, plan).All();
}

}  // namespace eyebox::service
