#include "capture/plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "capture/base/random.h"
#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr uint64_t kLevelOrderStream = 1;

absl::Status CheckCount(std::string_view field, int value, int minimum, int maximum) {
  if (value >= minimum && value <= maximum) return absl::OkStatus();
  return BadInput("PlanOptions." + std::string(field), "is " + std::to_string(value),
                  "give " + std::to_string(minimum) + " to " + std::to_string(maximum));
}

absl::Status CheckExposures(const std::vector<double>& exposures_s) {
  constexpr std::string_view kField = "PlanOptions.exposures_s";
  if (exposures_s.empty()) return BadInput(kField, "is empty", "give one exposure time or more");
  for (size_t i = 0; i < exposures_s.size(); ++i) {
    if (!(exposures_s[i] > 0) || !std::isfinite(exposures_s[i])) {
      return BadInput(kField, "holds " + std::to_string(exposures_s[i]), "give times above 0 s");
    }
    if (i > 0 && exposures_s[i] <= exposures_s[i - 1]) {
      return BadInput(kField, "is not ascending", "sort the exposures and name each once");
    }
  }
  return absl::OkStatus();
}

absl::Status CheckFlats(const PlanOptions& options) {
  if (options.flat_repeats == 0) return absl::OkStatus();
  if (!(options.flat_luminance_cd_m2 > 0) || !std::isfinite(options.flat_luminance_cd_m2)) {
    return BadInput("PlanOptions.flat_luminance_cd_m2",
                    "is " + std::to_string(options.flat_luminance_cd_m2),
                    "give the luminance of the flat reference, above 0");
  }
  const double sigma = options.flat_luminance_relative_sigma;
  if (sigma > 0 && sigma < 1) return absl::OkStatus();
  return BadInput("PlanOptions.flat_luminance_relative_sigma", "is " + std::to_string(sigma),
                  "give the relative standard uncertainty, above 0 and below 1");
}

absl::Status CheckReference(const PlanOptions& options) {
  EYEBOX_RETURN_IF_ERROR(CheckCount("reference_every", options.reference_every, 0, 4096));
  if (options.reference_every == 0) return absl::OkStatus();
  EYEBOX_RETURN_IF_ERROR(CheckCount("reference_repeats", options.reference_repeats, 1, 65536));
  if (options.reference_drive > 0 && options.reference_drive <= 1) return absl::OkStatus();
  return BadInput("PlanOptions.reference_drive", "is " + std::to_string(options.reference_drive),
                  "give a drive value above 0 and up to 1");
}

absl::Status CheckDiameters(std::string_view field, const std::vector<double>& diameters_deg) {
  for (const double diameter : diameters_deg) {
    if (diameter > 0 && diameter < 180) continue;
    return BadInput("PlanOptions." + std::string(field), "holds " + std::to_string(diameter),
                    "give angles above 0 and below 180 deg");
  }
  return absl::OkStatus();
}

absl::Status CheckDisks(const PlanOptions& options) {
  EYEBOX_RETURN_IF_ERROR(CheckDiameters("disk_diameters_deg", options.disk_diameters_deg));
  EYEBOX_RETURN_IF_ERROR(
      CheckDiameters("black_disk_diameters_deg", options.black_disk_diameters_deg));
  EYEBOX_RETURN_IF_ERROR(
      CheckDiameters("checkerboard_squares_deg", options.checkerboard_squares_deg));
  EYEBOX_RETURN_IF_ERROR(CheckCount("disk_repeats", options.disk_repeats, 1, 65536));
  if (options.disk_drive > 0 && options.disk_drive <= 1) return absl::OkStatus();
  return BadInput("PlanOptions.disk_drive", "is " + std::to_string(options.disk_drive),
                  "give a drive value above 0 and up to 1");
}

class PlanBuilder {
 public:
  explicit PlanBuilder(const PlanOptions& options) : options_(options) {}

  void AddBracket(CaptureSpec spec) {
    spec.gain_db = options_.gain_db;
    for (const double exposure_s : options_.exposures_s) {
      spec.exposure_s = exposure_s;
      plan_.captures.push_back(spec);
    }
  }

  void AddDarks() {
    CaptureSpec dark;
    dark.kind = FrameKind::kDark;
    dark.repeats = options_.dark_repeats;
    AddBracket(dark);
  }

  void AddFlats() {
    if (options_.flat_repeats == 0) return;
    CaptureSpec flat;
    flat.kind = FrameKind::kFlat;
    flat.repeats = options_.flat_repeats;
    flat.luminance_cd_m2 = options_.flat_luminance_cd_m2;
    flat.luminance_relative_sigma = options_.flat_luminance_relative_sigma;
    AddBracket(flat);
  }

