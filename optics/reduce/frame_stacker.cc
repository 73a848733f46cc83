#include "optics/reduce/frame_stacker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

constexpr int kMaximumFrames = 65536;
constexpr int kSumBits = 16;
// What a thread adds before it goes on: near enough to be read twice.
constexpr size_t kPieceInCache = 1 << 12;

// What the counts of some pixels have in common.
struct Counts {
  uint16_t bits = 0;       // every bit that is set in any: tells of 2^bits - 1 what a maximum would
  bool saturated = false;  // any
};

EYEBOX_VECTORISE
Counts LookAt(std::span<const uint16_t> pixels_dn, uint16_t saturation) {
  Counts counts;
  uint16_t reached = 0;
  for (const uint16_t dn : pixels_dn) {
    counts.bits = static_cast<uint16_t>(counts.bits | dn);
    reached = static_cast<uint16_t>(reached | (dn >= saturation ? 1 : 0));
  }
  counts.saturated = reached != 0;
  return counts;
}

// The first of a sum is written, not added: the sum need not be cleared before.
template <typename Sum>
void AddTo(std::span<const uint16_t> dn, bool is_first, std::span<Sum> sum) {
  if (is_first) {
    std::copy(dn.begin(), dn.end(), sum.begin());
    return;
  }
  for (size_t i = 0; i < dn.size(); ++i) sum[i] = static_cast<Sum>(sum[i] + dn[i]);
}

EYEBOX_VECTORISE
void CountSaturated(std::span<const uint16_t> dn, uint16_t saturation, std::span<uint8_t> count) {
  for (size_t i = 0; i < dn.size(); ++i) {
    const uint8_t more = static_cast<uint8_t>((dn[i] >= saturation) & (count[i] != 255));
    count[i] = static_cast<uint8_t>(count[i] + more);
  }
}

// Sorts each count in among the two highest and the two lowest. `first`: of the extremes' pixels.
EYEBOX_VECTORISE
void SortIn(std::span<const uint16_t> dn, size_t first, Extremes& extremes) {
  uint16_t* const highest = extremes.highest.pixels().data() + first;
  uint16_t* const second_highest = extremes.second_highest.pixels().data() + first;
  uint16_t* const second_lowest = extremes.second_lowest.pixels().data() + first;
  uint16_t* const lowest = extremes.lowest.pixels().data() + first;
  for (size_t i = 0; i < dn.size(); ++i) {
    second_highest[i] = std::max(second_highest[i], std::min(highest[i], dn[i]));
    highest[i] = std::max(highest[i], dn[i]);
    second_lowest[i] = std::min(second_lowest[i], std::max(lowest[i], dn[i]));
    lowest[i] = std::min(lowest[i], dn[i]);
  }
}

}  // namespace

bool SameSetting(const Setting& a, const Setting& b) {
  return std::abs(a.exposure_s - b.exposure_s) <= 1e-4 * std::max(a.exposure_s, b.exposure_s) &&
         std::abs(a.gain_db - b.gain_db) <= 1e-3;
}

std::string Describe(const Setting& setting) {
  return absl::StrCat("exposure ", setting.exposure_s, " s, gain ", setting.gain_db, " dB");
}

absl::Status FrameStacker::Add(const FrameView& frame, std::optional<double> temperature_deg_c) {
  EYEBOX_RETURN_IF_ERROR(Validate(range_));
  const size_t count = frame.size.PixelCount();
  const std::string where = absl::StrCat("frame ", frames_ + 1, " of ", Describe(setting_));
  if (count == 0 || frame.pixels_dn.size() != count) {
    return BadInput(where, "it has no pixels, or not as many as its size says", "re-read it");
  }
  if (frames_ > 0 && frame.size != partial_dn_.size()) {
    return BadInput(where,
                    absl::StrCat("it is ", frame.size.width_px, " x ", frame.size.height_px,
                                 " pixels, the frames before it ", partial_dn_.size().width_px,
                                 " x ", partial_dn_.size().height_px),
                    "stack frames of one size");
  }
  if (frames_ >= kMaximumFrames) {
    return BadInput(where, absl::StrCat("more than ", kMaximumFrames, " frames"), "split them");
  }
  if (frames_ == 0) Begin(frame.size);
  if (partial_frames_ == PartialCapacity()) FlushPartial();
  const uint16_t bits = AddPieces(frame.pixels_dn);
  if ((bits >> range_.bits) != 0) {
    *this = FrameStacker(setting_, range_, keep_extremes_);
    return BadInput(where, absl::StrCat("a count is above ", range_.FullScaleDn(), " DN"),
                    absl::StrCat("state more significant bits than ", range_.bits));
  }
  if (temperature_deg_c && std::isfinite(*temperature_deg_c)) {
    ++temperatures_;
    temperature_sum_ += *temperature_deg_c;
  }
  ++frames_;
  ++partial_frames_;
  return absl::OkStatus();
}

