// w from a simulated recording of disks, and what is made with it, against the truth.
#ifndef EYEBOX_TESTS_TOOLS_COVERAGE_JUDGE_W_H_
#define EYEBOX_TESTS_TOOLS_COVERAGE_JUDGE_W_H_

#include <vector>

#include "absl/status/statusor.h"
#include "capture/camera/sim/parameters.h"
#include "fit/scatter/fit_with_field.h"
#include "service/planner/simulated_measurement.h"
#include "tests/tools/coverage/coverage_table.h"

namespace eyebox {

inline constexpr int kCoverageRepeats = 4;

struct Sample {
  int x = 0;
  int y = 0;
};

Stimulus Show(StimulusPattern pattern, double diameter_deg, double drive);

// As `eyebox scatter` does: black, bright and black disks, and the white field.
absl::StatusOr<fit::FieldFit> FitW(service::SimulatedMeasurement& measurement,
                                   const optics::LuminanceImage& white);

// Each parameter of w for which the fit states an interval: neither held nor at a bound nor left
// open by the readings.
void JudgeW(const fit::ScatterFit& fit, const capture::SimParameters& rig, CoverageTable& table);

// Luminance with the glare taken out, at these pixels of the white field and in the middle of a
// black disk.
absl::Status JudgeCleanLuminance(const fit::FieldFit& w, const capture::SimParameters& rig,
                                 uint64_t seed, service::SimulatedMeasurement& measurement,
                                 const std::vector<Sample>& pixels, CoverageTable& table);

}  // namespace eyebox

#endif  // EYEBOX_TESTS_TOOLS_COVERAGE_JUDGE_W_H_
