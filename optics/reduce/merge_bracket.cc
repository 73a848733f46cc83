#include "optics/reduce/merge_bracket.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

EYEBOX_VECTORISE
void AddWeighted(const MeasuredImage& rate, MeasuredImage& sums) {
  const float* const value = rate.value.pixels().data();
  const float* const variance = rate.variance.pixels().data();
  const uint8_t* const mask = rate.mask.pixels().data();
  float* const weighted = sums.value.pixels().data();
  float* const weights = sums.variance.pixels().data();
  uint8_t* const reasons = sums.mask.pixels().data();
  const size_t count = rate.mask.pixels().size();
  for (size_t i = 0; i < count; ++i) {
    const float weight = 1.0F / variance[i];
    weights[i] += mask[i] == 0 ? weight : 0.0F;
    weighted[i] += mask[i] == 0 ? weight * value[i] : 0.0F;
    reasons[i] = static_cast<uint8_t>(reasons[i] | mask[i]);
  }
}

EYEBOX_VECTORISE
void DivideByWeights(MeasuredImage& sums) {
  float* const value = sums.value.pixels().data();
  float* const variance = sums.variance.pixels().data();
  uint8_t* const mask = sums.mask.pixels().data();
  const size_t count = sums.mask.pixels().size();
  for (size_t i = 0; i < count; ++i) {
    const bool valid = variance[i] > 0;
    const float merged_variance = 1.0F / variance[i];
    value[i] = value[i] * merged_variance;
    variance[i] = merged_variance;
    mask[i] = valid ? uint8_t{0} : mask[i];
  }
}

}  // namespace

absl::Status BracketMerger::Add(const MeasuredImage& rate) {
  if (exposures_ == 0) {
    sums_ = MakeMeasuredImage(rate.size(), rate.unit);
  } else if (rate.size() != sums_.size() || rate.unit != sums_.unit) {
    return BadInput(absl::StrCat("exposure ", exposures_ + 1, " of the bracket"),
                    "size or unit differ from the first exposure's",
                    "merge exposures of one stimulus and one region of interest");
  }
  AddWeighted(rate, sums_);
  for (const std::string& step : rate.history) sums_.history.push_back(step);
  ++exposures_;
  return absl::OkStatus();
}

absl::StatusOr<MeasuredImage> BracketMerger::Finish() {
  if (exposures_ == 0) {
    return Rejected("bracket", "it has no exposure", "record at least one");
  }
  DivideByWeights(sums_);
  BlankMaskedPixels(sums_);
  sums_.history.push_back(absl::StrCat("MergeBracket(", exposures_, " exposures)"));
  exposures_ = 0;
  return std::exchange(sums_, {});
}

absl::StatusOr<MeasuredImage> MergeBracket(std::span<const MeasuredImage> rates) {
  BracketMerger merger;
  for (const MeasuredImage& rate : rates) EYEBOX_RETURN_IF_ERROR(merger.Add(rate));
  return merger.Finish();
}

}  // namespace eyebox::optics
