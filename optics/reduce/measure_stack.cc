#include "optics/reduce/measure_stack.h"

#include <algorithm>
#include <span>

#include "absl/strings/str_cat.h"
#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

// The noise model in single precision, for whole rows. See NoiseModel::MeanVariance.
struct NoiseF {
  NoiseF(const NoiseModel& noise, int frame_count)
      : read(static_cast<float>(noise.read_variance_dn2)),
        gain(static_cast<float>(noise.gain_dn_per_e)),
        quantisation(static_cast<float>(noise.quantisation_variance_dn2)),
        bias_dn(static_cast<float>(noise.bias_dn)),
        per_frame(1.0F / static_cast<float>(frame_count)) {}

  float FrameNoise(float excess_dn) const { return read + gain * (excess_dn > 0 ? excess_dn : 0); }
  float MeanVariance(float frame_noise) const {
    const bool dithered = frame_noise >= static_cast<float>(NoiseModel::kDitheringVarianceDn2);
    return frame_noise * per_frame + quantisation * (dithered ? per_frame : 1.0F);
  }

  float read, gain, quantisation, bias_dn, per_frame;
};

float VarianceOfFewer(NoiseF noise, int frames, float expected_dn) {
  noise.per_frame = 1.0F / static_cast<float>(frames);
  return noise.MeanVariance(noise.FrameNoise(expected_dn - noise.bias_dn));
}

// Where frames were left out of the mean, fewer share the noise.
void AllowForRejected(const Stack& light, int y, const NoiseF& model, float exposure_s,
                      std::span<const float> expected_dn_s, std::span<const float> dark_dn,
                      std::span<float> variance) {
  if (light.rejected_count.empty()) return;
  const auto rejected = light.rejected_count.row(y);
  for (size_t x = 0; x < variance.size(); ++x) {
    if (rejected[x] == 0) continue;
    const float expected_dn = expected_dn_s[x] * exposure_s + dark_dn[x];
    variance[x] = VarianceOfFewer(model, light.frames - rejected[x], expected_dn);
  }
}

struct Rails {
  float upper_dn;
  float guard_squared;  // in units of the variance

  // Both distances are compared squared, to keep roots out of the loop.
  uint8_t Flags(float expected_dn, float frame_variance) const {
    const float below_upper = upper_dn - expected_dn;
    const float reach = guard_squared * frame_variance;
    const bool high = below_upper <= 0 || below_upper * below_upper <= reach;
    const bool low = expected_dn <= 0 || expected_dn * expected_dn <= reach;
    return static_cast<uint8_t>((high ? kSaturated : 0) | (low ? kUnderexposed : 0));
  }
};

Rails RailsOf(const Stack& light, double guard_sigmas) {
  return {static_cast<float>(light.range.SaturationDn()),
          static_cast<float>(guard_sigmas * guard_sigmas)};
}

struct RowInput {
  std::span<const float> expected_dn_s;
  std::span<const float> dark_dn;
  std::span<const uint8_t> saturation;
  std::span<const uint8_t> defective;
};

EYEBOX_VECTORISE
void MeasureRow(const RowInput& row, const NoiseF& model, const Rails& rails, float exposure_s,
                std::span<float> variance, std::span<uint8_t> mask) {
  const NoiseF noise = model;  // copies: what is written cannot be them
  const Rails limits = rails;
  const float* const expected = row.expected_dn_s.data();
  const float* const dark_dn = row.dark_dn.data();
  const uint8_t* const saturation = row.saturation.data();
  const uint8_t* const defective = row.defective.data();
  float* const variances = variance.data();
  uint8_t* const flags = mask.data();
  const size_t width = variance.size();
  for (size_t x = 0; x < width; ++x) {
    const float expected_dn = expected[x] * exposure_s + dark_dn[x];
    const float frame_noise = noise.FrameNoise(expected_dn - noise.bias_dn);
    // Saturation already implies a count next to the upper rail: no second reason is needed.
    const uint8_t railed = limits.Flags(expected_dn, frame_noise + noise.quantisation);
    const uint8_t reasons = saturation[x] != 0 ? saturation[x] : railed;
    variances[x] = noise.MeanVariance(frame_noise);
    flags[x] = static_cast<uint8_t>(reasons | (defective[x] != 0 ? kDefective : 0));
  }
}

// What MeasureAboveDark reads of one row.
struct RowAboveDark {
  const float* expected_dn_s;
  const float* mean_dn;
  const float* dark_dn;
  const float* dark_variance;
  const uint8_t* dark_mask;
  const uint8_t* saturation;
  const uint8_t* defective;
};

