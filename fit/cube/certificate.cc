#include "fit/cube/certificate.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "fit/cube/goal.h"
#include "fit/cube/sampling.h"
#include "fit/cube/stored_minimax.h"

namespace eyebox::fit {
namespace {

constexpr int kGammaTableTop = 255;
constexpr int kStoredDensity = 8;  // times the samples of the exact certificate

// From a rendered value to the drive value, one channel.
class Way {
 public:
  Way(const TableDesign& table, const StorageModel& storage, Channel channel)
      : table_(table), path_(storage, channel), entries_(table.entries) {
    for (double& entry : entries_) entry = path_.HeldEntry(entry);
  }

  double Drive(double u) const {
    const double position = PositionOf(table_.target, table_.size, path_.Buffered(u));
    const double below = std::floor(position);
    const double mix = Interpolate(entries_, below + path_.Weight(position - below));
    return path_.Shown(DriveOfEntry(table_.target, path_.Buffered(mix)));
  }

 private:
  const TableDesign& table_;
  StoragePath path_;
  std::vector<double> entries_;
};

double ErrorAt(const Way& way, const TableDesign& table, const Activation& activation, double x) {
  return RelativeError(activation, way.Drive(x * table.white_u), x);
}

std::vector<double> LogSpaced(double from, int points) {
  std::vector<double> xs;
  for (int i = 0; i < points; ++i) {
    xs.push_back(std::pow(from, 1 - static_cast<double>(i) / (points - 1)));
  }
  return xs;
}

// The only rendered values that a PTB table is asked for.
std::vector<double> LevelsOfGammaTable(const TableDesign& table, double from) {
  std::vector<double> xs;
  for (int level = 0; level <= kGammaTableTop; ++level) {
    const double x = level / (kGammaTableTop * table.white_u);
    if (x >= from && x <= 1) xs.push_back(x);
  }
  return xs;
}

// Where the error bends or jumps.
std::vector<double> Bends(const TableDesign& table, const Activation& activation) {
  std::vector<double> xs = {CutoffOf(activation)};
  for (double knot_u : table.knots_u) xs.push_back(knot_u / table.white_u);
  return xs;
}

std::vector<double> BufferEdges(const TableDesign& table, const StoragePath& path, double from) {
  std::vector<double> xs;
  for (double u = path.Buffered(from * table.white_u); u < table.white_u;
       u = path.NextBuffered(u)) {
    xs.push_back(u / table.white_u);
    xs.push_back(std::nextafter(path.NextBuffered(u), 0.0) / table.white_u);
  }
  return xs;
}

double LargestStepAt8Bits(const Activation& activation, double x_from) {
  const double from = WantedLuminance(activation, x_from);
  double largest = 0;
  for (int drive = 255; drive > 0; --drive) {
    const double below = activation.Luminance((drive - 1) / 255.0);
    if (below < from) break;
    largest = std::max(largest, activation.Luminance(drive / 255.0) / below - 1);
  }
  return largest;
}

// Between values of u that `way`, which ends in 8 bits, shows differently.
double LargestStepAlong(const Way& way, const TableDesign& table, const Activation& activation,
                        const std::vector<double>& rising_x) {
  double largest = 0;
  double below = 0;
  for (double x : rising_x) {
    const double luminance = activation.Luminance(way.Drive(x * table.white_u));
    if (below > 0) largest = std::max(largest, luminance / below - 1);
    below = luminance;
  }
  return largest;
}

// `even_x` for the rms, `more_x` for the maximum as well.
Certificate Measure(const Way& way, const TableDesign& table, const Activation& activation,
                    const DesignOptions& options, const std::vector<double>& even_x,
                    const std::vector<double>& more_x) {
  Certificate certificate;
  certificate.u_from = options.u_from;
  certificate.samples = static_cast<int>(even_x.size());
  double squares = 0;
  const auto include = [&](double x) {
    const double error = ErrorAt(way, table, activation, x);
    if (std::abs(error) > certificate.max_relative) {
      certificate.max_relative = std::abs(error);
      certificate.at_u = x;
    }
    return error;
  };
  for (double x : even_x) squares += std::pow(include(x), 2);
  certificate.rms_relative = std::sqrt(squares / certificate.samples);
  for (double x : more_x) {
    if (x > options.u_from && x < 1) include(x);
  }
  return certificate;
}

StoredCertificate CertifyChannel(const TableDesign& table, const Activation& activation,
                                 const DesignOptions& options, const StorageModel& storage,
                                 Channel channel) {
  const bool is_gamma_table = table.target == TableTarget::kPtb;
  const std::vector<double> even =
      is_gamma_table ? LevelsOfGammaTable(table, options.u_from)
                     : LogSpaced(options.u_from, kStoredDensity * options.samples);
  std::vector<double> more;
  if (!is_gamma_table) more = Bends(table, activation);
  if (storage.r11g11b10) {
    std::ranges::copy(BufferEdges(table, StoragePath(storage, channel), options.u_from),
                      std::back_inserter(more));
  }
  const Way way(table, storage, channel);
  StoredCertificate stored{storage, Measure(way, table, activation, options, even, more), channel};
  StorageModel shown = storage;
  shown.output8 = true;
  stored.certificate.contrast_step_8bit =
      LargestStepAlong(Way(table, shown, channel), table, activation, even);
  return stored;
}

}  // namespace

double DriveThroughTable(const TableDesign& table, double u) {
  const double position = PositionOf(table.target, table.size, u);
  return DriveOfEntry(table.target, Interpolate(table.entries, position));
}

std::vector<ErrorPoint> ErrorCurve(const TableDesign& table, const Activation& activation,
                                   double u_from, int points) {
  const Way way(table, {}, Channel::kGrey);
  std::vector<ErrorPoint> curve;
  for (double x : LogSpaced(u_from, points)) {
    curve.push_back({x, ErrorAt(way, table, activation, x)});
  }
  return curve;
}

Certificate Certify(const TableDesign& table, const Activation& activation,
                    const DesignOptions& options) {
  const Way way(table, {}, Channel::kGrey);
  if (table.target == TableTarget::kPtb) {
    const std::vector<double> levels = LevelsOfGammaTable(table, options.u_from);
    Certificate certificate = Measure(way, table, activation, options, levels, {});
    certificate.contrast_step_8bit = LargestStepAlong(way, table, activation, levels);
    return certificate;
  }
  Certificate certificate =
      Measure(way, table, activation, options, LogSpaced(options.u_from, options.samples),
              Bends(table, activation));
  certificate.contrast_step_8bit = LargestStepAt8Bits(activation, options.u_from);
  return certificate;
}

absl::StatusOr<StoredCertificate> CertifyStored(const TableDesign& table,
                                                const Activation& activation,
                                                const DesignOptions& options,
                                                const StorageModel& storage) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckStorage(table.target, storage));
  // Red and green are alike; blue differs from them in the colour buffers alone.
  if (!storage.r11g11b10) {
    return CertifyChannel(table, activation, options, storage, Channel::kGrey);
  }
  const StoredCertificate red = CertifyChannel(table, activation, options, storage, Channel::kRed);
  const StoredCertificate blue =
      CertifyChannel(table, activation, options, storage, Channel::kBlue);
  return blue.certificate.max_relative > red.certificate.max_relative ? blue : red;
}

}  // namespace eyebox::fit
