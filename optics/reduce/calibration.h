// Everything about the camera that reduction needs, measured in the same recording.
//
// The order in which it is built, each step from frames of the recording:
//   darks  = FrameStacker per dark setting
//   defects = FindHotPixels(darks)
//   noise  = PhotonTransfer(shortest dark, defects) <- frames of every capture -> Fit()
//   dark   = MeasureDark(stack, noise) per setting and temperature, StateDarkCurrents()
//   linearity, where asked = EstimateLinearity(MeasureExposurePairs(stacks of constant light))
//   flat   = MeasureFlat(stacks of the flat, calibration so far, known luminance)
#ifndef EYEBOX_OPTICS_REDUCE_CALIBRATION_H_
#define EYEBOX_OPTICS_REDUCE_CALIBRATION_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/reduce/linearise.h"
#include "optics/reduce/measured_image.h"
#include "optics/sensor/defect_map.h"
#include "optics/sensor/noise_model.h"

namespace eyebox::optics {

struct DarkFrame {
  Setting setting;
  MeasuredImage image_dn;  // mean count without light
  // Share of pixels that read 0 DN in every frame: the camera clips its own noise, and what lies
  // below its black level stays unknown.
  double clipped_share = 0;
  std::optional<double> temperature_degC = {};  // mean of its frames, where all of them tell it
  // Upper bound of what dark current adds to the mean count; unknown until StateDarkCurrents().
  std::optional<double> dark_current_dn = {};
};

// The answer to uniform light. `response` is a rate in DN/s of light of `luminance`; without a
// known luminance it is normalised to a mean of 1 over the reference region.
struct FlatField {
  MeasuredImage response;
  std::optional<KnownLuminance> luminance;
};

struct Calibration {
  NoiseModel noise;
  double saturation_margin = SensorRange{}.saturation_margin;  // of the stacks to be reduced
  std::vector<DarkFrame> darks;  // one per setting used and temperature
  // Settings of lights without a dark for which none could be interpolated, and why.
  std::vector<std::pair<Setting, std::string>> refused_darks;
  DefectMap defects;
  std::optional<LinearityCurve> linearity;  // without one, counts are taken as they are
  std::optional<FlatField> flat;
  // Luminance of 1 DN/s, used only where there is no flat of known luminance. Through an unknown
  // flat: of 1 DN/s in the reference region.
  std::optional<KnownLuminance> luminance_of_one_dn_per_s;
};

// Mean and variance of a dark stack. Errors: InvalidArgument (empty stack).
absl::StatusOr<DarkFrame> MeasureDark(const Stack& dark, const NoiseModel& noise);

// The first dark of this setting, whatever its temperature; see also DarkFor().
// Errors: InvalidArgument (there is none: names those there are).
absl::StatusOr<const DarkFrame*> FindDark(const Calibration& calibration, const Setting& setting);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_CALIBRATION_H_
