// One measurement at one setting, taken through reduction, fit and table as `eyebox run` does.
#ifndef EYEBOX_SERVICE_PLANNER_MEASURE_SETTING_H_
#define EYEBOX_SERVICE_PLANNER_MEASURE_SETTING_H_

#include <span>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "fit/activation/fit_activation.h"
#include "fit/cube/design_table.h"
#include "service/planner/frame_source.h"
#include "service/planner/setting.h"

namespace eyebox::service {

// Pixels of the field that the scene uses, row-major.
std::vector<size_t> RegionPixels(ImageSize size, const PinholeGeometry& geometry,
                                 double radius_deg);

struct StepSeconds {
  double reduce = 0;
  double fit = 0;
  double field = 0;
  double table = 0;
  double glare = 0;
  double Sum() const { return reduce + fit + field + table + glare; }
};

// What the lab would know after it.
struct Measured {
  std::vector<fit::ActivationFit> fits;  // of grey, or of red, green and blue
  std::vector<fit::TableDesign> tables;  // likewise
  // Instead of both: luminance at the reference point of each of Setting::shown, glare included.
  std::vector<std::pair<DriveRgb, double>> readings;
  // Luminance of the white field over that at the reference point, of each pixel of the region;
  // NaN where nothing is known.
  std::vector<double> field;
  double glare_factor = 1;  // see Truth
  StepSeconds seconds;      // of computing, by `clock`
};

// `region`: see RegionPixels. Errors: those of the source, of ReduceLevel, of the fits and of
// DesignTable.
absl::StatusOr<Measured> MeasureSetting(FrameSource& source, const Setting& setting,
                                        const Need& need, const std::vector<size_t>& region,
                                        const Clock& clock);

// Grey values u, fractions of white, at which errors are looked at: those of `need`, else evenly in
// log u.
std::vector<double> LooksAt(const Need& need);

// Luminance that `fits` of red, green and blue state for a drive: what each adds to black.
double StatedLuminance(std::span<const fit::ActivationFit> fits, const DriveRgb& drive);

// Luminance shown over luminance stated - 1, against the truth, [region, u]: of grey u the stated
// one is u times that of white, of colours that of the drive values that the tables make of them,
// of what was shown as it is that of its reading.
// Pixels without a value are left out. All but the luminance scale, which is common.
std::vector<double> ErrorsOf(const Measured& measured, const Truth& truth, const Need& need,
                             const std::vector<size_t>& region);

// L(v) over u times L at white, - 1, at every u that is looked at, with v the drive that
// the fit itself, not its table, has for u.
std::vector<double> DeparturesOf(const fit::Activation& fitted, const Truth& truth,
                                 const Need& need);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_MEASURE_SETTING_H_
