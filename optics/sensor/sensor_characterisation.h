// All that was learnt of a camera's sensor, and how reduction uses it.
#ifndef EYEBOX_OPTICS_SENSOR_SENSOR_CHARACTERISATION_H_
#define EYEBOX_OPTICS_SENSOR_SENSOR_CHARACTERISATION_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/linearise.h"
#include "optics/sensor/defect_map.h"
#include "optics/sensor/emva1288/evaluate.h"
#include "optics/sensor/emva1288/read_series.h"
#include "optics/sensor/noise_model.h"

namespace eyebox::optics {

// Which camera was characterised, and how its counts came; empty or 0 where unknown.
struct SensorIdentity {
  std::string model;
  std::string serial;
  std::string pixel_format;
  int bits = 0;
};

// The sensor part of a rig: it holds for one camera, gain setting and region of interest.
struct SensorCharacterisation {
  SensorIdentity identity;
  Emva1288Result emva;
  DefectMap defects;                        // hot and dead
  std::optional<LinearityCurve> linearity;  // where the series determines one
  double gain_db = 0;

  // K, temporal dark noise without quantisation, mean dark of the shortest exposure.
  NoiseModel ToNoiseModel() const;

  // SensorRange::saturation_margin that puts saturation where it was measured, never above that of
  // full scale. Where the bits are unknown or the series did not reach saturation: that of full
  // scale.
  // Errors: InvalidArgument (it saturates in the lower half of full scale: more bits are claimed
  // than the sensor fills).
  absl::StatusOr<double> SaturationMargin() const;
};

// Statistics, defect map and linearity of a series whose images were read. A linearity curve is
// left out, with a warning in `emva`, where the steps do not determine it.
// Errors: those of EvaluateEmva1288, FindHotPixels and FindDeadPixels.
absl::StatusOr<SensorCharacterisation> CharacteriseSensor(const SeriesCollector& series,
                                                          const Emva1288Options& options = {},
                                                          const DefectOptions& defects = {});

// Puts the sensor into a calibration whose darks were recorded with the lights: noise model,
// saturation and linearity replace what is there, defects are added to it.
// Errors: InvalidArgument (gain or size differ from the calibration's), those of SaturationMargin.
absl::Status ApplySensor(const SensorCharacterisation& sensor, Calibration& calibration);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_SENSOR_CHARACTERISATION_H_
