#include "optics/reduce/reduce_level.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "optics/photometry/scale_luminance.h"
#include "optics/reduce/compare_exposures.h"
#include "optics/reduce/count_pixels.h"
#include "optics/reduce/divide_by_flat.h"
#include "optics/reduce/expected_rate.h"
#include "optics/reduce/order_bracket.h"
#include "optics/reduce/reduce_band.h"
#include "optics/reduce/repair_defects.h"
#include "optics/reduce/variance_budget.h"

namespace eyebox::optics {
namespace {

double Share(size_t part, size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

// Large enough that the neighbours that a band looks at cost little.
constexpr int kBandPixels = 1 << 18;

std::vector<Rows> BandsOf(ImageSize size) {
  const int rows = std::max(kBandPixels / size.width_px, 1);
  std::vector<Rows> bands;
  for (int y = 0; y < size.height_px; y += rows) {
    bands.push_back({y, std::min(y + rows, size.height_px)});
  }
  return bands;
}

// In the order of the bands, so that the sums do not depend on which thread was faster.
BandSums Total(const std::vector<BandSums>& bands) {
  BandSums total = bands[0];
  for (size_t b = 1; b < bands.size(); ++b) {
    for (size_t k = 0; k < total.exposures.size(); ++k) {
      const PixelCounts& counts = bands[b].exposures[k];
      total.exposures[k].saturated += counts.saturated;
      total.exposures[k].underexposed += counts.underexposed;
      total.exposures[k].valid += counts.valid;
    }
    for (size_t k = 0; k < total.pairs.size(); ++k) {
      const PairSums& pair = bands[b].pairs[k];
      total.pairs[k].shorter += pair.shorter;
      total.pairs[k].longer += pair.longer;
      total.pairs[k].shorter_variance += pair.shorter_variance;
      total.pairs[k].longer_variance += pair.longer_variance;
      total.pairs[k].pixels += pair.pixels;
    }
  }
  return total;
}

void ReportExposures(std::span<const Exposure> bracket, const BandSums& sums, size_t pixels,
                     BracketReport& report) {
  for (size_t k = 0; k < bracket.size(); ++k) {
    const Stack& light = *bracket[k].light;
    const PixelCounts& counts = sums.exposures[k];
    report.exposures.push_back({light.setting.exposure_s, light.frames,
                                Share(counts.saturated, pixels), Share(counts.underexposed, pixels),
                                Share(counts.valid, pixels)});
    if (k == 0) continue;
    report.pairs.push_back(CompareExposures(
        sums.pairs[k - 1], bracket[k - 1].light->setting.exposure_s, light.setting.exposure_s));
  }
}

struct InvalidCounts {
  size_t invalid = 0;
  size_t all_saturated = 0;
  size_t all_dark = 0;
};

void ReportInvalid(const MeasuredImage& merged, BracketReport& report) {
  const auto mask = merged.mask.pixels();
  std::vector<InvalidCounts> pieces(ParallelPieces(mask.size()));
  ForEachPieceInParallel(mask.size(), [&](size_t first, size_t end) {
    const auto piece = mask.subspan(first, end - first);
    pieces[first / kParallelPiece] = {
        CountPixels(piece, [](uint8_t m) { return m != 0; }),
        CountPixels(piece, [](uint8_t m) { return m == kSaturated; }),
        CountPixels(piece, [](uint8_t m) { return m == kUnderexposed; })};
  });
  InvalidCounts total;
  for (const InvalidCounts& piece : pieces) {
    total.invalid += piece.invalid;
    total.all_saturated += piece.all_saturated;
    total.all_dark += piece.all_dark;
  }
  report.invalid_share = Share(total.invalid, mask.size());
  report.all_saturated_share = Share(total.all_saturated, mask.size());
  report.all_dark_share = Share(total.all_dark, mask.size());
}

// ReduceRate() without counting the invalid pixels.
absl::StatusOr<ReducedRate> Merge(std::span<const Stack> exposures, const Calibration& calibration,
                                  const ReduceOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<Exposure> bracket,
                          OrderBracket(exposures, calibration));
  const ImageSize size = bracket[0].light->size();
  ReducedRate reduced;
  reduced.rate = UnwrittenMeasuredImage(size, "DN/s");
  EYEBOX_ASSIGN_OR_RETURN(reduced.rate.history, HistoryOf(bracket, calibration, options));
  VarianceBudgetMeter budget(calibration.noise, calibration.linearity, size);
  const std::vector<Rows> bands = BandsOf(size);
  std::vector<BandSums> sums(bands.size());
  ForEachInParallel(static_cast<int>(bands.size()), [&](int b) {
    sums[b] = ReduceBand(bracket, calibration, options, bands[b], reduced.rate, budget);
  });
  const BandSums total = Total(sums);
  ReportExposures(bracket, total, size.PixelCount(), reduced.report);
  reduced.report.hot_share = calibration.defects.hot_share;
  reduced.report.budget = budget.Mean();
  return reduced;
}

}  // namespace

absl::StatusOr<ReducedRate> ReduceRate(std::span<const Stack> exposures,
                                       const Calibration& calibration,
                                       const ReduceOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(ReducedRate reduced, Merge(exposures, calibration, options));
  ReportInvalid(reduced.rate, reduced.report);
  return reduced;
}

absl::StatusOr<ReducedLevel> ReduceLevel(std::span<const Stack> exposures,
                                         const Calibration& calibration,
                                         const ReduceOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(ReducedRate reduced, Merge(exposures, calibration, options));
  std::optional<KnownLuminance> per_unit = calibration.luminance_of_one_dn_per_s;
  MeasuredImage image = std::move(reduced.rate);
  if (calibration.flat.has_value()) {
    const MeasuredImage& response = calibration.flat->response;
    EYEBOX_ASSIGN_OR_RETURN(image, DivideByFlat(std::move(image), response, options.flat_minimum));
    reduced.report.budget = WithFlat(reduced.report.budget, image, response);
    if (calibration.flat->luminance.has_value()) per_unit = calibration.flat->luminance;
  } else {
    image.history.push_back("no flat: vignetting and pixel response stay in the image");
  }
  ReportInvalid(image, reduced.report);
  EYEBOX_ASSIGN_OR_RETURN(LuminanceImage luminance,
                          ScaleLuminance(std::move(image), calibration.flat.has_value(), per_unit));
  reduced.report.budget =
      WithScale(reduced.report.budget, luminance.image, luminance.scale_relative_sigma);
  if (options.repair_defects) {
    luminance.image = RepairDefects(std::move(luminance.image), options.colour_period_px);
  }
  return ReducedLevel{std::move(luminance), std::move(reduced.report)};
}

}  // namespace eyebox::optics
