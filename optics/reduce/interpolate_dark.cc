#include "optics/reduce/interpolate_dark.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "optics/sensor/median.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestDarks = 3;
constexpr double kLargestClippedShare = 0.01;
// The noise model is not known better than this.
constexpr double kLargestReducedChi2 = 1.1;
constexpr double kSigmas = 5;
constexpr double kLargestMeanResidual = 0.1;  // of a pixel's sigma

absl::Status Refused(const Setting& setting, const std::string& why) {
  return Rejected(absl::StrCat("dark of ", Describe(setting)),
                  "none was recorded, and none can be interpolated: " + why,
                  "record darks of this exposure");
}

// Weighted straight line through points at `x`: its value at x[k] and at `at` as sums over points.
struct Line {
  Line(const std::vector<double>& exposures_s, const std::vector<double>& variances)
      : x(exposures_s) {
    for (size_t k = 0; k < x.size(); ++k) {
      weight.push_back(1 / variances[k]);
      total += weight[k];
      centre += weight[k] * x[k];
    }
    centre /= total;
    for (size_t k = 0; k < x.size(); ++k) spread += weight[k] * std::pow(x[k] - centre, 2);
  }

  // What point k contributes to the value at `at`.
  double Share(size_t k, double at) const {
    return weight[k] * (1 / total + (at - centre) * (x[k] - centre) / spread);
  }

  std::vector<double> x;
  std::vector<double> weight;
  double total = 0;
  double centre = 0;
  double spread = 0;
};

double TypicalVariance(const DarkFrame& dark, const Image<uint8_t>& defective) {
  std::vector<float> variances;
  const auto variance = dark.image_dn.variance.pixels();
  for (size_t i = 0; i < variance.size(); ++i) {
    if (dark.image_dn.mask.pixels()[i] == 0 && defective.pixels()[i] == 0) {
      variances.push_back(variance[i]);
    }
  }
  return variances.empty() ? 0 : Median(std::move(variances));
}

