#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"
#include "service/planner/design_levels.h"
#include "service/planner/tradeoff.h"

namespace eyebox::service {
namespace {

constexpr int kUsualLevels = 17;
constexpr int kUsualFrames = 4;
constexpr int kUsualTable = 64;
constexpr double kUsualDiskDeg = 8;

double NearestTo(double wanted, const std::vector<double>& values) {
  return *std::ranges::min_element(values, {}, [&](double v) { return std::abs(v - wanted); });
}

class CaseList {
 public:
  CaseList(size_t exposures, const Stock* limits) : exposures_(exposures) {
    need_.disk_deg = kUsualDiskDeg;
    int disk_frames = kUsualFrames;
    if (limits != nullptr) {
      levels_ = static_cast<int>(limits->drives.size());
      frames_ = std::min(kUsualFrames, limits->frames);
      usual_.calibration_frames = std::min(usual_.calibration_frames, limits->calibration_frames);
      need_.disk_deg = limits->disks_deg.empty() ? 0 : NearestTo(kUsualDiskDeg, limits->disks_deg);
      disk_frames = std::min(kUsualFrames, limits->disk_frames);
    }
    usual_.levels = Even(levels_, frames_);
    usual_.disk_frames = disk_frames;
    usual_.table_size = kUsualTable;
  }

  int UsualLevels() const { return levels_; }
  int UsualFrames() const { return frames_; }
  int UsualCalibrationFrames() const { return usual_.calibration_frames; }
  bool LooksAtDisk() const { return need_.disk_deg > 0; }

  std::vector<int> Frames(int count) const { return std::vector<int>(exposures_, count); }
  std::vector<LevelFrames> Even(int levels, int frames) const {
    return EvenLevels(levels, Frames(frames));
  }

  template <typename Change>
  void Add(std::string lever, std::string name, const Change& change) {
    TradeoffCase added{std::move(lever), usual_, need_};
    added.setting.name = std::move(name);
    change(added.setting, added.need);
    cases_.push_back(std::move(added));
  }

  std::vector<TradeoffCase> Finish() { return std::move(cases_); }

