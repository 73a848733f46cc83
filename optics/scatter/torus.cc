#include "optics/scatter/torus.h"

#include <algorithm>
#include <vector>

#include "opencv2/core.hpp"

namespace eyebox::optics {
namespace {

int PaddedLength(int length) {
  return 2 * cv::getOptimalDFTSize(std::max(length, 2));  // even, at least 4
}

cv::Mat Wrap(Image<float>& image) {
  return {image.size().height_px, image.size().width_px, CV_32F, image.pixels().data()};
}

// A packed spectrum holds real and imaginary parts of x frequency j in columns 2j - 1 and 2j, and
// those of x frequencies 0 and 1/2 per pixel down its first and last column.
class PackedGain {
 public:
  explicit PackedGain(ImageSize padded)
      : first_(padded.height_px), last_(padded.height_px), row_(padded.width_px) {}

  void Apply(int y_frequency, std::span<const float> gain, Image<float>& spectrum) {
    const int height = spectrum.size().height_px;
    for (size_t j = 1; j + 1 < gain.size(); ++j) row_[2 * j - 1] = row_[2 * j] = gain[j];
    MultiplyRow(spectrum.row(y_frequency));
    const bool has_twin = y_frequency > 0 && 2 * y_frequency < height;
    if (has_twin) MultiplyRow(spectrum.row(height - y_frequency));
    const int last_row = std::min(2 * y_frequency, height - 1);
    for (int y = std::max(2 * y_frequency - 1, 0); y <= last_row; ++y) {
      first_[y] = gain.front();
      last_[y] = gain.back();
    }
  }

  void Finish(Image<float>& spectrum) const {
    for (int y = 0; y < spectrum.size().height_px; ++y) {
      spectrum.row(y).front() *= first_[y];
      spectrum.row(y).back() *= last_[y];
    }
  }

 private:
  void MultiplyRow(std::span<float> values) const {
    const size_t end = values.size() - 1;
    for (size_t x = 1; x < end; ++x) values[x] *= row_[x];
  }

  std::vector<float> first_, last_, row_;
};

void Place(const Image<float>& image, Image<float>& work) {
  const int width = image.size().width_px;
  for (int y = 0; y < image.size().height_px; ++y) {
    const auto to = work.row(y);
    std::ranges::copy(image.row(y), to.begin());
    std::fill(to.begin() + width, to.end(), 0.0F);
  }
}

}  // namespace

Torus::Torus(ImageSize window)
    : window_(window), work_({PaddedLength(window.width_px), PaddedLength(window.height_px)}) {}

ImageSize Torus::frequencies() const {
  return {padded().width_px / 2 + 1, padded().height_px / 2 + 1};
}

Image<float> Torus::Transfer(const Image<float>& quadrant) {
  const auto [width, height] = padded();
  std::ranges::fill(work_.pixels(), 0.0F);
  for (int y = 0; y < window_.height_px; ++y) {
    for (int x = 0; x < window_.width_px; ++x) {
      const float weight = quadrant.at(x, y);
      for (const int row : {y, (height - y) % height}) {
        work_.at(x, row) = weight;
        work_.at((width - x) % width, row) = weight;
      }
    }
  }
  cv::Mat packed = Wrap(work_);
  cv::dft(packed, packed);
  Image<float> transfer(frequencies());
  for (int k = 0; k < transfer.size().height_px; ++k) {
    const auto row = transfer.row(k);
    for (size_t j = 1; j + 1 < row.size(); ++j) row[j] = work_.at(2 * static_cast<int>(j) - 1, k);
    const int packed_row = std::max(2 * k - 1, 0);
    row.front() = work_.row(packed_row).front();
    row.back() = work_.row(packed_row).back();
  }
  return transfer;
}

void Torus::Filter(Image<float>& image, const RowGain& row_gain) {
  Place(image, work_);
  cv::Mat packed = Wrap(work_);
  cv::dft(packed, packed, 0, window_.height_px);
  PackedGain packed_gain(padded());
  std::vector<float> gain(frequencies().width_px);
  for (int k = 0; k < frequencies().height_px; ++k) {
    row_gain(k, gain);
    packed_gain.Apply(k, gain, work_);
  }
  packed_gain.Finish(work_);
  cv::dft(packed, packed, cv::DFT_INVERSE | cv::DFT_SCALE, window_.height_px);
  for (int y = 0; y < window_.height_px; ++y) {
    std::ranges::copy(work_.row(y).first(window_.width_px), image.row(y).begin());
  }
}

void Torus::Filter(Image<float>& image, const Image<float>& transfer) {
  Filter(image, [&](int y_frequency, std::span<float> gain) {
    std::ranges::copy(transfer.row(y_frequency), gain.begin());
  });
}

}  // namespace eyebox::optics