int FrameStacker::PartialCapacity() const { return 1 << (kSumBits - range_.bits); }

void FrameStacker::Begin(ImageSize size) {
  partial_dn_ = Image<uint16_t>::Unwritten(size);
  saturated_count_ = Image<uint8_t>(size);
  partial_frames_ = 0;
  if (!keep_extremes_) return;
  constexpr uint16_t kAboveAll = 65535;
  extremes_ = Extremes{Image<uint16_t>(size), Image<uint16_t>(size),
                       Image<uint16_t>(size, kAboveAll), Image<uint16_t>(size, kAboveAll)};
}

uint16_t FrameStacker::AddPieces(std::span<const uint16_t> pixels_dn) {
  const auto saturation = static_cast<uint16_t>(range_.SaturationDn());
  std::vector<uint16_t> bits(ParallelPieces(pixels_dn.size()));
  ForEachPieceInParallel(pixels_dn.size(), [&](size_t first, size_t end) {
    uint16_t& in_use = bits[first / kParallelPiece];
    for (size_t begin = first; begin < end; begin += kPieceInCache) {
      const size_t count = std::min(kPieceInCache, end - begin);
      const auto dn = pixels_dn.subspan(begin, count);
      const Counts counts = LookAt(dn, saturation);
      in_use = static_cast<uint16_t>(in_use | counts.bits);
      AddTo(dn, partial_frames_ == 0, partial_dn_.pixels().subspan(begin, count));
      if (extremes_) SortIn(dn, begin, *extremes_);
      if (!counts.saturated) continue;
      CountSaturated(dn, saturation, saturated_count_.pixels().subspan(begin, count));
    }
  });
  uint16_t all = 0;
  for (const uint16_t some : bits) all = static_cast<uint16_t>(all | some);
  return all;
}

void FrameStacker::FlushPartial() {
  const bool is_first = sum_dn_.empty();
  if (is_first) sum_dn_ = Image<uint32_t>::Unwritten(partial_dn_.size());
  ForEachPieceInParallel(sum_dn_.pixels().size(), [&](size_t first, size_t end) {
    AddTo<uint32_t>(partial_dn_.pixels().subspan(first, end - first), is_first,
                    sum_dn_.pixels().subspan(first, end - first));
  });
  partial_frames_ = 0;
}

absl::StatusOr<Stack> FrameStacker::Finish() {
  if (frames_ == 0) {
    return Rejected(Describe(setting_), "no frame was recorded with this setting",
                    "record at least one");
  }
  Stack stack{setting_, range_, frames_, Image<float>::Unwritten(partial_dn_.size()),
              std::move(saturated_count_)};
  const double per_frame = 1.0 / frames_;
  ForEachPieceInParallel(partial_dn_.pixels().size(), [&](size_t first, size_t end) {
    const uint16_t* const partial = partial_dn_.pixels().data();
    float* const mean = stack.mean_dn.pixels().data();
    if (sum_dn_.empty()) {
      for (size_t i = first; i < end; ++i) mean[i] = static_cast<float>(partial[i] * per_frame);
      return;
    }
    const uint32_t* const sum = sum_dn_.pixels().data();
    for (size_t i = first; i < end; ++i) {
      mean[i] = static_cast<float>((sum[i] + partial[i]) * per_frame);
    }
  });
  stack.extremes = std::move(extremes_);
  if (temperatures_ == frames_) stack.temperature_degC = temperature_sum_ / frames_;
  *this = FrameStacker(setting_, range_, keep_extremes_);
  return stack;
}

}  // namespace eyebox::optics
