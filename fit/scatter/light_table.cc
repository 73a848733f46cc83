#include "fit/scatter/light_table.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace eyebox::fit {
namespace {

constexpr double kSmallestRadiusDeg = 1e-4;
constexpr double kMerged = 0.3;  // of the distance from the disk's edge
constexpr int kStepsPerRing = 2;
constexpr double kNodesPerE = 48;  // cubic between them: errors below 1e-6 of a tail's energy

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A value between nodes as a sum of four.
struct Between {
  size_t first = 0;
  std::array<double, 4> factor{};
};

// `position` in steps of even nodes.
Between CubicAt(double position, size_t nodes) {
  const double last_first = static_cast<double>(nodes) - 4;
  const double first = std::clamp(std::floor(position) - 1, 0.0, last_first);
  const double t = position - first;
  return {static_cast<size_t>(first),
          {-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, -t * (t - 1) * (t - 3) / 2,
           t * (t - 1) * (t - 2) / 6}};
}

optics::PartEnergy CoreOn(const optics::EnergySum& sum, const std::vector<double>& beyond,
                          const optics::RadialWeight& weight) {
  const std::vector<double>& radii = sum.radius_deg;
  const double end = weight.CoreEndDeg();
  optics::PartEnergy light;
  size_t k = 0;
  for (; k < radii.size() && radii[k] < end; ++k) {
    const optics::PartEnergy within = weight.CoreWithin(radii[k]);
    light.energy += sum.factor[k] * within.energy;
    light.by_radius += sum.factor[k] * within.by_radius;
  }
  light.energy += beyond[k];
  return light;
}

// Offsets much nearer to each other than to the disk's edge, over which a tail is curved but
// little: two for each group, with its mean and variance.
std::vector<OffsetShare> Merged(const std::vector<OffsetShare>& offsets, double radius_deg) {
  std::vector<OffsetShare> merged;
  double first_deg = 0, share = 0, sum = 0, square = 0;
  const auto close = [&] {
    const double mean = sum / share;
    const double spread = std::sqrt(std::max(square / share - mean * mean, 0.0));
    merged.push_back({mean - spread, share / 2});
    merged.push_back({mean + spread, share / 2});
    share = sum = square = 0;
  };
  for (const OffsetShare& offset : offsets) {
    const double near_deg = kMerged * std::abs(first_deg - radius_deg);
    if (share > 0 && offset.offset_deg - first_deg > near_deg) close();
    if (share == 0) first_deg = offset.offset_deg;
    share += offset.share;
    sum += offset.share * offset.offset_deg;
    square += offset.share * offset.offset_deg * offset.offset_deg;
  }
  if (share > 0) close();
  return merged;
}

}  // namespace

class LightTableBuilder {
 public:
  LightTableBuilder(const GlareSeries& series, const ScatterFitOptions& options)
      : series_(series),
        reach_deg_(options.reach_deg),
        smooth_core_(options.core == optics::CoreShape::kGaussian) {
    if (options.instrument.has_value()) instrument_.emplace(options.instrument->kernel);
    const auto nodes =
        static_cast<size_t>(std::ceil(std::log(reach_deg_ / kSmallestRadiusDeg) * kNodesPerE)) + 4;
    for (size_t j = 0; j < nodes; ++j) {
      const auto steps_below = static_cast<double>(nodes - 1 - j);
      table_.radius_deg_.push_back(reach_deg_ * std::exp(-steps_below / kNodesPerE));
    }
    table_.rows_.resize(2 * series.readings.size());
    table_.tail_factor_.resize(table_.rows_.size() * nodes);
    if (smooth_core_) table_.core_factor_.resize(table_.rows_.size() * nodes);
    DivideField();
  }

  LightTable Build() && {
    for (size_t i = 0; i < series_.readings.size(); ++i) {
      const GlareReading& reading = series_.readings[i];
      const double radius_deg = reading.diameter_deg / 2;
      // Through an instrument the light is spread before: one offset will do.
      if (reading.offsets.empty() || instrument_) {
        AddReading(2 * i, radius_deg, {{reading.offset_deg, 1}});
      } else {
        AddReading(2 * i, radius_deg, reading.offsets);
      }
    }
    return std::move(table_);
  }

