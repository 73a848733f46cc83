#include "optics/scatter/correct_scatter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/scatter/block_image.h"
#include "optics/scatter/kernel_grid.h"
#include "optics/scatter/spread_light.h"

namespace eyebox::optics {
namespace {

constexpr double kLeastStructure = 0.01;  // of the noise: an image without any is not smoothed away
constexpr double kRounding = 3e-7;        // of the brightest pixel, float32 through two transforms
constexpr int kGainRows = 8;              // every so many frequencies are asked for the noise gain
constexpr float kLost = 1e-8F;            // squared transfer below which w has left nothing
constexpr float kSmallest = 1e-12F;       // keeps 0 / 0 out where W vanishes

// 2 - 2 cos of the frequencies 0 .. 1/2 per pixel.
std::vector<float> Roughness(int frequencies) {
  std::vector<float> roughness(frequencies);
  for (int k = 0; k < frequencies; ++k) {
    const double angle = std::numbers::pi * k / std::max(frequencies - 1, 1);
    roughness[k] = static_cast<float>(2 - 2 * std::cos(angle));
  }
  return roughness;
}

absl::Status BadPixel(const MeasuredImage& image, size_t i) {
  const size_t width = image.size().width_px;
  return BadInput(
      absl::StrCat("image, pixel (", i % width, ", ", i / width, ")"),
      absl::StrCat("value ", image.value.pixels()[i], ", variance ", image.variance.pixels()[i]),
      "mask it, or give finite numbers");
}

struct Statistics {
  size_t valid = 0;
  double light = 0;           // sum
  double noise_variance = 0;  // mean
  float brightest = 0;
};

absl::StatusOr<Statistics> Survey(const MeasuredImage& image) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  Statistics found;
  const auto value = image.value.pixels();
  const auto variance = image.variance.pixels();
  const auto mask = image.mask.pixels();
  for (size_t i = 0; i < value.size(); ++i) {
    if (mask[i] != 0) continue;
    const float magnitude = std::abs(value[i]);
    if (!(magnitude <= kLargest && variance[i] >= 0 && variance[i] <= kLargest)) {
      return BadPixel(image, i);
    }
    ++found.valid;
    found.light += value[i];
    found.noise_variance += variance[i];
    found.brightest = std::max(found.brightest, magnitude);
  }
  if (found.valid > 0) found.noise_variance /= static_cast<double>(found.valid);
  return found;
}

bool AnyMasked(const MeasuredImage& image, const Statistics& found) {
  return found.valid < image.size().PixelCount();
}

// Of an image that is dark outside, as the transform sees it.
double MeanSquaredGradient(const Image<float>& image) {
  const auto [width, height] = image.size();
  double sum = 0;
  for (int y = 0; y < height; ++y) {
    const auto row = image.row(y);
    const auto above = image.row(std::max(y - 1, 0));
    float squares = row[0] * row[0] + row[width - 1] * row[width - 1];
    for (int x = 1; x < width; ++x) squares += (row[x] - row[x - 1]) * (row[x] - row[x - 1]);
    for (int x = 0; x < width; ++x) squares += (row[x] - above[x]) * (row[x] - above[x]);
    sum += squares;
  }
  for (const float value : image.row(0)) sum += static_cast<double>(value) * value;
  for (const float value : image.row(height - 1)) sum += static_cast<double>(value) * value;
  return sum / static_cast<double>(image.size().PixelCount());
}

// Noise over signal, both per unit of 1 / frequency^2. Noise itself has a gradient: 4 variances.
double ChooseRegularisation(const Image<float>& image, double noise_variance) {
  if (!(noise_variance > 0)) return 0;
  const double noise_gradient = 4 * noise_variance;
  const double structure = MeanSquaredGradient(image) - noise_gradient;
  return noise_variance / std::max(structure, kLeastStructure * noise_gradient);
}

// The same in all but value, variance and floor, which are there to be filled.
ScatterCorrection Blank(const LuminanceImage& reading) {
  ScatterCorrection correction;
  LuminanceImage& luminance = correction.luminance;
  luminance.scale_relative_sigma = reading.scale_relative_sigma;
  luminance.absolute = reading.absolute;
  luminance.flat_corrected = reading.flat_corrected;
  luminance.image.unit = reading.image.unit;
  luminance.image.history = reading.image.history;
  luminance.image.mask = reading.image.mask;
  luminance.image.variance = Image<float>(reading.image.size());
  correction.floor = Image<float>(reading.image.size());
  return correction;
}

}  // namespace

