// The linear noise model of a camera: EMVA 1288 release 4.0, "linear model",
// sigma_y^2 = K^2 sigma_d^2 + sigma_q^2 + K (mu_y - mu_y.dark).
#ifndef EYEBOX_OPTICS_SENSOR_NOISE_MODEL_H_
#define EYEBOX_OPTICS_SENSOR_NOISE_MODEL_H_

#include <string>

namespace eyebox::optics {

struct NoiseModel {
  double gain_dn_per_e = 0;        // K, overall system gain
  double gain_sigma_dn_per_e = 0;  // standard uncertainty of K
  double read_variance_dn2 = 0;    // of one frame, without quantisation
  double read_variance_sigma_dn2 = 0;
  double quantisation_variance_dn2 = 1.0 / 12;
  double bias_dn = 0;  // median count without light at the shortest dark exposure
  // "pairs of repeats", or "spatial differences": an upper bound then, since the sensor's
  // nonuniformity and the scene's texture are in it.
  std::string noise_source;
  double gain_db = 0;  // the gain setting it holds for

  // Variance of the mean of `frames` frames, DN^2, at an expected count of `excess_dn` above
  // bias_dn (light and dark current; negative counts as 0). Quantisation averages out only where
  // other noise dithers it: below 0.5 DN rms it stays whole.
  double MeanVariance(double excess_dn, int frames) const {
    const double noise = read_variance_dn2 + gain_dn_per_e * (excess_dn > 0 ? excess_dn : 0);
    const double dithered = noise >= kDitheringVarianceDn2 ? frames : 1;
    return noise / frames + quantisation_variance_dn2 / dithered;
  }

  static constexpr double kDitheringVarianceDn2 = 0.25;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_NOISE_MODEL_H_
