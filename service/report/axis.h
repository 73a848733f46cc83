// An axis of a figure: where a value stands on the page, and the ticks that a reader expects.
#ifndef EYEBOX_SERVICE_REPORT_AXIS_H_
#define EYEBOX_SERVICE_REPORT_AXIS_H_

#include <string>
#include <vector>

#include "service/report/report.h"

namespace eyebox::service::report {

enum class Scale { kLinear, kLogarithmic };

struct Tick {
  double value = 0;
  std::string label;  // empty: a minor tick
};

struct Axis {
  Scale scale = Scale::kLinear;
  Range values;     // minimum < maximum; above 0 where logarithmic
  double from = 0;  // position of the minimum on the page, SVG units
  double to = 1;    // and of the maximum
  std::vector<Tick> ticks;

  double Position(double value) const;
};

// Multiples of 1, 2 or 5 times a power of ten within `values`, about `count` of them.
std::vector<Tick> LinearTicks(Range values, int count);
// Powers of ten, labelled, and minor ticks between; 2 and 5 labelled too where decades are few.
std::vector<Tick> LogarithmicTicks(Range values);

Axis LinearAxis(Range values, double from, double to, int tick_count = 6);
Axis LogarithmicAxis(Range values, double from, double to);

// `values` with a margin of `share` of their extent at both ends; never empty.
Range Widened(Range values, double share);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_AXIS_H_
