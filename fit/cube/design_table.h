// Designs the table that makes luminance proportional to the rendered value u.
#ifndef EYEBOX_FIT_CUBE_DESIGN_TABLE_H_
#define EYEBOX_FIT_CUBE_DESIGN_TABLE_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "fit/base/activation.h"
#include "fit/cube/storage.h"

namespace eyebox::fit {

enum class TableTarget {
  kHdrp,     // Unity HDRP, External tonemapping: .cube, knots and interpolation in LogC
  kPps,      // Unity Post-Processing Stack: strip PNG, n x n^2, 8 bits, uniform knots in [0, 1]
  kResolve,  // Adobe / Resolve .cube: uniform knots in [0, 1], entries are drive values
  kPtb,      // Psychtoolbox, LoadNormalizedGammaTable: 256 entries, one for each 8-bit value; what
             // lies between two values is never asked for
};
// HDRP encodes an entry with the inverse sRGB transfer before it drives the display; elsewhere the
// entry is the drive value, so u = r gives drive 1 whatever the display's gamma.
std::string_view NameOf(TableTarget target);  // "hdrp", "pps", "resolve", "ptb"
// Errors: InvalidArgument listing the names.
absl::StatusOr<TableTarget> TableTargetOf(std::string_view name);

enum class DesignMethod {
  kMinimax,    // the smallest worst relative luminance error
  kPublished,  // f of eq 15 at each knot: HDRP the 32 of table 2(b), elsewhere uniform ones
};
std::string_view NameOf(DesignMethod method);  // "minimax", "published"

// How to design, and what the error is measured over, as fractions of white.
struct DesignOptions {
  double white_u = 1;    // r: the rendered value that the display's maximum stands for
  double u_from = 0.05;  // the certified range begins at u_from * white_u
  int samples = 4096;    // points of the dense evaluation
  DesignMethod method = DesignMethod::kMinimax;
  // What the minimax design takes into account on the way to the display, for kHdrp and kResolve:
  // buffers, weights and output as exact bounds; half floats by rounding what was designed.
  StorageModel designed_for = {};
  // Errors: InvalidArgument naming the field.
  absl::Status Validate() const;
};

// Worst and rms of L / L_wanted - 1 over the range, from a dense evaluation of the table as it is
// stored (rounded to what the file holds) and as the renderer samples it.
struct Certificate {
  double max_relative = 0;
  double rms_relative = 0;
  double at_u = 0;    // of the worst, as a fraction of white
  double u_from = 0;  // fractions of white
  double u_to = 1;
  int samples = 0;  // evenly in log u
  // Largest relative luminance step between neighbouring values that the 8-bit framebuffer can hold
  // in the range, which no table removes. Not part of max_relative unless output8 is in the path.
  double contrast_step_8bit = 0;
};

// A certificate of the same table where the way to the display is not exact: the channel with the
// largest error.
struct StoredCertificate {
  StorageModel storage;
  Certificate certificate;
  Channel worst_channel = Channel::kGrey;
};

struct ErrorPoint {
  double u = 0;               // fraction of white
  double relative_error = 0;  // L / L_wanted - 1
};

// One channel; the same for red, green and blue of an achromatic fit.
struct TableDesign {
  TableTarget target = TableTarget::kHdrp;
  DesignMethod method = DesignMethod::kMinimax;
  StorageModel designed_for;
  int size = 0;
  double white_u = 1;
  std::vector<double> knots_u;  // [size]
  std::vector<double> entries;  // [size], monotone, as stored in the file
  double u_cutoff = 0;          // u0 = r w / (1 + w), fraction of white: below, L0 is shown
  Certificate certificate;
};

// Minimises the largest relative luminance error over the range under monotone entries.
// Errors: InvalidArgument (size outside 2 to 129, or to 32 for kPps, or other than 256 for kPtb, or
// than 32 for the published HDRP knots; an activation outside the limits of Activation; options; a
// storage model that the target does not have).
absl::StatusOr<TableDesign> DesignTable(const Activation& activation, TableTarget target, int size,
                                        const DesignOptions& options = {});

// Of `table` after `storage`; `options` as for the design. Evaluated as the certificate of the
// design is, eight times as densely, and at both ends of every value that a colour buffer holds.
// Errors: InvalidArgument (a storage model that the target does not have; options).
absl::StatusOr<StoredCertificate> CertifyStored(const TableDesign& table,
                                                const Activation& activation,
                                                const DesignOptions& options,
                                                const StorageModel& storage);

// The drive value that reaches the display for a rendered value `u` (not a fraction) through the
// table: sampled as the target's renderer samples it, then encoded.
double DriveThroughTable(const TableDesign& table, double u);

// Relative luminance error at `points` values of u / white, logarithmically from `u_from` to 1.
std::vector<ErrorPoint> ErrorCurve(const TableDesign& table, const Activation& activation,
                                   double u_from, int points);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_DESIGN_TABLE_H_
