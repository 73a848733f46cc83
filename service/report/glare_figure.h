// The figure of a glare series: what an instrument reads in the middle of a disk, against the
// disk's diameter (after Murray, Patel & Wiedenmann 2022, fig 6).
#ifndef EYEBOX_SERVICE_REPORT_GLARE_FIGURE_H_
#define EYEBOX_SERVICE_REPORT_GLARE_FIGURE_H_

#include <string>
#include <vector>

namespace eyebox::service::report {

struct GlarePoint {
  double diameter_deg = 0;  // above 0
  double offset_deg = 0;    // readings off the axis of the disk are left out of the figure
  double luminance = 0;
  double luminance_sigma = 0;
};

struct GlareCurvePoint {
  double diameter_deg = 0;  // above 0, ascending
  double luminance = 0;
  double luminance_sigma = 0;
};

struct GlareFigureInput {
  std::string luminance_unit;
  std::vector<GlarePoint> readings;
  std::vector<GlareCurvePoint> curve;  // at least 2 points
};

// Inline SVG, both axes logarithmic where all is above 0; the band is 2 sigma of the fit.
std::string DrawGlare(const GlareFigureInput& input);
// The same as a file of its own, with its style.
std::string DrawGlareAlone(const GlareFigureInput& input);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_GLARE_FIGURE_H_