absl::Status CorrectionOptions::Validate() const {
  if (!(glare_relative_sigma >= 0 && std::isfinite(glare_relative_sigma))) {
    return BadInput("glare_relative_sigma", absl::StrCat(glare_relative_sigma),
                    "give a standard uncertainty of at least 0");
  }
  if (!(floor_tolerance > 0 && std::isfinite(floor_tolerance))) {
    return BadInput("floor_tolerance", absl::StrCat(floor_tolerance), "give a share above 0");
  }
  if (!(floor_sigmas > 0 && std::isfinite(floor_sigmas))) {
    return BadInput("floor_sigmas", absl::StrCat(floor_sigmas), "give a number above 0");
  }
  return absl::OkStatus();
}

// What the blocks say of the full image.
struct ScatterCorrector::Wide {
  Image<float> edge;          // added to the deconvolved light
  Image<float> far_variance;  // added to the variance
  Image<float> guessed;       // glare of the light of masked pixels; empty where none is
  double near_gain = 1;       // of a pixel's own noise
};

absl::StatusOr<ScatterCorrector> ScatterCorrector::Create(const ScatterKernel& kernel,
                                                          ImageSize size, double pitch_deg,
                                                          const CorrectionOptions& options) {
  EYEBOX_RETURN_IF_ERROR(kernel.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckGrid(size, pitch_deg));
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  return ScatterCorrector(kernel, size, pitch_deg, options);
}

ScatterCorrector::ScatterCorrector(const ScatterKernel& kernel, ImageSize size, double pitch_deg,
                                   const CorrectionOptions& options)
    : kernel_(kernel),
      options_(options),
      torus_(size),
      whole_(torus_.Transfer(SampleKernel(RadialWeight(kernel), pitch_deg, size))),
      core_(torus_.Transfer(SampleKernel(RadialWeight(CoreOf(kernel)), pitch_deg, size))),
      wide_glare_(kernel, size, pitch_deg) {}

// Returns the noise gain: the mean over frequencies of the squared gain.
double ScatterCorrector::Deconvolve(double lambda, Image<float>& light) {
  const std::vector<float> across = Roughness(torus_.frequencies().width_px);
  const std::vector<float> down = Roughness(torus_.frequencies().height_px);
  const auto strength = static_cast<float>(lambda);
  const bool keep_core = options_.keep_core;
  const auto of_core = static_cast<float>(1 / kernel_.CoreShare());
  double squares = 0;
  size_t asked = 0;
  torus_.Filter(light, [&](int y_frequency, std::span<float> gain) {
    const float* const whole = whole_.row(y_frequency).data();
    const float* const core = core_.row(y_frequency).data();
    const float* const rough = across.data();
    const float rough_down = down[y_frequency];
    for (size_t j = 0; j < gain.size(); ++j) {
      if (keep_core) {
        gain[j] = (core[j] * whole[j] + kLost * of_core) / (whole[j] * whole[j] + kLost);
        continue;
      }
      const float lost = std::max(1 - core[j] * core[j], 0.0F);
      const float penalty = strength * (rough[j] + rough_down) * lost;
      gain[j] = whole[j] / (whole[j] * whole[j] + penalty + kSmallest);
    }
    if (y_frequency % kGainRows != 0) return;
    for (const float g : gain) squares += static_cast<double>(g) * g;
    asked += gain.size();
  });
  return squares / static_cast<double>(asked);
}

ScatterCorrector::Wide ScatterCorrector::Spread(const MeasuredImage& reading,
                                                const Image<float>& filled, bool any_masked) {
  const int block = wide_glare_.block_px();
  Wide wide;
  wide.edge = wide_glare_.EdgeCorrection(BlockMeans(filled, block));
  wide.far_variance = wide_glare_.FarVariance(BlockMeans(reading.variance, block));
  if (!any_masked) return wide;
  Image<float> guessed(filled.size());
  for (size_t i = 0; i < guessed.pixels().size(); ++i) {
    guessed.pixels()[i] = reading.mask.pixels()[i] != 0 ? std::abs(filled.pixels()[i]) : 0.0F;
  }
  wide.guessed = wide_glare_.GlareOf(BlockMeans(guessed, block));
  return wide;
}

