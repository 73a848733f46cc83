// The straight line of photon transfer: variance = intercept + K signal.
#ifndef EYEBOX_OPTICS_SENSOR_VARIANCE_LINE_H_
#define EYEBOX_OPTICS_SENSOR_VARIANCE_LINE_H_

#include <span>

namespace eyebox::optics {

// Variance of one frame at a signal above bias.
struct PhotonTransferPoint {
  double signal_dn = 0;
  double variance_dn2 = 0;
  double degrees_of_freedom = 0;  // of the variance; its sigma is variance sqrt(2 / dof)
};

struct VarianceLine {
  double intercept_dn2 = 0;
  double slope_dn = 0;  // K, DN/e
  double intercept_sigma_dn2 = 0;
  double slope_sigma_dn = 0;  // 0 if the points do not determine a line
  double texture = 0;         // t^2, relative variance; 0 unless fitted
  double reduced_chi2 = 0;    // above 1 the sigmas have been scaled by its root
};

// Weighted least squares, each point weighted by the variance that the line predicts there, not by
// its own (which would prefer the low ones). At least two points of different signal, else all
// zero.
VarianceLine FitVarianceLine(std::span<const PhotonTransferPoint> points);

// The same for points that hold texture as well: variance = intercept + K signal + t^2 signal^2, t
// the relative rms of texture and of the pixels' unequal response; t is 0 where the points do not
// ask for it. Points far above the curve, on the scale of the points' own median scatter, lose
// their weight.
VarianceLine FitTexturedVarianceLine(std::span<const PhotonTransferPoint> points);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_VARIANCE_LINE_H_
