// What the exposures of one stimulus say about each other.
#ifndef EYEBOX_OPTICS_REDUCE_BRACKET_REPORT_H_
#define EYEBOX_OPTICS_REDUCE_BRACKET_REPORT_H_

#include <cstddef>
#include <vector>

namespace eyebox::optics {

// A linear sensor gives ratio 1: the departure is its nonlinearity (or flicker, or light that
// changed in between).
struct ExposurePairCheck {
  double shorter_s = 0;
  double longer_s = 0;
  // (signal_longer / signal_shorter) / (longer_s / shorter_s) and its standard uncertainty from
  // noise alone. Both NaN where the shorter exposure's signal is not above 3 sigma.
  double ratio = 0;
  double sigma = 0;
  size_t pixels = 0;  // valid in both exposures
};

struct ExposureShare {
  double exposure_s = 0;
  int frames = 0;
  double saturated = 0;     // share of pixels at the upper rail, before dilation
  double underexposed = 0;  // share of pixels at the lower rail
  double valid = 0;         // share of pixels that entered the merge
};

// Mean over the valid pixels of each term's part of the variance of the image. All but `scale` and
// `scatter_common` sum to 1: those errors are common to all pixels and not part of their variance.
struct VarianceBudget {
  double photon = 0;  // shot noise of the light
  double read = 0;
  double quantisation = 0;
  double dark = 0;  // noise of the dark frames, and shot noise of the dark current
  double flat = 0;
  double linearity = 0;  // of the linearity correction
  double scatter = 0;    // what the correction for scattered light added
  // What it added that all pixels share, over the variance of a pixel; like `scale` no part of it.
  double scatter_common = 0;
  // Variance of the luminance scale and of the corrections for drift, over that of a pixel.
  double scale = 0;
};

struct BracketReport {
  std::vector<ExposureShare> exposures;  // ascending exposure
  std::vector<ExposurePairCheck> pairs;  // neighbouring exposures, ascending
  double hot_share = 0;                  // defective pixels
  double invalid_share = 0;              // pixels without a value, for whatever reason
  double all_saturated_share = 0;        // saturated even in the shortest exposure
  double all_dark_share = 0;             // underexposed even in the longest exposure
  VarianceBudget budget;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_BRACKET_REPORT_H_
