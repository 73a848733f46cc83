// A camera as EMVA 1288 models it, with every parameter known: electrons with shot noise, dark
// current, electronics noise, offsets and gains that differ from pixel to pixel, a full well,
// quantisation. Writes series as descriptor and images.
#ifndef EYEBOX_TESTS_OPTICS_EMVA1288_CAMERA_H_
#define EYEBOX_TESTS_OPTICS_EMVA1288_CAMERA_H_

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "capture/base/image.h"

namespace eyebox::optics {

struct Emva1288CameraTruth {
  int bits = 14;
  double gain_dn_per_e = 0.08;
  double quantum_efficiency = 0.6;
  double dark_noise_e = 20;
  double dark_current_e_s = 500;
  double dsnu_e = 30;
  double prnu = 0.003;
  double full_well_e = 200000;
  double offset_dn = 100;
  double compression = 0;  // of the signal at full well: e (1 - compression e / full well)
};

class Emva1288Camera {
 public:
  Emva1288Camera(const Emva1288CameraTruth& made_with, ImageSize size, uint64_t seed)
      : truth(made_with), offset_e(size), response(size), random_(seed) {
    for (float& offset : offset_e.pixels()) offset = static_cast<float>(truth.dsnu_e * Normal());
    for (float& r : response.pixels()) r = static_cast<float>(1 + truth.prnu * Normal());
  }

  const Emva1288CameraTruth truth;
  Image<float> offset_e;
  Image<float> response;

  Image<uint16_t> Expose(double photons, double exposure_s) {
    Image<uint16_t> image(response.size());
    const double full_scale = (1 << truth.bits) - 1;
    const double dark_e = truth.dark_current_e_s * exposure_s;
    for (size_t i = 0; i < image.pixels().size(); ++i) {
      const double light_e = photons * truth.quantum_efficiency * response.pixels()[i];
      double electrons = Poisson(light_e + dark_e) + truth.dark_noise_e * Normal();
      electrons = std::min(electrons + offset_e.pixels()[i], truth.full_well_e);
      electrons *= 1 - truth.compression * std::max(electrons, 0.0) / truth.full_well_e;
      const double dn = std::round(truth.gain_dn_per_e * electrons + truth.offset_dn);
      image.pixels()[i] = static_cast<uint16_t>(std::clamp(dn, 0.0, full_scale));
    }
    return image;
  }

  double PhotonsFor(double electrons) const { return electrons / truth.quantum_efficiency; }

 private:
  double Normal() { return normal_(random_); }
  double Poisson(double mean) {
    if (mean > 1000) return mean + std::sqrt(mean) * Normal();
    return mean > 0 ? static_cast<double>(std::poisson_distribution<long>(mean)(random_)) : 0;
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

inline void WriteGreyPng(const std::filesystem::path& file, const Image<uint16_t>& image) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.size().width_px);
  header.height = static_cast<png_uint_32>(image.size().height_px);
  header.format = PNG_FORMAT_LINEAR_Y;  // 16 bits, stored as they are
  header.flags = PNG_IMAGE_FLAG_FAST;
  ASSERT_NE(png_image_write_to_file(&header, file.c_str(), 0, image.pixels().data(), 0, nullptr), 0)
      << header.message;
}

// Writes folder/series.txt and its images as 16-bit PNG, set by set.
class DescriptorWriter {
 public:
  DescriptorWriter(std::filesystem::path folder, Emva1288Camera& camera)
      : folder_(std::move(folder)), camera_(camera) {
    std::filesystem::create_directories(folder_ / "images");
    const ImageSize size = camera.response.size();
    text_ = "# written by a test\nv 3.0\nn " + std::to_string(camera.truth.bits) + " " +
            std::to_string(size.width_px) + " " + std::to_string(size.height_px) + "\n";
  }

  void AddBright(double exposure_s, double photons, int images) {
    text_ += "b " + Number(exposure_s * 1e9) + " " + Number(photons) + "\n";
    AddImages(photons, exposure_s, images);
  }
  void AddDark(double exposure_s, int images) {
    text_ += "d " + Number(exposure_s * 1e9) + "\n";
    AddImages(0, exposure_s, images);
  }

  std::filesystem::path Finish() {
    std::ofstream(folder_ / "series.txt") << text_;
    return folder_ / "series.txt";
  }

 private:
  static std::string Number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
  }

  void AddImages(double photons, double exposure_s, int images) {
    for (int k = 0; k < images; ++k) {
      Image<uint16_t> image = camera_.Expose(photons, exposure_s);
      const std::string name = "img_" + std::to_string(++count_) + ".png";
      WriteGreyPng(folder_ / "images" / name, image);
      text_ += "i images\\" + name + "\n";
    }
  }

  std::filesystem::path folder_;
  Emva1288Camera& camera_;
  std::string text_;
  int count_ = 0;
};

// The electron counts of a series: even steps to 0.94 of the full well, then finer ones through it,
// since the standard finds saturation at a step.
inline std::vector<double> StepsOf(const Emva1288CameraTruth& truth) {
  std::vector<double> electrons;
  for (double share = 0.02; share < 0.945; share += 0.02) {
    electrons.push_back(share * truth.full_well_e);
  }
  for (double share = 0.95; share < 1.032; share += 0.005) {
    electrons.push_back(share * truth.full_well_e);
  }
  return electrons;
}

inline constexpr double kSeriesExposure_s = 0.01;

// Pairs at every step, a pair of darks at five exposures, stacks of 16 at half of the full well.
inline std::filesystem::path WriteSeries(const std::filesystem::path& folder,
                                         Emva1288Camera& camera) {
  DescriptorWriter writer(folder, camera);
  for (const double electrons : StepsOf(camera.truth)) {
    writer.AddBright(kSeriesExposure_s, camera.PhotonsFor(electrons), 2);
  }
  for (const double exposure_s : {kSeriesExposure_s, 0.1, 0.2, 0.3, 0.4}) {
    writer.AddDark(exposure_s, 2);
  }
  writer.AddBright(kSeriesExposure_s, camera.PhotonsFor(0.5 * camera.truth.full_well_e), 16);
  writer.AddDark(kSeriesExposure_s, 16);
  return writer.Finish();
}

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_OPTICS_EMVA1288_CAMERA_H_
