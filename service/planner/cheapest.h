// The cheapest measurement that keeps a tolerance.
#ifndef EYEBOX_SERVICE_PLANNER_CHEAPEST_H_
#define EYEBOX_SERVICE_PLANNER_CHEAPEST_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "service/planner/predict_error.h"
#include "service/planner/setting.h"

namespace eyebox::service {

// How finely the levers are tried.
struct LeverGrid {
  std::vector<int> frames = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};
  std::vector<int> even_levels = {5, 9};
  std::vector<double> design_s = {1,  1.25, 1.6, 2,  2.5, 3.2, 4,  5,  6.3, 8,  10,
                                  13, 16,   20,  25, 32,  40,  50, 64, 80,  100};
  std::vector<int> white_frames = {0, 2, 4, 8, 12, 16, 24, 32};  // of white, at least
  std::vector<int> orders = {2, 3, 4, 5, 6};
  std::vector<int> block_px = {1, 2, 3, 4};
  std::vector<int> calibration_frames = {2, 3, 4, 6, 8, 12, 16, 24, 32};
  // Where what the scene shows is read itself: of it, and of white for the map.
  std::vector<int> shown_frames = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128};
  std::vector<int> map_frames = {1, 2, 4, 8, 12, 16, 24, 32};
  std::vector<int> disk_frames = {1, 2, 4, 8, 16, 32};
};

// Settings that make sense for what `predictor` needs: primaries where it looks at colours, disks
// where it looks at one, what it shows itself where that is fixed. The table is the smallest that
// leaves a quarter of the tolerance. Errors: those of DesignLevels and DesignTable.
absl::StatusOr<std::vector<Setting>> CandidateSettings(Predictor& predictor, double tolerance,
                                                       const LeverGrid& grid = {});

struct Planned {
  Setting setting;
  Prediction prediction;
};

struct Search {
  std::optional<Planned> cheapest;  // that keeps the tolerance, whatever the budget
  std::optional<Planned> best;      // the smallest error within the budget; without one, of all
  size_t considered = 0;
};

// `tolerance`: 95 % of errors are to lie within +- it. Errors: those of CandidateSettings and of
// Predictor.
absl::StatusOr<Search> FindCheapest(Predictor& predictor, double tolerance,
                                    std::optional<double> budget_s, const LeverGrid& grid = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_CHEAPEST_H_
