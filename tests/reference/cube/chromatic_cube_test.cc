// A three-dimensional cube made from the readings of a real display, judged by an evaluator that
// shares nothing with the designer: it reads the text of the file and the named parameters of the
// fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "fit/color/colour_table.h"
#include "fit/color/fit_colour.h"

namespace eyebox::fit {
namespace {

using Triple = std::array<double, 3>;

// x = z + sum_k h_k(v_k + c_k (sum of the others) / 2) p_k.
class Display {
 public:
  explicit Display(const std::vector<Parameter>& parameters) {
    for (const Parameter& parameter : parameters) values_[parameter.name] = parameter.value;
  }

  Triple Show(const Triple& v) const {
    Triple xyz = {values_.at("background_x"), values_.at("background_y"),
                  values_.at("background_z")};
    for (int k = 0; k < 3; ++k) {
      const std::string channel(1, "rgb"[k]);
      const double others = v[0] + v[1] + v[2] - v[k];
      const double effective = v[k] + values_.at("crosstalk_" + channel) * others / 2;
      const double cutoff = values_.at("cutoff_drive_" + channel);
      const double base = std::max((effective - cutoff) / (1 - cutoff), 0.0);
      const double h = base > 0 ? std::exp(values_.at("gamma_" + channel) * std::log(base)) : 0;
      for (int c = 0; c < 3; ++c) {
        xyz[c] += h * values_.at("primary_" + channel + "_" + "xyz"[c]);
      }
    }
    return xyz;
  }

 private:
  std::map<std::string, double> values_;
};

// The text of a .cube file through HDRP's LogC sampler and the sRGB encoding.
class Renderer {
 public:
  explicit Renderer(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      if (line.rfind("LUT_3D_SIZE", 0) == 0) {
        words.ignore(11);
        words >> size_;
      }
      Triple entry;
      if (words >> entry[0] >> entry[1] >> entry[2]) entries_.push_back(entry);
    }
  }

  size_t EntryCount() const { return entries_.size(); }

  Triple Drive(const Triple& u) const {
    std::array<double, 3> place;
    for (int k = 0; k < 3; ++k) {
      const double log_c = 0.244161 * std::log10(5.555556 * u[k] + 0.047996) + 0.386036;
      place[k] = std::min(std::max(log_c, 0.0), 1.0) * (size_ - 1);
    }
    Triple drive;
    for (int k = 0; k < 3; ++k) drive[k] = Encode(AlongBlue(place, k));
    return drive;
  }

 private:
  double At(int r, int g, int b, int k) const {
    return entries_[static_cast<size_t>(r) + size_ * (g + static_cast<size_t>(size_) * b)][k];
  }
  static double Mix(double a, double b, double t) { return a + t * (b - a); }
  int Below(double place) const { return std::min(static_cast<int>(place), size_ - 2); }
  double AlongRed(const Triple& place, int g, int b, int k) const {
    const int r = Below(place[0]);
    return Mix(At(r, g, b, k), At(r + 1, g, b, k), place[0] - r);
  }
  double AlongGreen(const Triple& place, int b, int k) const {
    const int g = Below(place[1]);
    return Mix(AlongRed(place, g, b, k), AlongRed(place, g + 1, b, k), place[1] - g);
  }
  double AlongBlue(const Triple& place, int k) const {
    const int b = Below(place[2]);
    return Mix(AlongGreen(place, b, k), AlongGreen(place, b + 1, k), place[2] - b);
  }
  static double Encode(double linear) {
    const double encoded =
        linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return std::min(std::max(encoded, 0.0), 1.0);
  }

