#include "optics/reduce/merge_bracket.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

EYEBOX_VECTORISE
void AddWeighted(const float* value, const float* variance, const uint8_t* mask, size_t count,
                 float* __restrict__ weighted, float* __restrict__ weights,
                 uint8_t* __restrict__ reasons) {
  for (size_t i = 0; i < count; ++i) {
    const float weight = 1.0F / variance[i];
    weights[i] += mask[i] == 0 ? weight : 0.0F;
    weighted[i] += mask[i] == 0 ? weight * value[i] : 0.0F;
    reasons[i] = static_cast<uint8_t>(reasons[i] | mask[i]);
  }
}

EYEBOX_VECTORISE
void DivideByWeights(size_t count, float* __restrict__ value, float* __restrict__ variance,
                     uint8_t* __restrict__ mask) {
  for (size_t i = 0; i < count; ++i) {
    const bool valid = variance[i] > 0;
    const float merged_variance = 1.0F / variance[i];
    const uint8_t reasons = valid ? uint8_t{0} : mask[i];
    value[i] = reasons != 0 ? kNoValue : value[i] * merged_variance;
    variance[i] = reasons != 0 ? kNoValue : merged_variance;
    mask[i] = reasons;
  }
}

}  // namespace

void AddToMerge(const ConstMeasuredRow& rate, const MeasuredRow& sums) {
  AddWeighted(rate.value.data(), rate.variance.data(), rate.mask.data(), rate.size(),
              sums.value.data(), sums.variance.data(), sums.mask.data());
}

void FinishMerge(const MeasuredRow& sums) {
  DivideByWeights(sums.size(), sums.value.data(), sums.variance.data(), sums.mask.data());
}

absl::Status BracketMerger::Add(const MeasuredImage& rate) {
  if (exposures_ == 0) {
    sums_ = MakeMeasuredImage(rate.size(), rate.unit);
  } else if (rate.size() != sums_.size() || rate.unit != sums_.unit) {
    return BadInput(absl::StrCat("exposure ", exposures_ + 1, " of the bracket"),
                    "size or unit differ from the first exposure's",
                    "merge exposures of one stimulus and one region of interest");
  }
  AddToMerge(PixelsOf(rate), PixelsOf(sums_));
  for (const std::string& step : rate.history) sums_.history.push_back(step);
  ++exposures_;
  return absl::OkStatus();
}

absl::StatusOr<MeasuredImage> BracketMerger::Finish() {
  if (exposures_ == 0) {
    return Rejected("bracket", "it has no exposure", "record at least one");
  }
  FinishMerge(PixelsOf(sums_));
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
