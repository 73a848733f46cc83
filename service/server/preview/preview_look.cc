#include "service/server/preview/preview_look.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace eyebox::service {
namespace {

constexpr double kSaturatedFrom = 0.99;  // of full scale

void Measure(const FrameView& view, int full_scale_dn, v1::PreviewFrame& picture) {
  uint64_t sum = 0;
  size_t saturated = 0;
  const auto [lowest, highest] = std::ranges::minmax(view.pixels_dn);
  for (const uint16_t dn : view.pixels_dn) {
    sum += dn;
    saturated += dn >= kSaturatedFrom * full_scale_dn ? 1 : 0;
  }
  const auto count = static_cast<double>(view.pixels_dn.size());
  picture.set_lowest_dn(lowest);
  picture.set_highest_dn(highest);
  picture.set_mean_dn(static_cast<double>(sum) / count);
  picture.set_saturated_share(static_cast<double>(saturated) / count);
}

std::string BlockMeans(const FrameView& view, int block, int width, int height, int full_scale_dn) {
  std::string pixels;
  pixels.reserve(static_cast<size_t>(width) * height);
  std::vector<uint64_t> sums(width);
  for (int row = 0; row < height; ++row) {
    std::ranges::fill(sums, uint64_t{0});
    for (int y = row * block; y < (row + 1) * block; ++y) {
      const uint16_t* const line =
          view.pixels_dn.data() + static_cast<size_t>(y) * view.size.width_px;
      for (int x = 0; x < width * block; ++x) sums[x / block] += line[x];
    }
    for (const uint64_t sum : sums) {
      const double mean = static_cast<double>(sum) / (block * block);
      pixels.push_back(
          static_cast<char>(static_cast<int>(std::min(255 * mean / full_scale_dn, 255.0))));
    }
  }
  return pixels;
}

}  // namespace

v1::PreviewFrame PictureOf(const Frame& frame, int bits, int most_width_px) {
  const FrameView& view = frame.view;
  const int full_scale_dn = (1 << bits) - 1;
  const int block = (view.size.width_px + most_width_px - 1) / most_width_px;
  const int width = view.size.width_px / block;
  const int height = view.size.height_px / block;
  v1::PreviewFrame picture;
  picture.set_width_px(width);
  picture.set_height_px(height);
  picture.set_block_px(block);
  picture.set_pixels(BlockMeans(view, block, width, height, full_scale_dn));
  picture.set_full_scale_dn(full_scale_dn);
  picture.set_exposure_s(
      frame.metadata.exposure_reported_s.value_or(frame.metadata.exposure_asked_s));
  Measure(view, full_scale_dn, picture);
  return picture;
}

uint64_t PreviewLook::Listen(Listener listener) {
  const std::lock_guard lock(mutex_);
  listeners_.emplace(next_listener_, std::move(listener));
  return next_listener_++;
}

void PreviewLook::Leave(uint64_t listener) {
  const std::lock_guard lock(mutex_);
  listeners_.erase(listener);
  left_ = std::chrono::steady_clock::now();
}

absl::StatusOr<PreviewPicture> PreviewLook::Newest() const {
  const std::lock_guard lock(mutex_);
  if (over_) return *over_;
  return newest_;
}

void PreviewLook::Publish(v1::PreviewFrame picture) {
  {
    const std::lock_guard lock(mutex_);
    picture.set_frame(++pictures_);
    newest_ = std::make_shared<const v1::PreviewFrame>(std::move(picture));
  }
  Tell();
}

void PreviewLook::End(const absl::Status& why) {
  {
    const std::lock_guard lock(mutex_);
    over_ = why;
  }
  Tell();
}

std::chrono::steady_clock::duration PreviewLook::Unwatched() const {
  const std::lock_guard lock(mutex_);
  if (!listeners_.empty()) return {};
  return std::chrono::steady_clock::now() - left_;
}

void PreviewLook::Tell() {
  std::vector<Listener> listeners;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, listener] : listeners_) listeners.push_back(listener);
  }
  for (const Listener& listener : listeners) listener();
}

}  // namespace eyebox::service