 private:
  struct Step {  // of even luminance, from the one before to this radius
    double radius_deg = 0;
    double relative = 1;
  };

  void DivideField() {
    if (series_.field.empty()) steps_ = {{series_.field_radius_deg, 1}};
    double inner = 0;
    for (const FieldRing& ring : series_.field) {
      const int steps = instrument_ ? 1 : kStepsPerRing;
      const double width = (ring.outer_radius_deg - inner) / steps;
      for (int k = 0; k < steps; ++k) {
        const double from = inner + k * width;
        const double to = inner + (k + 1) * width;
        steps_.push_back({to, series_.FieldAt(std::sqrt((from * from + to * to) / 2))});
      }
      inner = ring.outer_radius_deg;
    }
  }

  void AddReading(size_t row, double radius_deg, const std::vector<OffsetShare>& offsets) {
    for (const OffsetShare& offset : Merged(offsets, radius_deg)) {
      AddSteps(row, radius_deg, offset);
    }
    if (instrument_) return;
    for (const OffsetShare& offset : offsets) AddCore(row, radius_deg, offset);
  }

  // Disks of falling brightness, laid over each other: each step less the next over all within it.
  void AddSteps(size_t row, double radius_deg, const OffsetShare& offset) {
    const size_t rest = row + 1;
    for (size_t k = 0; k < steps_.size(); ++k) {
      const auto [outer, relative] = steps_[k];
      const double next = k + 1 < steps_.size() ? steps_[k + 1].relative : 0;
      const double inner = k > 0 ? steps_[k - 1].radius_deg : 0;
      const double factor = offset.share * (relative - next);
      AddTail(outer, offset.offset_deg, outer < radius_deg ? row : rest, factor);
      if (!(inner < radius_deg && radius_deg <= outer)) continue;
      AddTail(radius_deg, offset.offset_deg, row, offset.share * relative);
      AddTail(radius_deg, offset.offset_deg, rest, -offset.share * relative);
    }
  }

  // The core sees what lies next to its axis, which is even enough.
  void AddCore(size_t row, double radius_deg, const OffsetShare& offset) {
    const double end = series_.FieldEndDeg();
    const double edge = std::min(radius_deg, end);
    const double inside = offset.share * series_.FieldAt(std::min(offset.offset_deg, edge));
    const double outside = offset.share * series_.FieldAt(std::max(offset.offset_deg, edge));
    AddCoreDisk(edge, offset.offset_deg, row, inside);
    AddCoreDisk(end, offset.offset_deg, row + 1, outside);
    AddCoreDisk(edge, offset.offset_deg, row + 1, -outside);
  }

  void AddCoreDisk(double radius_deg, double offset_deg, size_t row, double factor) {
    if (!(radius_deg > 0) || factor == 0) return;
    const size_t region = RegionOf(radius_deg, offset_deg);
    if (smooth_core_) {
      Tabulate(table_.regions_[region].sum, factor, row, table_.core_factor_);
    } else {
      table_.rows_[row].core.emplace_back(region, factor);
    }
  }

  void AddTail(double radius_deg, double offset_deg, size_t row, double factor) {
    if (!(radius_deg > 0) || factor == 0) return;
    if (instrument_) AddCoreDisk(radius_deg, offset_deg, row, factor);
    const optics::EnergySum& sum = table_.regions_[RegionOf(radius_deg, offset_deg)].sum;
    Tabulate(sum, factor, row, table_.tail_factor_);
    for (size_t k = 0; k < sum.factor.size(); ++k) {
      const double ratio = std::min(sum.radius_deg[k] / reach_deg_, 1.0);
      table_.rows_[row].pedestal += factor * sum.factor[k] * ratio * ratio;
    }
  }

  // Adds the sum, of energies within radii between the nodes, to the factors of a row.
  void Tabulate(const optics::EnergySum& sum, double factor, size_t row,
                std::vector<double>& factors) const {
    const size_t nodes = table_.radius_deg_.size();
    double* const to = factors.data() + row * nodes;
    for (size_t k = 0; k < sum.factor.size(); ++k) {
      const double ratio = std::min(sum.radius_deg[k] / reach_deg_, 1.0);
      const double weight = factor * sum.factor[k];
      const double position = std::log(ratio) * kNodesPerE + static_cast<double>(nodes - 1);
      if (position <= 0) {  // within the first, energies go as the square
        to[0] += weight * std::exp(2 * position / kNodesPerE);
        continue;
      }
      const Between between = CubicAt(position, nodes);
      for (size_t n = 0; n < between.factor.size(); ++n) {
        to[between.first + n] += weight * between.factor[n];
      }
    }
  }