  void AddLevel(int level) {
    const double drive = static_cast<double>(level) / (options_.levels - 1);
    CaptureSpec grey;
    grey.level_id = level;
    grey.stimulus.drive = DriveRgb{drive, drive, drive};
    grey.repeats = options_.repeats;
    AddBracket(grey);
  }

  void AddLevelsAndReferences(const std::vector<int>& order) {
    const auto every = static_cast<size_t>(options_.reference_every);
    const auto darks_every = static_cast<size_t>(options_.dark_every);
    for (size_t i = 0; i < order.size(); ++i) {
      if (every > 0 && i % every == 0) AddReference();
      AddLevel(order[i]);
      const bool last = i + 1 == order.size();
      if (darks_every > 0 && ((i + 1) % darks_every == 0 || last)) AddDarks();
    }
    if (every > 0) AddReference();
  }

  void AddDisks() {
    if (options_.disk_diameters_deg.empty() && options_.black_disk_diameters_deg.empty() &&
        options_.checkerboard_squares_deg.empty()) {
      return;
    }
    AddGlareStimulus(StimulusPattern::kFullField, 0, 0);
    AddGlareStimulus(StimulusPattern::kFullField, 0, options_.disk_drive);
    for (const double diameter : options_.disk_diameters_deg) {
      AddGlareStimulus(StimulusPattern::kDisk, diameter, options_.disk_drive);
    }
    for (const double diameter : options_.black_disk_diameters_deg) {
      AddGlareStimulus(StimulusPattern::kBlackDisk, diameter, options_.disk_drive);
    }
    for (const double side : options_.checkerboard_squares_deg) {
      AddGlareStimulus(StimulusPattern::kCheckerboard, side, options_.disk_drive);
    }
    if (options_.reference_every > 0) AddReference();
  }

  CapturePlan Finish() { return std::move(plan_); }

 private:
  void AddGlareStimulus(StimulusPattern pattern, double diameter_deg, double drive) {
    CaptureSpec spec;
    spec.series = kGlareSeries;
    spec.stimulus = {pattern, diameter_deg, DriveRgb{drive, drive, drive}};
    spec.repeats = options_.disk_repeats;
    AddBracket(spec);
  }

  void AddReference() {
    CaptureSpec reference;
    reference.series = kReferenceSeries;
    reference.role = CaptureRole::kReference;
    const double drive = options_.reference_drive;
    reference.stimulus.drive = DriveRgb{drive, drive, drive};
    reference.exposure_s = options_.exposures_s.front();
    reference.gain_db = options_.gain_db;
    reference.repeats = options_.reference_repeats;
    plan_.captures.push_back(reference);
  }

  const PlanOptions& options_;
  CapturePlan plan_;
};

}  // namespace

std::vector<int> ShuffledLevels(int levels, uint64_t seed) {
  std::vector<int> order(static_cast<size_t>(levels));
  std::iota(order.begin(), order.end(), 0);
  RandomStream random({seed, kLevelOrderStream});
  for (size_t left = order.size(); left > 1; --left) {
    std::swap(order[left - 1], order[random.Below(left)]);
  }
  return order;
}

absl::Status PlanOptions::Validate() const {
  EYEBOX_RETURN_IF_ERROR(CheckCount("levels", levels, 2, 4096));
  EYEBOX_RETURN_IF_ERROR(CheckExposures(exposures_s));
  if (!std::isfinite(gain_db)) {
    return BadInput("PlanOptions.gain_db", "is not a number", "give a gain in dB");
  }
  EYEBOX_RETURN_IF_ERROR(CheckCount("repeats", repeats, 1, 65536));
  EYEBOX_RETURN_IF_ERROR(CheckCount("dark_repeats", dark_repeats, 1, 65536));
  EYEBOX_RETURN_IF_ERROR(CheckCount("dark_every", dark_every, 0, 4096));
  EYEBOX_RETURN_IF_ERROR(CheckCount("flat_repeats", flat_repeats, 0, 65536));
  EYEBOX_RETURN_IF_ERROR(CheckReference(*this));
  EYEBOX_RETURN_IF_ERROR(CheckDisks(*this));
  return CheckFlats(*this);
}

absl::StatusOr<CapturePlan> MakeGreyPlan(const PlanOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  PlanBuilder builder(options);
  builder.AddDarks();
  builder.AddFlats();
  builder.AddLevelsAndReferences(ShuffledLevels(options.levels, options.seed));
  builder.AddDisks();
  return builder.Finish();
}

}  // namespace eyebox::capture
