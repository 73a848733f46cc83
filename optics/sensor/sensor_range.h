// Where the counts of a camera begin and end.
#ifndef EYEBOX_OPTICS_SENSOR_SENSOR_RANGE_H_
#define EYEBOX_OPTICS_SENSOR_SENSOR_RANGE_H_

#include "absl/status/status.h"

namespace eyebox::optics {

struct SensorRange {
  int bits = 0;  // significant bits of the counts, 1 to 16
  // Counts this close to full scale are saturated, as a fraction of full scale. Sensors bend
  // before they clip.
  double saturation_margin = 1.0 / 256;

  double FullScaleDn() const { return static_cast<double>((1 << bits) - 1); }
  // A count at or above this level is saturated, DN (whole number).
  double SaturationDn() const;
};

// Errors: InvalidArgument (bits outside 1 to 16, margin outside 0 to 0.5).
absl::Status Validate(const SensorRange& range);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_SENSOR_RANGE_H_