 private:
  size_t exposures_;
  int levels_ = kUsualLevels;
  int frames_ = kUsualFrames;
  Setting usual_;
  Need need_;
  std::vector<TradeoffCase> cases_;
};

void AddCounts(CaseList& list) {
  list.Add("baseline", "baseline", [](Setting&, Need&) {});
  for (const int frames : {1, 2, 8, 16}) {
    list.Add("frames per level", absl::StrFormat("%d frames", frames),
             [&](Setting& s, Need&) { s.levels = list.Even(list.UsualLevels(), frames); });
  }
  for (const int levels : {5, 9, 17, 33}) {
    if (levels == list.UsualLevels()) continue;
    list.Add("levels", absl::StrFormat("%d levels", levels),
             [&](Setting& s, Need&) { s.levels = list.Even(levels, list.UsualFrames()); });
  }
  for (const int frames : {2, 4, 16}) {
    list.Add("darks and flats", absl::StrFormat("%d of each", frames),
             [&](Setting& s, Need&) { s.calibration_frames = frames; });
  }
}

void AddExposures(CaseList& list, size_t exposures) {
  for (size_t count = 1; count < exposures; ++count) {
    list.Add("exposures",
             count == 1 ? "the shortest alone" : absl::StrFormat("the shortest %d", count),
             [&](Setting& s, Need&) {
               for (LevelFrames& level : s.levels) {
                 for (size_t k = count; k < exposures; ++k) level.frames[k] = 0;
               }
             });
  }
}

void AddModels(CaseList& list) {
  using fit::ActivationModel;
  for (const ActivationModel model : {ActivationModel::kPowerOffset, ActivationModel::kSrgbLike,
                                      ActivationModel::kMonotoneSpline}) {
    list.Add("model", std::string(NameOf(model)), [&](Setting& s, Need&) { s.model = model; });
  }
  for (const int size : {16, 32, 129}) {
    list.Add("table size", absl::StrFormat("%d knots", size),
             [&](Setting& s, Need&) { s.table_size = size; });
  }
}

void AddFields(CaseList& list) {
  list.Add("field", "no map", [](Setting& s, Need&) { s.tier = FieldTier::kNone; });
  for (const int order : {2, 6}) {
    list.Add("field", absl::StrFormat("smooth, order %d", order),
             [&](Setting& s, Need&) { s.tier_size = order; });
  }
  for (const int side : {1, 2, 4, 8}) {
    list.Add("binning", absl::StrFormat("map of %d x %d px", side, side), [&](Setting& s, Need&) {
      s.tier = FieldTier::kBlocks;
      s.tier_size = side;
    });
  }
  for (const double radius_deg : {2.0, 5.0, 10.0}) {
    list.Add("region", absl::StrFormat("no map, within %g deg", radius_deg),
             [&](Setting& s, Need& need) {
               s.tier = FieldTier::kNone;
               need.radius_deg = radius_deg;
             });
  }
}

void AddGlare(CaseList& list) {
  if (!list.LooksAtDisk()) return;
  list.Add("scatter", "glare left in", [](Setting& s, Need&) { s.disk_frames = 0; });
  list.Add("scatter", "no disk looked at", [](Setting& s, Need& need) {
    s.disk_frames = 0;
    need.disk_deg = 0;
  });
  for (const int frames : {1, 16}) {
    list.Add("scatter", absl::StrFormat("%d frames of the disk", frames),
             [&](Setting& s, Need&) { s.disk_frames = frames; });
  }
}

void AddTogether(CaseList& list) {
  for (const int levels : {5, 9}) {
    for (const int frames : {1, 2, 8}) {
      for (const bool map : {false, true}) {
        list.Add("together",
                 absl::StrFormat("%d levels, %d frames, %s", levels, frames,
                                 map ? "map of 2 x 2 px" : "smooth, order 4"),
                 [&](Setting& s, Need&) {
                   s.levels = list.Even(levels, frames);
                   if (map) {
                     s.tier = FieldTier::kBlocks;
                     s.tier_size = 2;
                   }
                   s.disk_frames = frames;
                   s.calibration_frames = frames == 8 ? 16 : 4;
                 });
      }
    }
  }
}

// Each level at the nearest drive there is; frames of those that meet there are added, as far as
// there are so many.
std::vector<LevelFrames> MovedInto(const Stock& limits, const std::vector<LevelFrames>& levels) {
  std::vector<LevelFrames> moved;
  for (const LevelFrames& level : levels) {
    const double drive = NearestTo(level.drive, limits.drives);
    if (moved.empty() || moved.back().drive != drive) {
      moved.push_back({drive, level.frames});
      continue;
    }
    for (size_t k = 0; k < level.frames.size(); ++k) moved.back().frames[k] += level.frames[k];
  }
  for (LevelFrames& level : moved) {
    for (int& count : level.frames) count = std::min(count, limits.frames);
  }
  return moved;
}

absl::Status AddDesigned(const Pilot& pilot, const Costs& costs, const Stock* limits,
                         CaseList& list, std::vector<std::string>& left_out) {
  for (const int frames : {1, 2, 4, 8, 16}) {
    const std::string name = absl::StrFormat("in a third of the time of %d frames", frames);
    const double seconds =
        LevelSeconds(list.Even(list.UsualLevels(), frames), pilot.exposures_s, costs);
    const auto designed = DesignLevels(pilot, {}, fit::ErrorAtU::kDeparture, seconds / 3, costs,
                                       list.UsualCalibrationFrames());
    if (absl::IsFailedPrecondition(designed.status())) {
      left_out.push_back(
          absl::StrCat("designed levels, ", name, ": ", designed.status().message()));
      continue;
    }
    EYEBOX_RETURN_IF_ERROR(designed.status());
    list.Add("designed levels", name, [&](Setting& s, Need&) {
      s.levels = limits == nullptr ? designed->levels : MovedInto(*limits, designed->levels);
    });
  }
  return absl::OkStatus();
}

}  // namespace

std::string WhyBeyond(const Stock& limits, const Setting& setting, const Need& need) {
  const auto has = [](const std::vector<double>& values, double wanted) {
    return std::ranges::any_of(values, [&](double v) { return v == wanted; });
  };
  for (const LevelFrames& level : setting.levels) {
    if (!has(limits.drives, level.drive)) {
      return absl::StrFormat("no level of drive %g was recorded", level.drive);
    }
    if (std::ranges::max(level.frames) > limits.frames) {
      return absl::StrFormat("%d frames of a level are at hand", limits.frames);
    }
  }
  const size_t fewest = fit::ActivationProblem{setting.model, {}}.FewestDrives();
  if (setting.levels.size() < fewest) {
    return absl::StrFormat("its model needs %d levels", fewest);
  }
  if (setting.calibration_frames > limits.calibration_frames) {
    return absl::StrFormat("%d darks and flats are at hand", limits.calibration_frames);
  }
  if (need.disk_deg > 0 && !has(limits.disks_deg, need.disk_deg)) {
    return absl::StrFormat("no disk of %g deg was recorded", need.disk_deg);
  }
  if (setting.disk_frames > limits.disk_frames) {
    return absl::StrFormat("%d frames of a disk are at hand", limits.disk_frames);
  }
  return "";
}

absl::StatusOr<std::vector<TradeoffCase>> UsualCases(const Pilot& pilot, const Costs& costs,
                                                     const Stock* limits,
                                                     std::vector<std::string>& left_out) {
  CaseList list(pilot.exposures_s.size(), limits);
  AddCounts(list);
  AddExposures(list, pilot.exposures_s.size());
  AddModels(list);
  AddFields(list);
  AddGlare(list);
  AddTogether(list);
  EYEBOX_RETURN_IF_ERROR(AddDesigned(pilot, costs, limits, list, left_out));
  return list.Finish();
}

}  // namespace eyebox::service
