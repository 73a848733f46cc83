#include "service/preflight/moire.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "service/preflight/fisher_test.h"
#include "service/preflight/smooth_field.h"
#include "service/preflight/spectrum.h"

namespace eyebox::service {
namespace {

constexpr size_t kRings = 6;
constexpr size_t kAxes = 2;

struct Wave {
  double power = 0;
  double x_per_px = 0;  // cycles per pixel
  double y_per_px = 0;
  double Frequency() const { return std::hypot(x_per_px, y_per_px); }
};

Image<double> Middle(const Image<double>& image, int largest_side_px) {
  const ImageSize size = {.width_px = std::min(image.size().width_px, largest_side_px),
                          .height_px = std::min(image.size().height_px, largest_side_px)};
  const int left = (image.size().width_px - size.width_px) / 2;
  const int top = (image.size().height_px - size.height_px) / 2;
  Image<double> middle(size);
  for (int y = 0; y < size.height_px; ++y) {
    const auto from = image.row(top + y).subspan(static_cast<size_t>(left), size.width_px);
    std::ranges::copy(from, middle.row(y).begin());
  }
  return middle;
}

// The two axes (the Hann window spreads them by one bin), then rings of about as many waves each.
// The half plane is taken once: of kx = 0 the upper half alone.
std::array<std::vector<Wave>, kAxes + kRings> Groups(const Image<double>& texture,
                                                     const MoireOptions& options) {
  const ImageSize size = texture.size();
  const Image<double> power = PowerSpectrum(texture);
  const double least = options.least_cycles / std::min(size.width_px, size.height_px);
  std::array<std::vector<Wave>, kAxes + kRings> groups;
  std::vector<Wave> rest;
  for (int row = 0; row < size.height_px; ++row) {
    const int ky = 2 * row > size.height_px ? row - size.height_px : row;
    for (int kx = 0; kx < power.size().width_px; ++kx) {
      if (kx == 0 && ky < 0) continue;
      const Wave wave = {.power = power.at(kx, row),
                         .x_per_px = static_cast<double>(kx) / size.width_px,
                         .y_per_px = static_cast<double>(ky) / size.height_px};
      if (wave.Frequency() < least) continue;
      const bool across = std::abs(ky) <= 1;
      (across ? groups[0] : kx <= 1 ? groups[1] : rest).push_back(wave);
    }
  }
  std::ranges::sort(rest, {}, &Wave::Frequency);
  for (size_t i = 0; i < rest.size(); ++i) {
    groups[kAxes + i * kRings / rest.size()].push_back(rest[i]);
  }
  return groups;
}

struct Strongest {
  Wave wave;
  double false_alarm_probability = 1;
  double amplitude_at_limit = 0;
};

Strongest StrongestWave(const std::array<std::vector<Wave>, kAxes + kRings>& groups,
                        double false_alarm_limit) {
  Strongest strongest;
  bool found_real = false;
  for (const std::vector<Wave>& group : groups) {
    if (group.size() < 2) continue;
    std::vector<double> powers;
    double sum = 0;
    for (const Wave& wave : group) sum += powers.emplace_back(wave.power);
    const SpectralPeak peak = LargestPeak(powers);
    const double probability =
        std::min(1.0, peak.false_alarm_probability * static_cast<double>(groups.size()));
    // Of the peaks that are real the highest is told, which is rarely the least probable.
    const bool real = probability <= false_alarm_limit;
    const bool more = real && found_real ? group[peak.index].power > strongest.wave.power
                                         : probability < strongest.false_alarm_probability;
    if (!more) continue;
    found_real = real;
    const double limit = false_alarm_limit / static_cast<double>(groups.size());
    strongest = {.wave = group[peak.index],
                 .false_alarm_probability = probability,
                 .amplitude_at_limit = std::sqrt(sum * ShareAt(limit, group.size()))};
  }
  return strongest;
}

// Where the fundamental of the display's grid appears once sampled, cycles per pixel.
double Alias(double camera_px_per_display_px) {
  const double frequency = 1 / camera_px_per_display_px;
  return std::abs(frequency - std::round(frequency));
}

void AddExpectation(const MoireOptions& options, Check& check) {
  if (!options.camera_px_per_display_px) return;
  const double alias = Alias(*options.camera_px_per_display_px);
  check.figures.push_back({"camera_px_per_display_px", *options.camera_px_per_display_px, 0, "px"});
  // No period: the grids are in step, and the beat is as wide as the field.
  if (alias > 0) check.figures.push_back({"expected_period", 1 / alias, 0, "px"});
}

std::string CauseOf(const Strongest& found, const MoireOptions& options) {
  std::string cause = absl::StrFormat(
      "moire: a pattern of %.1f px period, %.2g %% high: camera and display pixels beat",
      1 / found.wave.Frequency(), 100 * std::sqrt(found.wave.power));
  if (options.camera_px_per_display_px) {
    absl::StrAppend(&cause, absl::StrFormat(" (%.3g camera pixels per display pixel)",
                                            *options.camera_px_per_display_px));
  }
  return cause;
}

}  // namespace

Check CheckMoire(const Image<double>& field, const MoireOptions& options) {
  Check check = {.name = "moire",
                 .wanted = absl::StrFormat("no spectral peak (false alarm above %g)",
                                           options.false_alarm_probability),
                 .threshold = options.false_alarm_probability};
  AddExpectation(options, check);
  const Image<double> texture = RelativeTexture(Middle(field, options.largest_side_px));
  if (texture.empty()) {
    return std::move(check).Skipped("there is no full field of at least 16 x 16 lit pixels",
                                    "show a full field that fills the middle of the image");
  }
  const Strongest found = StrongestWave(Groups(texture, options), options.false_alarm_probability);
  check.measured = Figure{"false_alarm_probability", found.false_alarm_probability, 0, "1"};
  check.figures.push_back({"moire_amplitude", std::sqrt(found.wave.power), 0, "1"});
  check.figures.push_back({"amplitude_at_limit", found.amplitude_at_limit, 0, "1"});
  if (found.wave.power > 0) {
    check.figures.push_back({"moire_period", 1 / found.wave.Frequency(), 0, "px"});
  }
  if (found.false_alarm_probability > options.false_alarm_probability) return check;
  return std::move(check).Failed(
      CauseOf(found, options),
      "defocus slightly, close the aperture, turn the camera about its axis or change its distance "
      "so that a display pixel covers 3 camera pixels or more; average over whole display pixels");
}

}  // namespace eyebox::service