// MeasureRow, SubtractDark and blanking in one pass over the pixels. Nothing that is written is
// read: said here, because the compiler gives up comparing so many arrays.
EYEBOX_VECTORISE
void MeasureAboveDark(const RowAboveDark& row, const NoiseF& model, const Rails& rails,
                      float exposure_s, size_t width, float* __restrict__ values,
                      float* __restrict__ variances, uint8_t* __restrict__ flags) {
  const NoiseF noise = model;
  const Rails limits = rails;
  const RowAboveDark in = row;
  for (size_t x = 0; x < width; ++x) {
    const float expected_dn = in.expected_dn_s[x] * exposure_s + in.dark_dn[x];
    const float frame_noise = noise.FrameNoise(expected_dn - noise.bias_dn);
    const uint8_t railed = limits.Flags(expected_dn, frame_noise + noise.quantisation);
    const uint8_t reasons = in.saturation[x] != 0 ? in.saturation[x] : railed;
    const auto mask =
        static_cast<uint8_t>(reasons | (in.defective[x] != 0 ? kDefective : 0) | in.dark_mask[x]);
    const float value = in.mean_dn[x] - in.dark_dn[x];
    const float variance = noise.MeanVariance(frame_noise) + in.dark_variance[x];
    values[x] = mask != 0 ? kNoValue : value;
    variances[x] = mask != 0 ? kNoValue : variance;
    flags[x] = mask;
  }
}

}  // namespace

void MeasureRowAboveDark(const Exposure& exposure, int y, std::span<const float> expected_dn_s,
                         const NoiseModel& noise, const DefectMap& defects,
                         double rail_guard_sigmas, const MeasuredRow& counts) {
  const Stack& light = *exposure.light;
  const MeasuredImage& dark = exposure.dark->image_dn;
  const NoiseF model(noise, light.frames);
  const auto exposure_s = static_cast<float>(light.setting.exposure_s);
  const RowAboveDark row{expected_dn_s.data(),
                         light.mean_dn.row(y).data(),
                         dark.value.row(y).data(),
                         dark.variance.row(y).data(),
                         dark.mask.row(y).data(),
                         exposure.saturation.row(y - exposure.saturation_first_row).data(),
                         defects.defective.row(y).data()};
  MeasureAboveDark(row, model, RailsOf(light, rail_guard_sigmas), exposure_s, counts.size(),
                   counts.value.data(), counts.variance.data(), counts.mask.data());
  if (light.rejected_count.empty()) return;
  const auto rejected = light.rejected_count.row(y);
  for (size_t x = 0; x < counts.size(); ++x) {
    if (rejected[x] == 0 || counts.mask[x] != 0) continue;
    const float expected_dn = expected_dn_s[x] * exposure_s + row.dark_dn[x];
    counts.variance[x] =
        VarianceOfFewer(model, light.frames - rejected[x], expected_dn) + row.dark_variance[x];
  }
}

MeasuredImage MeasureStack(const Exposure& exposure, const Image<float>& expected_rate_dn_s,
                           const NoiseModel& noise, const DefectMap& defects,
                           double rail_guard_sigmas) {
  const Stack& light = *exposure.light;
  MeasuredImage image = UnwrittenMeasuredImage(light.size(), "DN");
  const NoiseF model(noise, light.frames);
  const Rails rails = RailsOf(light, rail_guard_sigmas);
  const auto exposure_s = static_cast<float>(light.setting.exposure_s);
  for (int y = 0; y < image.size().height_px; ++y) {
    const auto mean_dn = light.mean_dn.row(y);
    const auto dark_dn = exposure.dark->image_dn.value.row(y);
    const auto expected = expected_rate_dn_s.row(y);
    const auto saturation = exposure.saturation.row(y);
    const auto defective = defects.defective.row(y);
    const auto variance = image.variance.row(y);
    std::copy(mean_dn.begin(), mean_dn.end(), image.value.row(y).begin());
    MeasureRow({expected, dark_dn, saturation, defective}, model, rails, exposure_s, variance,
               image.mask.row(y));
    AllowForRejected(light, y, model, exposure_s, expected, dark_dn, variance);
  }
  BlankMaskedPixels(image);
  image.history.push_back(absl::StrCat("MeasureStack(", Describe(light.setting), ", frames ",
                                       light.frames, ", saturation ", light.range.SaturationDn(),
                                       " DN, rail guard ", rail_guard_sigmas, " sigma)"));
  return image;
}

}  // namespace eyebox::optics
