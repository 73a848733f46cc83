#include "optics/reduce/frame_stacker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr int kMaximumFrames = 65536;

// Every bit that is set in any pixel: cheaper than a maximum and tells the same of 2^bits - 1.
uint16_t BitsInUse(std::span<const uint16_t> pixels_dn) {
  uint16_t bits = 0;
  for (const uint16_t dn : pixels_dn) bits = static_cast<uint16_t>(bits | dn);
  return bits;
}

}  // namespace

bool SameSetting(const Setting& a, const Setting& b) {
  return std::abs(a.exposure_s - b.exposure_s) <= 1e-4 * std::max(a.exposure_s, b.exposure_s) &&
         std::abs(a.gain_db - b.gain_db) <= 1e-3;
}

std::string Describe(const Setting& setting) {
  return absl::StrCat("exposure ", setting.exposure_s, " s, gain ", setting.gain_db, " dB");
}

absl::Status FrameStacker::Add(const FrameView& frame) {
  EYEBOX_RETURN_IF_ERROR(Validate(range_));
  const size_t count = frame.size.PixelCount();
  const std::string where = absl::StrCat("frame ", frames_ + 1, " of ", Describe(setting_));
  if (count == 0 || frame.pixels_dn.size() != count) {
    return BadInput(where, "it has no pixels, or not as many as its size says", "re-read it");
  }
  if (frames_ > 0 && frame.size != sum_dn_.size()) {
    return BadInput(where,
                    absl::StrCat("it is ", frame.size.width_px, " x ", frame.size.height_px,
                                 " pixels, the frames before it ", sum_dn_.size().width_px, " x ",
                                 sum_dn_.size().height_px),
                    "stack frames of one size");
  }
  if (frames_ >= kMaximumFrames) {
    return BadInput(where, absl::StrCat("more than ", kMaximumFrames, " frames"), "split them");
  }
  if ((BitsInUse(frame.pixels_dn) >> range_.bits) != 0) {
    return BadInput(where, absl::StrCat("a count is above ", range_.FullScaleDn(), " DN"),
                    absl::StrCat("state more significant bits than ", range_.bits));
  }
  if (frames_ == 0) {
    sum_dn_ = Image<uint32_t>(frame.size);
    saturated_count_ = Image<uint8_t>(frame.size);
  }
  const auto saturation = static_cast<uint16_t>(range_.SaturationDn());
  const uint16_t* const dn = frame.pixels_dn.data();
  uint32_t* const sum = sum_dn_.pixels().data();
  uint8_t* const saturated = saturated_count_.pixels().data();
  for (size_t i = 0; i < count; ++i) {
    sum[i] += dn[i];
    const uint8_t counts = static_cast<uint8_t>((dn[i] >= saturation) & (saturated[i] != 255));
    saturated[i] = static_cast<uint8_t>(saturated[i] + counts);
  }
  ++frames_;
  return absl::OkStatus();
}

absl::StatusOr<Stack> FrameStacker::Finish() {
  if (frames_ == 0) {
    return Rejected(Describe(setting_), "no frame was recorded with this setting",
                    "record at least one");
  }
  Stack stack{setting_, range_, frames_, Image<float>(sum_dn_.size()), std::move(saturated_count_)};
  const double per_frame = 1.0 / frames_;
  const auto sums = sum_dn_.pixels();
  std::transform(sums.begin(), sums.end(), stack.mean_dn.pixels().begin(),
                 [per_frame](uint32_t sum) { return static_cast<float>(sum * per_frame); });
  frames_ = 0;
  sum_dn_ = {};
  saturated_count_ = {};
  return stack;
}

}  // namespace eyebox::optics
