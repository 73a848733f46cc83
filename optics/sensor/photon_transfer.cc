#include "optics/sensor/photon_transfer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/sensor/median.h"

namespace eyebox::optics {
namespace {

constexpr double kFewestPixels = 100;    // in a bin of a pair
constexpr double kWorstGainSigma = 0.2;  // relative
constexpr double kClippedSigmas = 3;     // closer to 0 DN than this, the noise is cut off
constexpr double kLowestCountDn = 1;     // likewise

struct PairBin {
  double pixels = 0;
  double difference = 0;
  double difference_squared = 0;
  double signal = 0;
};

double MedianCount(const Image<float>& image) {
  return Median({image.pixels().begin(), image.pixels().end()});
}

double UpperSignalDn(const Stack& bias, const PhotonTransferOptions& options) {
  const double bias_dn = MedianCount(bias.mean_dn);
  return std::max(options.fitted_fraction * (bias.range.SaturationDn() - bias_dn), 1.0);
}

bool IsClipped(double count_dn, double variance_dn2) {
  return count_dn <= kLowestCountDn ||
         count_dn * count_dn <= kClippedSigmas * kClippedSigmas * variance_dn2;
}

}  // namespace

PhotonTransfer::PhotonTransfer(Stack bias, Image<uint8_t> defects,
                               const PhotonTransferOptions& options)
    : bias_(std::move(bias)),
      defects_(std::move(defects)),
      options_(options),
      bias_median_dn_(MedianCount(bias_.mean_dn)),
      upper_signal_dn_(UpperSignalDn(bias_, options)),
      light_(options.bins),
      tiles_(options.bins, upper_signal_dn_, options.colour_period_px) {}

void PhotonTransfer::BeginCapture(FrameKind kind) {
  EndCapture();
  kind_ = kind;
}

void PhotonTransfer::EndCapture() {
  if (frames_in_capture_ == 1 && kind_ != FrameKind::kDark) {
    tiles_.Add({previous_.pixels(), previous_.size()}, bias_median_dn_, bias_.range.SaturationDn(),
               defects_);
  }
  frames_in_capture_ = 0;
}

absl::Status PhotonTransfer::AddFrame(const FrameView& frame) {
  if (frame.size != bias_.size() || frame.pixels_dn.size() != frame.size.PixelCount()) {
    return BadInput(absl::StrCat("frame ", frames_in_capture_ + 1),
                    "its size differs from the dark's",
                    "record lights and darks with one region of interest");
  }
  ++frames_in_capture_;
  if (frames_in_capture_ % 2 == 0) {
    AddPair({previous_.pixels(), previous_.size()}, frame);
    return absl::OkStatus();
  }
  if (previous_.empty()) previous_ = Image<uint16_t>(frame.size);
  std::copy(frame.pixels_dn.begin(), frame.pixels_dn.end(), previous_.pixels().begin());
  return absl::OkStatus();
}

// The last element stands for signals above the fitted range.
size_t PhotonTransfer::BinOf(double signal_dn) const {
  const double position = std::max(signal_dn, 0.0) / upper_signal_dn_ * options_.bins;
  return static_cast<size_t>(std::min(position, static_cast<double>(options_.bins)));
}

void PhotonTransfer::AddPair(const FrameView& first, const FrameView& second) {
  std::vector<PairBin> bins(static_cast<size_t>(options_.bins) + 1);
  const size_t count = first.pixels_dn.size();
  const size_t stride = count / options_.pixels_per_pair + 1;
  const auto saturation = static_cast<uint16_t>(bias_.range.SaturationDn());
  const auto bias_dn = bias_.mean_dn.pixels();
  for (size_t i = 0; i < count; i += stride) {
    const uint16_t a = first.pixels_dn[i];
    const uint16_t b = second.pixels_dn[i];
    if (a >= saturation || b >= saturation) continue;
    if (!defects_.empty() && defects_.pixels()[i] != 0) continue;
    const double signal_dn = 0.5 * (a + b) - bias_dn[i];
    const double difference = static_cast<double>(a) - b;
    PairBin& bin = bins[kind_ == FrameKind::kDark ? 0 : BinOf(signal_dn)];
    ++bin.pixels;
    bin.difference += difference;
    bin.difference_squared += difference * difference;
    bin.signal += signal_dn;
  }
  for (int k = 0; k < options_.bins; ++k) {
    const PairBin& pair = bins[k];
    if (pair.pixels < kFewestPixels) continue;
    const double freedom = pair.pixels - 1;
    const double variance =
        0.5 * (pair.difference_squared - pair.difference * pair.difference / pair.pixels) / freedom;
    Bin& bin = kind_ == FrameKind::kDark ? dark_ : light_[k];
    bin.freedom += freedom;
    bin.freedom_variance += freedom * variance;
    bin.freedom_signal += freedom * pair.signal / pair.pixels;
  }
  saw_light_pair_ |= kind_ != FrameKind::kDark;
}

std::vector<PhotonTransferPoint> PhotonTransfer::Points() const {
  std::vector<PhotonTransferPoint> points;
  const auto add = [&](const Bin& bin) {
    if (bin.freedom <= 0) return;
    const double signal_dn = bin.freedom_signal / bin.freedom;
    const double variance_dn2 = bin.freedom_variance / bin.freedom;
    if (IsClipped(signal_dn + bias_median_dn_, variance_dn2)) return;
    points.push_back({signal_dn, variance_dn2, bin.freedom});
  };
  add(dark_);
  if (saw_light_pair_) {
    for (const Bin& bin : light_) add(bin);
  } else {
    const std::vector<PhotonTransferPoint> spatial = tiles_.Points();
    points.insert(points.end(), spatial.begin(), spatial.end());
  }
  return points;
}

absl::StatusOr<NoiseModel> PhotonTransfer::Fit() {
  EndCapture();
  const VarianceLine line =
      saw_light_pair_ ? FitVarianceLine(Points()) : FitTexturedVarianceLine(Points());
  const bool determined = line.slope_sigma_dn > 0 && line.slope_dn > 0 &&
                          line.slope_sigma_dn <= kWorstGainSigma * line.slope_dn;
  if (!determined) {
    return Rejected("noise of the camera",
                    absl::StrCat("the frames do not determine its gain: K = ", line.slope_dn,
                                 " +- ", line.slope_sigma_dn, " DN per electron"),
                    "record two darks of one setting, and two frames each of a few levels of light "
                    "from a tenth to two thirds of full scale");
  }
  NoiseModel noise;
  noise.gain_dn_per_e = line.slope_dn;
  noise.gain_sigma_dn_per_e = line.slope_sigma_dn;
  noise.read_variance_dn2 = std::max(line.intercept_dn2 - noise.quantisation_variance_dn2, 0.0);
  noise.read_variance_sigma_dn2 = line.intercept_sigma_dn2;
  noise.bias_dn = bias_median_dn_;
  noise.gain_db = bias_.setting.gain_db;
  noise.noise_source = saw_light_pair_ ? "pairs of repeats" : "spatial differences";
  return noise;
}

}  // namespace eyebox::optics