// The darks that can be compared, shortest first; of one exposure the first.
std::vector<const DarkFrame*> DarksOfGain(std::span<const DarkFrame> darks, const Setting& setting,
                                          ImageSize size) {
  std::vector<const DarkFrame*> found;
  for (const DarkFrame& dark : darks) {
    const bool same = SameSetting({1, dark.setting.gain_db}, {1, setting.gain_db});
    if (same && dark.image_dn.size() == size) found.push_back(&dark);
  }
  std::ranges::sort(found, {}, [](const DarkFrame* dark) { return dark->setting.exposure_s; });
  const auto same = [](const DarkFrame* a, const DarkFrame* b) {
    return SameSetting(a->setting, b->setting);
  };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

// Whether the darks lie on the line; residuals of all pixels and of each dark's mean.
absl::Status ProveLine(const std::vector<const DarkFrame*>& darks, const Line& line,
                       const Image<uint8_t>& defective, const Setting& setting) {
  const size_t count = darks.size();
  double chi2 = 0;
  double pixels = 0;
  std::vector<double> sums(count, 0.0);
  for (size_t i = 0; i < defective.pixels().size(); ++i) {
    bool usable = defective.pixels()[i] == 0;
    for (const DarkFrame* dark : darks) usable = usable && dark->image_dn.mask.pixels()[i] == 0;
    if (!usable) continue;
    ++pixels;
    for (size_t k = 0; k < count; ++k) {
      double residual = darks[k]->image_dn.value.pixels()[i];
      for (size_t j = 0; j < count; ++j) {
        residual -= line.Share(j, line.x[k]) * darks[j]->image_dn.value.pixels()[i];
      }
      sums[k] += residual;
      chi2 += residual * residual / darks[k]->image_dn.variance.pixels()[i];
    }
  }
  const double freedom = pixels * static_cast<double>(count - 2);
  if (freedom == 0) return Refused(setting, "no pixel is valid in all darks");
  const double reduced = chi2 / freedom;
  if (reduced > kLargestReducedChi2 + kSigmas * std::sqrt(2 / freedom)) {
    return Refused(setting, absl::StrFormat("the darks are not on a line in exposure (reduced "
                                            "chi-square %.3g over %.0f pixels)",
                                            reduced, pixels));
  }
  for (size_t k = 0; k < count; ++k) {
    const double sigma_dn = std::sqrt(1 / line.weight[k]);
    const double mean_dn = sums[k] / pixels;
    if (std::abs(mean_dn) <= sigma_dn * (kLargestMeanResidual + kSigmas / std::sqrt(pixels))) {
      continue;
    }
    return Refused(setting, absl::StrFormat("the dark of %g s lies %+.3g DN off the line of all",
                                            line.x[k], mean_dn));
  }
  return absl::OkStatus();
}

std::optional<double> MeanTemperature(const std::vector<const DarkFrame*>& darks, const Line& line,
                                      const Setting& setting) {
  double sum = 0;
  for (size_t k = 0; k < darks.size(); ++k) {
    if (!darks[k]->temperature_degC) return std::nullopt;
    sum += line.Share(k, setting.exposure_s) * *darks[k]->temperature_degC;
  }
  return sum;
}

DarkFrame Evaluate(const std::vector<const DarkFrame*>& darks, const Line& line,
                   const Setting& setting) {
  DarkFrame result{setting, MakeMeasuredImage(darks[0]->image_dn.size(), "DN")};
  MeasuredImage& image = result.image_dn;
  std::string names;
  for (size_t k = 0; k < darks.size(); ++k) {
    const auto share = static_cast<float>(line.Share(k, setting.exposure_s));
    const MeasuredImage& dark = darks[k]->image_dn;
    for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
      image.value.pixels()[i] += share * dark.value.pixels()[i];
      image.variance.pixels()[i] += share * share * dark.variance.pixels()[i];
      image.mask.pixels()[i] = static_cast<uint8_t>(image.mask.pixels()[i] | dark.mask.pixels()[i]);
    }
    result.clipped_share = std::max(result.clipped_share, darks[k]->clipped_share);
    absl::StrAppend(&names, k > 0 ? ", " : "", line.x[k], " s");
  }
  BlankMaskedPixels(image);
  result.temperature_degC = MeanTemperature(darks, line, setting);
  if (const auto longest = darks.back()->dark_current_dn) {
    result.dark_current_dn = *longest * setting.exposure_s / darks.back()->setting.exposure_s;
  }
  image.history.push_back(
      absl::StrCat("InterpolateDark(", Describe(setting), ", from darks of ", names, ")"));
  return result;
}

}  // namespace

absl::StatusOr<DarkFrame> InterpolateDark(std::span<const DarkFrame> darks,
                                          const Image<uint8_t>& defective, const Setting& setting) {
  const auto usable = DarksOfGain(darks, setting, defective.size());
  if (usable.size() < kFewestDarks) {
    return Refused(setting, absl::StrCat("there are darks of ", usable.size(), " exposures, and ",
                                         kFewestDarks, " can show whether they lie on a line"));
  }
  std::vector<double> exposures_s;
  std::vector<double> variances;
  for (const DarkFrame* dark : usable) {
    if (dark->clipped_share > kLargestClippedShare) {
      return Refused(setting, absl::StrFormat("the camera clips %.0f %% of the pixels of the dark "
                                              "of %g s at 0 DN; raise its black level",
                                              100 * dark->clipped_share, dark->setting.exposure_s));
    }
    exposures_s.push_back(dark->setting.exposure_s);
    variances.push_back(TypicalVariance(*dark, defective));
    if (!(variances.back() > 0)) return Refused(setting, "a dark has no valid pixel");
  }
  if (setting.exposure_s < exposures_s.front() || setting.exposure_s > exposures_s.back()) {
    return Refused(setting, absl::StrFormat("it lies outside the darks, %g s to %g s",
                                            exposures_s.front(), exposures_s.back()));
  }
  const Line line(exposures_s, variances);
  EYEBOX_RETURN_IF_ERROR(ProveLine(usable, line, defective, setting));
  return Evaluate(usable, line, setting);
}

}  // namespace eyebox::optics
