// Finding where the knots of an unknown table lie from renderings through delta cubes (HDRP model,
// section 7.2, fig 4): delta cube m maps knot m to 1 and all others to 0.
#ifndef EYEBOX_FIT_RENDERER_DELTA_SWEEP_H_
#define EYEBOX_FIT_RENDERER_DELTA_SWEEP_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::fit {

struct DeltaReading {
  int cube = 0;  // m, 1 to size: which entry is 1
  double u = 0;  // unprocessed value shown, at least 0
  double t = 0;  // tonemapped value, s(v)
};

struct DeltaSweep {
  int size = 32;
  std::vector<DeltaReading> readings;
};

// Columns cube,u,t; others are left alone. Errors: those of ReadCsv; InvalidArgument naming file,
// line and column (a cube outside 1 to size, u below 0, t outside [0, 1]).
absl::StatusOr<DeltaSweep> ReadDeltaSweep(const std::filesystem::path& file, int size);
std::string EncodeDeltaSweep(const DeltaSweep& sweep);

struct SweepOptions {
  int size = 32;
  int steps = 600;  // values of u, evenly in log u
  double u_from = 1e-5;
  double u_to = 100;
  bool rounds_to_8bits = true;  // t = s(k / 255) as a capture gives it
  bool packed_buffers = false;  // R11G11B10, truncated, before and after the table
};
// What a renderer that samples in LogC answers, grey. Errors: InvalidArgument (size outside 4 to
// 129, fewer than 2 steps, not 0 < u_from < u_to).
absl::StatusOr<DeltaSweep> SimulateDeltaSweep(const SweepOptions& options);

// One entry of the table.
struct RecoveredKnot {
  int cube = 0;  // m
  bool is_found = false;
  double u_at_peak = 0;    // the u with the largest t; the middle of a plateau
  double u_optimised = 0;  // of the constrained fit
  double sigma = 0;        // of u_optimised, from the fit's residuals
  std::string why_not;     // where it is not found
};

struct RecoveredKnots {
  std::vector<RecoveredKnot> knots;  // [size]
  double rms_residual = 0;           // of t, after the fit
  std::string termination;
};

// Peaks first, then the u* of all found entries together: least squares of t, each response a tent
// between its neighbours that is straight in log(u + 0.0086393), the axis of LogC up to scale;
// ascending by construction, because the logarithms of the gaps are fitted. An entry whose answers
// all stay below 1/10 has no knot within the sweep. Errors: InvalidArgument (fewer than 3 readings
// of a cube), FailedPrecondition (fewer than three knots found, peaks that do not ascend).
absl::StatusOr<RecoveredKnots> RecoverKnots(const DeltaSweep& sweep);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_RENDERER_DELTA_SWEEP_H_
