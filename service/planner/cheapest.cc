#include "service/planner/cheapest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/cube/design_table.h"
#include "service/planner/design_levels.h"
#include "service/planner/shown_settings.h"

namespace eyebox::service {
namespace {

constexpr int kTableSizes[] = {16, 32, 64, 129};
constexpr double kTableShare = 0.25;  // of the tolerance
constexpr double kCovered = 0.95;

absl::StatusOr<int> TableSizeFor(const Predictor& predictor, double tolerance) {
  for (const int size : kTableSizes) {
    EYEBOX_ASSIGN_OR_RETURN(
        const fit::TableDesign table,
        fit::DesignTable(predictor.pilot().activation.activation, fit::TableTarget::kHdrp, size,
                         {.u_from = predictor.need().u_from}));
    if (table.certificate.max_relative <= kTableShare * tolerance) return size;
  }
  return kTableSizes[std::size(kTableSizes) - 1];
}

// Each plan of the levels that the grid knows.
absl::StatusOr<std::vector<std::vector<LevelFrames>>> LevelPlans(const Predictor& predictor,
                                                                 const LeverGrid& grid) {
  const Pilot& pilot = predictor.pilot();
  const size_t exposures = pilot.exposures_s.size();
  std::vector<std::vector<LevelFrames>> plans;
  for (const int levels : grid.even_levels) {
    for (const int frames : grid.frames) {
      for (size_t used = 1; used <= exposures; ++used) {
        std::vector<int> of_level(exposures, 0);
        std::fill_n(of_level.begin(), used, frames);
        plans.push_back(EvenLevels(levels, of_level));
      }
    }
  }
  constexpr int kUsualDarks = 8;
  for (const double seconds : grid.design_s) {
    for (const fit::ErrorAtU error : {fit::ErrorAtU::kLuminance, fit::ErrorAtU::kDeparture}) {
      const auto designed =
          DesignLevels(pilot, predictor.need(), error, seconds, predictor.costs(), kUsualDarks);
      if (absl::IsFailedPrecondition(designed.status())) continue;  // too little time for it
      EYEBOX_RETURN_IF_ERROR(designed.status());
      plans.push_back(designed->levels);
    }
  }
  return plans;
}

// White in the exposures that it is taken in, so often at least.
std::vector<LevelFrames> WithWhite(std::vector<LevelFrames> levels, int frames) {
  for (int& count : levels.back().frames) {
    if (count > 0) count = std::max(count, frames);
  }
  return levels;
}

struct Tier {
  FieldTier tier;
  int size;
};

std::vector<Tier> TiersOf(const LeverGrid& grid) {
  std::vector<Tier> tiers = {{FieldTier::kNone, 0}};
  for (const int order : grid.orders) tiers.push_back({FieldTier::kSmooth, order});
  for (const int side : grid.block_px) tiers.push_back({FieldTier::kBlocks, side});
  return tiers;
}

std::vector<int> DiskChoices(const Need& need, const LeverGrid& grid) {
  std::vector<int> choices = {0};
  if (need.disk_deg > 0) {
    choices.insert(choices.end(), grid.disk_frames.begin(), grid.disk_frames.end());
  }
  return choices;
}

}  // namespace

absl::StatusOr<std::vector<Setting>> CandidateSettings(Predictor& predictor, double tolerance,
                                                       const LeverGrid& grid) {
  Setting setting;
  setting.name = "plan";
  setting.model = predictor.pilot().activation.model;
  setting.primaries = !predictor.need().colours.empty();
  EYEBOX_ASSIGN_OR_RETURN(setting.table_size, TableSizeFor(predictor, tolerance));
  EYEBOX_ASSIGN_OR_RETURN(const auto plans, LevelPlans(predictor, grid));
  std::vector<Setting> candidates;
  for (const auto& levels : plans) {
    for (const auto& [tier, size] : TiersOf(grid)) {
      setting.tier = tier;
      setting.tier_size = size;
      for (const int white : grid.white_frames) {
        // Without a map more of white is no more than another level.
        if (tier == FieldTier::kNone && white > 0) continue;
        setting.levels = WithWhite(levels, white);
        for (const int calibration : grid.calibration_frames) {
          setting.calibration_frames = calibration;
          for (const int disk : DiskChoices(predictor.need(), grid)) {
            setting.disk_frames = disk;
            candidates.push_back(setting);
          }
        }
      }
    }
  }
  for (Setting& shown : ShownSettings(predictor, grid)) {
    for (const int calibration : grid.calibration_frames) {
      shown.calibration_frames = calibration;
      candidates.push_back(shown);
    }
  }
  return candidates;
}

absl::StatusOr<Search> FindCheapest(Predictor& predictor, double tolerance,
                                    std::optional<double> budget_s, const LeverGrid& grid) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<Setting> candidates,
                          CandidateSettings(predictor, tolerance, grid));
  std::vector<std::pair<double, const Setting*>> by_time;
  for (const Setting& setting : candidates) {
    by_time.emplace_back(CaptureSeconds(setting, predictor.pilot().exposures_s, predictor.costs()),
                         &setting);
  }
  std::ranges::stable_sort(by_time, {}, &std::pair<double, const Setting*>::first);
  Search search;
  search.considered = candidates.size();
  double best_rms = std::numeric_limits<double>::infinity();
  const Setting* best = nullptr;
  for (const auto& [seconds, setting] : by_time) {
    const absl::StatusOr<double> rms = predictor.PredictRms(*setting);
    if (absl::IsFailedPrecondition(rms.status())) continue;  // saturates, or tells too little
    EYEBOX_RETURN_IF_ERROR(rms.status());
    if (*rms < best_rms && (!budget_s || seconds <= *budget_s)) {
      best_rms = *rms;
      best = setting;
    }
    // Where 95 % lie within the tolerance, the rms hardly lies beyond it.
    if (search.cheapest || *rms > tolerance) continue;
    EYEBOX_ASSIGN_OR_RETURN(const double share, predictor.ShareWithin(*setting, tolerance));
    if (share < kCovered) continue;
    EYEBOX_ASSIGN_OR_RETURN(const Prediction prediction, predictor.Predict(*setting));
    search.cheapest = Planned{*setting, prediction};
    if (!budget_s || seconds <= *budget_s) break;
  }
  if (best != nullptr) {
    EYEBOX_ASSIGN_OR_RETURN(const Prediction prediction, predictor.Predict(*best));
    search.best = Planned{*best, prediction};
  }
  return search;
}

}  // namespace eyebox::service
