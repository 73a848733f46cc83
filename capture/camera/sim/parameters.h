// Everything that a simulated rig is made of, with the defaults of "sim:rift-s-like".
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_PARAMETERS_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_PARAMETERS_H_

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/geometry.h"
#include "capture/base/image.h"

namespace eyebox::capture {

// h(v) = max((v - v0) / (1 - v0), 0)^gamma.
struct ChannelParameters {
  double luminance_weight = 0;  // share of this primary in the luminance range
  double gamma = 2.3;
  double cutoff_drive = 0;  // v0
};

struct DisplayParameters {
  double minimum_luminance_cd_m2 = 0.19;  // L0
  double luminance_range_cd_m2 = 58.81;   // L1; the peak is L0 + L1 = 59 cd/m2
  std::array<ChannelParameters, 3> channels = {
      ChannelParameters{.luminance_weight = 0.22},
      ChannelParameters{.luminance_weight = 0.70},
      ChannelParameters{.luminance_weight = 0.08},
  };
};

// g(x), in units of half the image width (s, t) from the image centre, right and down positive:
// exp(-falloff ((s - s0)^2 + (t - t0)^2)) (1 + tilt_x s + tilt_y t + twist s t), divided by its
// value at the image centre.
struct NonuniformityParameters {
  double falloff = 0.15;
  double centre_s = 0.12;
  double centre_t = -0.08;
  double tilt_x = 0.010;
  double tilt_y = -0.015;
  double twist = 0.020;
};

// w(x): a Gaussian core and a Moffat tail (1 + (r / r_tail)^2)^-beta, cut off at tail_radius_px,
// together summing to 1. A core of 0 and a tail of weight 0 switch scatter off.
struct ScatterParameters {
  double core_sigma_px = 0.5;
  double tail_weight = 0.02;  // share of the light that goes into the tail
  double tail_scale_px = 20;  // r_tail
  double tail_beta = 1.5;
  int tail_radius_px = 80;
};

// EMVA 1288 linear model: DN = K (electrons of light + dark current t + offset) + bias.
struct SensorParameters {
  ImageSize size = {.width_px = 160, .height_px = 120};
  int bits = 12;
  // Electrons per second in a pixel on the axis, per cd/m2: aperture, quantum efficiency and pixel
  // area in one.
  double responsivity_e_s_per_cd_m2 = 20300;
  double photo_response_nonuniformity = 0.005;  // relative rms of the response (PRNU)
  double gain_dn_per_e = 0.2;                   // K at 0 dB
  double bias_dn = 64;
  double read_noise_e = 3;
  double offset_nonuniformity_e = 1;  // rms of the fixed offset (DSNU at zero exposure)
  double dark_current_e_s = 5;
  double dark_current_nonuniformity = 0.2;  // relative rms
  double hot_pixel_share = 0.001;
  double hot_current_min_e_s = 2000;  // hot pixels: log-uniform between these two
  double hot_current_max_e_s = 20000;
  double full_well_e = 20500;  // a little above what 12 bits hold, so that counts clip first
  double exposure_min_s = 1e-5;
  double exposure_max_s = 100;
  double gain_max_db = 24;
};

// What is wrong with the rig: by default nothing. Each is one stage of the forward model.
struct SimFaults {
  bool auto_exposure = false;  // the camera brings the mean to half scale, whatever it is told
  double gamma = 1;            // of the counts; full scale stays full scale
  int stale_frames = 0;        // after a change of exposure, still of the old one
  bool black_clamped = false;  // the camera takes the bias off, and what is below 0 is lost
  double strobe_period_s = 0;  // the display flashes once a period; 0: it is steady
  double strobe_duty = 0.2;
  double row_time_s = 0;        // each row begins so long after the one above; 0: global shutter
  double display_pixel_px = 0;  // camera pixels per display pixel; 0: no grid is seen
  double display_pixel_fill = 0.6;  // lit share of the pitch, in x and in y
  double stuck_gain_db = 0;         // the gain never goes below
  // The sensor warms up from 25 degC by so much, most of it in the first 40 presentations, and the
  // dark current doubles with every 7 K. With 0 it tells no temperature.
  double warming_kelvin = 0;
};

struct SimParameters {
  std::string name = "rift-s-like";
  DisplayParameters display;
  NonuniformityParameters nonuniformity;
  ScatterParameters scatter;
  // 160 px span 40 deg: 80 px / tan(20 deg). The axis goes through the image centre.
  PinholeGeometry geometry = {
      .focal_length_px = 219.8, .principal_x_px = 79.5, .principal_y_px = 59.5};
  bool vignetting = true;  // cos^4 of the field angle
  SensorParameters sensor;
  SimFaults faults;

  // Errors: InvalidArgument (names the field and its range).
  absl::Status Validate() const;
};

// "rift-s-like", "rift-s-like-cutoff" (v0 = 0.03) and "ideal" (uniform, no scatter, no vignetting,
// no defects, a deep 16-bit well so that shot noise is below 0.03 % at white).
// Errors: InvalidArgument (unknown name: lists the known ones).
absl::StatusOr<SimParameters> NamedSimParameters(std::string_view name);
std::vector<std::string> SimNames();

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_PARAMETERS_H_
