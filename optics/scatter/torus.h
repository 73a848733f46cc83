// Convolution with even kernels by FFT, on a grid so much larger than the image that nothing wraps
// around into it.
#ifndef EYEBOX_OPTICS_SCATTER_TORUS_H_
#define EYEBOX_OPTICS_SCATTER_TORUS_H_

#include <functional>
#include <span>

#include "capture/base/image.h"

namespace eyebox::optics {

// Smallest even sizes that cv::dft likes, at least twice the image less one. Not thread-safe: it
// owns the memory in which it works.
class Torus {
 public:
  explicit Torus(ImageSize window);

  ImageSize window() const { return window_; }
  ImageSize padded() const { return work_.size(); }
  // Of transfers and gains: padded / 2 + 1 each way, frequencies 0 .. 1/2 per pixel.
  ImageSize frequencies() const;

  // Discrete Fourier transform of the even kernel whose quadrant, of the window's size, is given:
  // real and even, [frequencies]. At frequency 0 it is the sum of the kernel.
  Image<float> Transfer(const Image<float>& quadrant);

  // Fills the gains of all x frequencies at one y frequency. Called once for each, in order.
  using RowGain = std::function<void(int y_frequency, std::span<float> gain)>;
  // image <- image (0 around it) times the gains in frequency. Size of the window.
  void Filter(Image<float>& image, const RowGain& row_gain);
  void Filter(Image<float>& image, const Image<float>& transfer);

 private:
  ImageSize window_;
  Image<float> work_;  // [padded]: the image with its margin, then its packed spectrum
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_TORUS_H_
