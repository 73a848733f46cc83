#include "optics/reduce/variance_budget.h"

#include <algorithm>

namespace eyebox::optics {
namespace {

constexpr size_t kSamples = 1 << 16;

// Smallest stride that leaves at most kSamples, odd so that it meets every colour of a mosaic.
size_t StrideFor(size_t pixels) { return ((pixels + kSamples - 1) / kSamples) | 1; }

int FramesAt(const Stack& stack, size_t i) {
  return stack.frames - (stack.rejected_count.empty() ? 0 : stack.rejected_count.pixels()[i]);
}

// The terms of one exposure's variance, (DN/s)^2; their sum is `variance`.
VarianceBudget TermsOf(const NoiseModel& noise, const LinearityCurve::Corrected& corrected,
                       const Setting& setting, int frames, double expected_dn, double dark_dn,
                       double variance) {
  const double per_s2_unscaled = 1 / (setting.exposure_s * setting.exposure_s);
  const double per_s2 = corrected.slope * corrected.slope * per_s2_unscaled;
  const double excess_dn = std::max(expected_dn + dark_dn - noise.bias_dn, 0.0);
  const double light_dn = std::clamp(expected_dn, 0.0, excess_dn);
  const double all = noise.MeanVariance(excess_dn, frames);
  const double shot_and_read = (noise.read_variance_dn2 + noise.gain_dn_per_e * excess_dn) / frames;
  VarianceBudget terms;
  terms.photon = noise.gain_dn_per_e * light_dn / frames * per_s2;
  terms.read = noise.read_variance_dn2 / frames * per_s2;
  terms.quantisation = (all - shot_and_read) * per_s2;
  terms.linearity = corrected.variance_dn2 * per_s2_unscaled;
  terms.dark = variance - terms.photon - terms.read - terms.quantisation - terms.linearity;
  return terms;
}

void AddScaled(const VarianceBudget& terms, double factor, VarianceBudget& sum) {
  sum.photon += factor * terms.photon;
  sum.read += factor * terms.read;
  sum.quantisation += factor * terms.quantisation;
  sum.dark += factor * terms.dark;
  sum.flat += factor * terms.flat;
  sum.linearity += factor * terms.linearity;
  sum.scatter += factor * terms.scatter;
}

// Mean of `ratio(i)` over evenly sampled valid pixels; 0 if there is none.
template <typename Ratio>
double MeanOfValid(const MeasuredImage& image, const Ratio& ratio) {
  const auto mask = image.mask.pixels();
  double sum = 0;
  size_t valid = 0;
  for (size_t i = 0; i < mask.size(); i += StrideFor(mask.size())) {
    if (mask[i] != 0) continue;
    sum += ratio(i);
    ++valid;
  }
  return valid == 0 ? 0 : sum / static_cast<double>(valid);
}

}  // namespace

VarianceBudgetMeter::VarianceBudgetMeter(const NoiseModel& noise,
                                         const std::optional<LinearityCurve>& linearity,
                                         ImageSize size)
    : noise_(noise),
      linearity_(linearity),
      stride_(StrideFor(size.PixelCount())),
      pixels_((size.PixelCount() + stride_ - 1) / stride_) {}

void VarianceBudgetMeter::Add(const Exposure& exposure, const ConstMeasuredRow& rate,
                              std::span<const float> expected_rate_dn_s, size_t first) {
  const Setting& setting = exposure.light->setting;
  const size_t end = first + rate.size();
  for (size_t k = (first + stride_ - 1) / stride_; k * stride_ < end; ++k) {
    const size_t i = k * stride_ - first;
    if (rate.mask[i] != 0) continue;
    const double variance = rate.variance[i];
    const double expected_dn = expected_rate_dn_s[i] * setting.exposure_s;
    const LinearityCurve::Corrected corrected =
        linearity_ ? linearity_->At(expected_dn) : LinearityCurve::Corrected{};
    const VarianceBudget terms =
        TermsOf(noise_, corrected, setting, FramesAt(*exposure.light, first + i), expected_dn,
                exposure.dark->image_dn.value.pixels()[first + i], variance);
    AddScaled(terms, 1 / (variance * variance), pixels_[k].terms);
    pixels_[k].weight += 1 / variance;
  }
}

VarianceBudget VarianceBudgetMeter::Mean() const {
  const auto valid =
      std::count_if(pixels_.begin(), pixels_.end(), [](const auto& p) { return p.weight > 0; });
  VarianceBudget mean;
  for (const PixelSums& pixel : pixels_) {
    if (pixel.weight > 0) {
      AddScaled(pixel.terms, 1 / (pixel.weight * static_cast<double>(valid)), mean);
    }
  }
  return mean;
}

VarianceBudget WithShare(const VarianceBudget& budget, double VarianceBudget::*term, double share) {
  VarianceBudget with_share;
  AddScaled(budget, 1 - share, with_share);
  with_share.*term += share;
  with_share.scale = budget.scale * (1 - share);
  return with_share;
}

VarianceBudget WithScale(const VarianceBudget& budget, const MeasuredImage& image,
                         double relative_sigma) {
  VarianceBudget with_scale = budget;
  with_scale.scale = MeanOfValid(image, [&](size_t i) {
    const double common = relative_sigma * image.value.pixels()[i];
    return common * common / image.variance.pixels()[i];
  });
  return with_scale;
}

VarianceBudget WithFlat(const VarianceBudget& budget, const MeasuredImage& ratio,
                        const MeasuredImage& response) {
  const double flat = MeanOfValid(ratio, [&](size_t i) {
    const double relative = ratio.value.pixels()[i] / response.value.pixels()[i];
    return relative * relative * response.variance.pixels()[i] / ratio.variance.pixels()[i];
  });
  return WithShare(budget, &VarianceBudget::flat, flat);
}

}  // namespace eyebox::optics