// `correction` arrives with the deconvolved light as its value and the mask of the reading, whose
// masked pixels have NaN for their noise. It leaves the number of pixels below the floor as a
// share.
void ScatterCorrector::Finish(const Wide& wide, const MeasuredImage& reading,
                              const Image<float>& filled, double brightest,
                              ScatterCorrection& correction) const {
  const int block = wide_glare_.block_px();
  const auto [width, height] = reading.size();
  const auto near_gain = static_cast<float>(wide.near_gain);
  const auto kernel_square = static_cast<float>(std::pow(options_.glare_relative_sigma, 2));
  const auto rounding_square = static_cast<float>(std::pow(kRounding * brightest, 2));
  const auto reach = static_cast<float>(options_.floor_sigmas / options_.floor_tolerance);
  std::vector<float> edge(width), far(width), guessed(width);
  for (int y = 0; y < height; ++y) {
    ExpandRow(wide.edge, block, y, edge);
    ExpandRow(wide.far_variance, block, y, far);
    if (!wide.guessed.empty()) ExpandRow(wide.guessed, block, y, guessed);
    const auto before = filled.row(y);
    const auto noise = reading.variance.row(y);
    const auto mask = reading.mask.row(y);
    const auto value = correction.luminance.image.value.row(y);
    const auto variance = correction.luminance.image.variance.row(y);
    const auto floor = correction.floor.row(y);
    for (int x = 0; x < width; ++x) {
      value[x] = mask[x] == 0 ? value[x] + edge[x] : kNoValue;
      variance[x] = near_gain * (mask[x] == 0 ? noise[x] : kNoValue) + far[x];
      const float glare = before[x] - value[x];
      floor[x] = reach * std::sqrt(variance[x] + kernel_square * glare * glare +
                                   guessed[x] * guessed[x] + rounding_square);
    }
    for (int x = 0; x < width; ++x) {
      if (mask[x] != 0) continue;
      correction.light_after += value[x];
      correction.below_floor_share += value[x] < floor[x] ? 1 : 0;
    }
  }
}

absl::StatusOr<ScatterCorrection> ScatterCorrector::Correct(const LuminanceImage& reading) {
  const MeasuredImage& image = reading.image;
  if (image.size() != torus_.window()) {
    return BadInput("image", absl::StrCat(image.size().width_px, " x ", image.size().height_px),
                    absl::StrCat("give ", torus_.window().width_px, " x ",
                                 torus_.window().height_px, " pixels, as prepared for"));
  }
  EYEBOX_ASSIGN_OR_RETURN(const Statistics found, Survey(image));
  if (found.valid == 0) {
    ScatterCorrection nothing;
    nothing.luminance = reading;
    nothing.floor = Image<float>(image.size(), kNoValue);
    return nothing;
  }
  Image<float> own;  // only if there is something to fill in
  if (AnyMasked(image, found)) {
    own = image.value;
    FillMasked(image.mask, own);
  }
  const Image<float>& filled = own.empty() ? image.value : own;
  ScatterCorrection correction = Blank(reading);
  if (!options_.keep_core) {
    correction.regularisation = ChooseRegularisation(filled, found.noise_variance);
  }
  correction.luminance.image.value = filled;
  correction.noise_gain = Deconvolve(correction.regularisation, correction.luminance.image.value);
  Wide wide = Spread(image, filled, !own.empty());
  wide.near_gain = std::max(correction.noise_gain - wide_glare_.FarNoiseGain(), 0.0);
  Finish(wide, image, filled, found.brightest, correction);
  correction.light_before = found.light;
  correction.below_floor_share /= static_cast<double>(found.valid);
  correction.luminance.image.history.push_back(absl::StrCat(
      "CorrectScatter(tail ", kernel_.tail_share, ", pedestal ", kernel_.pedestal_share,
      ", lambda ", correction.regularisation, options_.keep_core ? ", core kept)" : ")"));
  return correction;
}

}  // namespace eyebox::optics