  int size_ = 0;
  std::vector<Triple> entries_;
};

double DeltaUv(const Triple& a, const Triple& b) {
  const double da = a[0] + 15 * a[1] + 3 * a[2];
  const double db = b[0] + 15 * b[1] + 3 * b[2];
  return std::hypot(4 * a[0] / da - 4 * b[0] / db, 9 * a[1] / da - 9 * b[1] / db);
}

class ChromaticCubeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path file = std::filesystem::path(EYEBOX_SOURCE_DIR) /
                                       "../shared/reference/luminance/chromatic_118.csv";
    if (!std::filesystem::exists(file)) {
      GTEST_SKIP() << file << " is absent: no real series to fit";
    }
    const auto series = ReadColourSeriesCsv(file);
    ASSERT_TRUE(series.ok()) << series.status();
    const auto fit = FitColour(*series, ColourModelKind::kDriveCrosstalk);
    ASSERT_TRUE(fit.ok()) << fit.status();
    fit_ = *fit;
  }

  // Certificate and evaluator agree along white and the primaries.
  void ExpectCertified(const ColourTable& table, const Renderer& renderer) const {
    const Display display(fit_.parameters);
    const std::array<Triple, 4> directions = {{{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (size_t i = 0; i < directions.size(); ++i) {
      double worst = 0;
      double worst_uv = 0;
      for (int step = 0; step <= 20000; ++step) {
        const double t = std::pow(0.05, 1 - step / 20000.0);
        const Triple u = {t * directions[i][0], t * directions[i][1], t * directions[i][2]};
        const Triple wanted = table.goal.Wanted(u);
        const Triple shown = display.Show(renderer.Drive(u));
        const double black = display.Show({0, 0, 0})[1];
        worst = std::max(worst, std::abs(shown[1] / std::max(wanted[1], black) - 1));
        worst_uv = std::max(worst_uv, DeltaUv(shown, wanted));
      }
      const RampCertificate& ramp = table.ramps[i];
      std::printf(
          "  %-5s evaluator %.3f %%, certificate %.3f %% (rms %.3f %%, at u %.3f); u'v' "
          "%.4f, %.4f\n",
          ramp.name.c_str(), 100 * worst, 100 * ramp.luminance.max_relative,
          100 * ramp.luminance.rms_relative, ramp.luminance.at_u, worst_uv,
          ramp.max_chromaticity_error);
      EXPECT_NEAR(worst, ramp.luminance.max_relative, 2e-5) << ramp.name;
      EXPECT_NEAR(worst_uv, ramp.max_chromaticity_error, 2e-5) << ramp.name;
    }
  }

  void ExpectInterior(const ColourTable& table, const Renderer& renderer) const {
    const Display display(fit_.parameters);
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(0.05, 1);
    std::vector<double> errors;
    for (int i = 0; i < 20000; ++i) {
      const Triple u = {uniform(generator), uniform(generator), uniform(generator)};
      const Triple wanted = table.goal.Wanted(u);
      errors.push_back(std::abs(display.Show(renderer.Drive(u))[1] / wanted[1] - 1));
    }
    std::ranges::sort(errors);
    const double nearly_worst = errors[errors.size() * 999 / 1000];
    std::printf("  interior: 99.9th percentile %.3f %%, certificate max %.3f %%\n",
                100 * nearly_worst, 100 * table.interior.max_relative);
    EXPECT_LE(nearly_worst, 1.2 * table.interior.max_relative);
  }

  ColourFit fit_;
};

TEST_F(ChromaticCubeTest, CertificateHoldsForAnotherEvaluator) {
  for (ColourGamut gamut : {ColourGamut::kNative, ColourGamut::kSrgb, ColourGamut::kP3}) {
    for (int size : {32, 64}) {
      ColourTableOptions options;
      options.goal.gamut = gamut;
      const auto table = DesignColourTable(fit_.model, TableTarget::kHdrp, size, options);
      ASSERT_TRUE(table.ok()) << table.status();
      const auto text = EncodeColourTable(*table);
      ASSERT_TRUE(text.ok()) << text.status();
      const Renderer renderer(*text);
      ASSERT_EQ(renderer.EntryCount(), static_cast<size_t>(size) * size * size);
      std::printf(
          "%s %d: white %.2f cd/m2, %.3f of the maximum; of %d entries %d outside the "
          "gamut (u'v' %.4f), %d limited by black, %d too bright; %d of %d interior "
          "colours outside\n",
          NameOf(gamut).data(), size, table->goal.White()[1], table->goal.share_of_maximum,
          table->entries.in_range, table->entries.outside_gamut,
          table->entries.max_chromaticity_error, table->entries.limited_by_black,
          table->entries.too_bright, table->interior.colours_outside, table->interior.colours);
      ExpectCertified(*table, renderer);
      ExpectInterior(*table, renderer);
      // Blue is the worst: at u = 0.05 it stands close above the light of black.
      EXPECT_LE(table->ramps[0].luminance.max_relative, size == 32 ? 0.005 : 0.0015);
      for (const RampCertificate& ramp : table->ramps) {
        EXPECT_LE(ramp.luminance.max_relative, size == 32 ? 0.02 : 0.008) << ramp.name;
      }
      EXPECT_EQ(table->entries.too_bright, 0);
      EXPECT_EQ(table->entries.outside_gamut > 0, gamut != ColourGamut::kNative);
    }
  }
}

}  // namespace
}  // namespace eyebox::fit