  size_t RegionOf(double radius_deg, double offset_deg) {
    const auto [known, is_new] =
        region_of_.try_emplace({radius_deg, offset_deg}, table_.regions_.size());
    if (!is_new) return known->second;
    const optics::Disk disk{radius_deg, offset_deg};
    LightTable::Region region;
    region.sum =
        instrument_ ? optics::SecondScatterer(*instrument_, disk).Sum() : optics::EnergySumOf(disk);
    region.beyond.resize(region.sum.factor.size() + 1);
    for (size_t k = region.sum.factor.size(); k-- > 0;) {
      region.beyond[k] = region.beyond[k + 1] + region.sum.factor[k];
    }
    table_.regions_.push_back(std::move(region));
    return known->second;
  }

  const GlareSeries& series_;
  double reach_deg_;
  bool smooth_core_;  // enough for the table, else it is summed over the regions' own radii
  std::optional<optics::RadialWeight> instrument_;
  std::vector<Step> steps_;                                // of the field
  std::map<std::pair<double, double>, size_t> region_of_;  // by radius and offset
  LightTable table_;
};

LightTable LightTable::Of(const GlareSeries& series, const ScatterFitOptions& options) {
  return LightTableBuilder(series, options).Build();
}

optics::PartEnergy LightTable::CoreOf(const Row& row, const optics::RadialWeight& weight) const {
  optics::PartEnergy light;
  for (const auto& [region, factor] : row.core) {
    const optics::PartEnergy on = CoreOn(regions_[region].sum, regions_[region].beyond, weight);
    light.energy += factor * on.energy;
    light.by_radius += factor * on.by_radius;
  }
  return light;
}

std::vector<ReadingLight> LightTable::LightFor(const optics::ScatterKernel& kernel) const {
  const optics::RadialWeight weight(kernel);
  const auto nodes = static_cast<Eigen::Index>(radius_deg_.size());
  const auto count = static_cast<Eigen::Index>(rows_.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> tail(nodes, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 2> core(nodes, 2);
  for (Eigen::Index j = 0; j < nodes; ++j) {
    const double radius_deg = radius_deg_[static_cast<size_t>(j)];
    const optics::PartEnergy tail_within = weight.TailWithin(radius_deg);
    const optics::PartEnergy core_within = weight.CoreWithin(radius_deg);
    tail.row(j) << tail_within.energy, tail_within.by_radius, tail_within.by_exponent;
    core.row(j) << core_within.energy, core_within.by_radius;
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> tails(count, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 2> cores(count, 2);
  // Column by column: a product of so narrow a matrix would copy the large one first.
  const Eigen::Map<const RowMajor> tail_factors(tail_factor_.data(), count, nodes);
  for (Eigen::Index k = 0; k < tail.cols(); ++k) {
    tails.col(k).noalias() = tail_factors * tail.col(k);
  }
  if (!core_factor_.empty()) {
    const Eigen::Map<const RowMajor> core_factors(core_factor_.data(), count, nodes);
    for (Eigen::Index k = 0; k < core.cols(); ++k) {
      cores.col(k).noalias() = core_factors * core.col(k);
    }
  } else {
    for (size_t row = 0; row < rows_.size(); ++row) {
      const optics::PartEnergy light = CoreOf(rows_[row], weight);
      cores.row(static_cast<Eigen::Index>(row)) << light.energy, light.by_radius;
    }
  }
  std::vector<PartLight> of_row;
  for (Eigen::Index r = 0; r < count; ++r) {
    of_row.push_back({{cores(r, 0), cores(r, 1)},
                      {tails(r, 0), tails(r, 1), tails(r, 2)},
                      rows_[static_cast<size_t>(r)].pedestal});
  }
  std::vector<ReadingLight> light;
  light.reserve(of_row.size() / 2);
  for (size_t i = 0; i + 1 < of_row.size(); i += 2) light.push_back({of_row[i], of_row[i + 1]});
  return light;
}

}  // namespace eyebox::fit
