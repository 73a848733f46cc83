// Error against time of many settings, and the front of those that nothing beats.
#ifndef EYEBOX_SERVICE_REPORT_FRONT_FIGURE_H_
#define EYEBOX_SERVICE_REPORT_FRONT_FIGURE_H_

#include <string>
#include <vector>

namespace eyebox::service::report {

struct FrontPoint {
  double seconds = 0;        // above 0
  double error_percent = 0;  // measured, above 0
  double error_sigma = 0;    // of it
  double predicted_percent = 0;
  bool on_front = false;
  std::string label;  // shown where it is on the front
};

// An SVG file by itself. Both axes are logarithmic. Empty without points.
std::string DrawFrontAlone(const std::vector<FrontPoint>& points);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_FRONT_FIGURE_H_
