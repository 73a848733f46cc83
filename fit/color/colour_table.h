// Designs the three-dimensional table that gives each rendered colour its light, with proof.
#ifndef EYEBOX_FIT_COLOR_COLOUR_TABLE_H_
#define EYEBOX_FIT_COLOR_COLOUR_TABLE_H_

#include <array>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "fit/color/colour_goal.h"
#include "fit/cube/design_table.h"
#include "fit/cube/table_file.h"

namespace eyebox::fit {

struct ColourTableOptions {
  GoalOptions goal;
  double white_u = 1;    // r: the rendered value that white stands for
  double u_from = 0.05;  // the certified range begins at u_from * white_u
  int samples = 4096;    // points of each ramp, and number of interior colours
  // Errors: InvalidArgument naming the field.
  absl::Status Validate() const;
};

// Of u / r = t (1, 1, 1), or t times one channel, t from u_from to 1.
struct RampCertificate {
  std::string name;       // "white", "red", "green", "blue"
  Certificate luminance;  // its contrast step is not filled
  // u'v' from the wanted colour; of a primary it holds what the light of black takes away.
  double max_chromaticity_error = 0;
  double at_u_chromaticity = 0;
  double u_reachable = 1;  // the display is bright enough up to here
};

// Of colours spread evenly over the cube from u_from to 1 that lie inside the gamut.
struct InteriorCertificate {
  double max_relative = 0;  // of luminance
  double rms_relative = 0;
  double max_chromaticity_error = 0;  // u'v'
  double rms_chromaticity_error = 0;
  int colours = 0;          // that were evaluated
  int colours_outside = 0;  // that were left out: outside the gamut, or too bright
};

// Of the entries that stand for colours from black to white.
struct EntryCount {
  int in_range = 0;
  int outside_gamut = 0;              // chromaticity outside the display's; luminance kept
  int limited_by_black = 0;           // inside, but less saturated by the light of black
  int too_bright = 0;                 // a channel would need more than full drive
  double max_chromaticity_error = 0;  // u'v', of those outside the gamut, without black's light
};

struct ColourTable {
  TableTarget target = TableTarget::kHdrp;
  int size = 0;
  double white_u = 1;
  std::vector<double> knots_u;  // [size], of each axis
  Cube3d cube;                  // as stored in the file
  ColourGoal goal;
  EntryCount entries;
  std::array<RampCertificate, 4> ramps;  // white, red, green, blue
  InteriorCertificate interior;
};

// Each entry is the inverse of `model` at its knot; those of kHdrp and kResolve are then shifted as
// the minimax design of each channel alone shifts its entries, which shares the error of
// interpolation between knots and gaps.
// Errors: InvalidArgument (a model out of range, size outside 2 to 129, or to 32 for kPps; another
// target, which has no three-dimensional table; options); those of MakeColourGoal.
absl::StatusOr<ColourTable> DesignColourTable(const ColourModel& model, TableTarget target,
                                              int size, const ColourTableOptions& options = {});

// The drive values that reach the display for the rendered values u / r = `u`: sampled trilinearly
// on the target's axes, then encoded.
Rgb DriveThroughColourTable(const ColourTable& table, const Rgb& u);

// Fills ramps and interior of `table` by dense evaluation of its entries as they stand.
void CertifyColourTable(const ColourModel& model, const ColourTableOptions& options,
                        ColourTable& table);

// The bytes of the file that the target loads: .cube text or PNG.
absl::StatusOr<std::string> EncodeColourTable(const ColourTable& table);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_COLOUR_TABLE_H_
