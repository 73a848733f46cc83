#include "fit/scatter/light_table.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace eyebox::fit {
namespace {

constexpr double kSmallestRadiusDeg = 1e-4;
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

// Of the tail's energy within each of the nodes: what the sum makes of a tail between them.
Eigen::RowVectorXd TailFactors(const optics::EnergySum& sum, double reach_deg, size_t nodes) {
  Eigen::RowVectorXd factors = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(nodes));
  for (size_t k = 0; k < sum.factor.size(); ++k) {
    const double ratio = std::min(sum.radius_deg[k] / reach_deg, 1.0);
    const double position = std::log(ratio) * kNodesPerE + static_cast<double>(nodes - 1);
    if (position <= 0) {  // within the first, energies go as the square
      factors(0) += sum.factor[k] * std::exp(2 * position / kNodesPerE);
      continue;
    }
    const Between between = CubicAt(position, nodes);
    for (size_t n = 0; n < between.factor.size(); ++n) {
      factors(static_cast<Eigen::Index>(between.first + n)) += sum.factor[k] * between.factor[n];
    }
  }
  return factors;
}

PartLight operator-(const PartLight& whole, const PartLight& part) {
  const auto less = [](const optics::PartEnergy& a, const optics::PartEnergy& b) {
    return optics::PartEnergy{a.energy - b.energy, a.by_radius - b.by_radius,
                              a.by_exponent - b.by_exponent};
  };
  return {less(whole.core, part.core), less(whole.tail, part.tail), whole.pedestal - part.pedestal};
}

}  // namespace

LightTable::LightTable(const GlareSeries& series, const ScatterFitOptions& options)
    : reach_deg_(options.reach_deg) {
  const double whole =
      series.field.empty() ? series.field_radius_deg : series.field.back().outer_radius_deg;
  for (const GlareReading& reading : series.readings) {
    AddRow(series, options, reading.diameter_deg / 2, reading.offset_deg);
    AddRow(series, options, whole, reading.offset_deg);
  }
  Tabulate();
}

size_t LightTable::RegionOf(const ScatterFitOptions& options, double radius_deg,
                            double offset_deg) {
  const auto [known, is_new] = region_of_.try_emplace({radius_deg, offset_deg}, regions_.size());
  if (!is_new) return known->second;
  Region region;
  const optics::Disk disk{radius_deg, offset_deg};
  if (options.instrument.has_value()) {
    region.sum =
        optics::SecondScatterer(optics::RadialWeight(options.instrument->kernel), disk).Sum();
  } else {
    region.sum = optics::EnergySumOf(disk);
  }
  region.beyond.resize(region.sum.factor.size() + 1);
  for (size_t k = region.sum.factor.size(); k-- > 0;) {
    region.beyond[k] = region.beyond[k + 1] + region.sum.factor[k];
  }
  regions_.push_back(std::move(region));
  return known->second;
}

// Disks of falling brightness, laid over each other: each ring less the next over all within it.
void LightTable::AddRow(const GlareSeries& series, const ScatterFitOptions& options,
                        double radius_deg, double offset_deg) {
  Row row;
  const auto add = [&](double radius, double factor) {
    if (factor != 0) row.emplace_back(RegionOf(options, radius, offset_deg), factor);
  };
  const std::vector<FieldRing>& field = series.field;
  for (size_t k = 0; k < field.size() && (k == 0 || field[k - 1].outer_radius_deg < radius_deg);
       ++k) {
    const bool last = field[k].outer_radius_deg >= radius_deg;
    const double next = k + 1 < field.size() ? field[k + 1].relative : 0;
    add(last ? radius_deg : field[k].outer_radius_deg, field[k].relative - (last ? 0 : next));
  }
  if (field.empty()) add(radius_deg, 1);
  rows_.push_back(std::move(row));
}

void LightTable::Tabulate() {
  const auto nodes =
      static_cast<size_t>(std::ceil(std::log(reach_deg_ / kSmallestRadiusDeg) * kNodesPerE)) + 4;
  for (size_t j = 0; j < nodes; ++j) {
    const auto steps_below = static_cast<double>(nodes - 1 - j);
    radius_deg_.push_back(reach_deg_ * std::exp(-steps_below / kNodesPerE));
  }
  const auto columns = static_cast<Eigen::Index>(nodes);
  RowMajor of_region(static_cast<Eigen::Index>(regions_.size()), columns);
  std::vector<double> pedestal(regions_.size());
  for (size_t i = 0; i < regions_.size(); ++i) {
    const optics::EnergySum& sum = regions_[i].sum;
    of_region.row(static_cast<Eigen::Index>(i)) = TailFactors(sum, reach_deg_, nodes);
    for (size_t k = 0; k < sum.factor.size(); ++k) {
      const double ratio = std::min(sum.radius_deg[k] / reach_deg_, 1.0);
      pedestal[i] += sum.factor[k] * ratio * ratio;
    }
  }
  tail_factor_.assign(rows_.size() * nodes, 0);
  pedestal_.assign(rows_.size(), 0);
  Eigen::Map<RowMajor> rows(tail_factor_.data(), static_cast<Eigen::Index>(rows_.size()), columns);
  for (size_t i = 0; i < rows_.size(); ++i) {
    for (const auto& [region, factor] : rows_[i]) {
      rows.row(static_cast<Eigen::Index>(i)) +=
          factor * of_region.row(static_cast<Eigen::Index>(region));
      pedestal_[i] += factor * pedestal[region];
    }
  }
}

optics::PartEnergy LightTable::CoreOn(const Region& region,
                                      const optics::RadialWeight& weight) const {
  const std::vector<double>& radii = region.sum.radius_deg;
  const double end = weight.CoreEndDeg();
  optics::PartEnergy light;
  size_t k = 0;
  for (; k < radii.size() && radii[k] < end; ++k) {
    const optics::PartEnergy within = weight.CoreWithin(radii[k]);
    light.energy += region.sum.factor[k] * within.energy;
    light.by_radius += region.sum.factor[k] * within.by_radius;
  }
  light.energy += region.beyond[k];
  return light;
}

std::vector<ReadingLight> LightTable::LightFor(const optics::ScatterKernel& kernel) const {
  const optics::RadialWeight weight(kernel);
  const auto nodes = static_cast<Eigen::Index>(radius_deg_.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> within(nodes, 3);
  for (Eigen::Index j = 0; j < nodes; ++j) {
    const optics::PartEnergy tail = weight.TailWithin(radius_deg_[static_cast<size_t>(j)]);
    within.row(j) << tail.energy, tail.by_radius, tail.by_exponent;
  }
  const Eigen::Map<const RowMajor> rows(tail_factor_.data(),
                                        static_cast<Eigen::Index>(rows_.size()), nodes);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> tails = rows * within;
  std::vector<optics::PartEnergy> cores;
  cores.reserve(regions_.size());
  for (const Region& region : regions_) cores.push_back(CoreOn(region, weight));
  const auto light_of = [&](size_t row) {
    const auto r = static_cast<Eigen::Index>(row);
    PartLight light{{}, {tails(r, 0), tails(r, 1), tails(r, 2)}, pedestal_[row]};
    for (const auto& [region, factor] : rows_[row]) {
      light.core.energy += factor * cores[region].energy;
      light.core.by_radius += factor * cores[region].by_radius;
    }
    return light;
  };
  std::vector<ReadingLight> light;
  light.reserve(rows_.size() / 2);
  for (size_t i = 0; i + 1 < rows_.size(); i += 2) {
    const PartLight disk = light_of(i);
    light.push_back({disk, light_of(i + 1) - disk});
  }
  return light;
}

}  // namespace eyebox::fit
