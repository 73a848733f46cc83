// How the light that reaches each reading hangs on w. What is geometry is summed up once, so that
// each w costs one evaluation of its parts over a few hundred radii.
#ifndef EYEBOX_FIT_SCATTER_LIGHT_TABLE_H_
#define EYEBOX_FIT_SCATTER_LIGHT_TABLE_H_

#include <cstddef>
#include <utility>
#include <vector>

#include "fit/scatter/fit_scatter.h"
#include "optics/scatter/disk_energy.h"

namespace eyebox::fit {

// Light of a region of the display, of luminance 1 on the axis, through each part of w alone.
struct PartLight {
  optics::PartEnergy core;
  optics::PartEnergy tail;
  double pedestal = 0;
};

struct ReadingLight {
  PartLight disk;
  PartLight rest;  // the field without the disk
};

class LightTable {
 public:
  // Both must be valid. Tabulates what the instrument alone does.
  static LightTable Of(const GlareSeries& series, const ScatterFitOptions& options);

  // One for each reading. Energies to 1e-6, derivatives to 1e-5; of what falls on a small disk in
  // the tail, relative. `kernel` has the reach and the shapes of the options.
  std::vector<ReadingLight> LightFor(const optics::ScatterKernel& kernel) const;

 private:
  struct Region {  // a disk of even luminance as a reading sees it
    optics::EnergySum sum;
    std::vector<double> beyond;  // factors of this radius and all larger ones, summed
  };
  using Share = std::pair<size_t, double>;  // region, factor
  struct Row {                              // what light is a sum of
    std::vector<Share> core;                // of regions, unless the table has it
    double pedestal = 0;
  };

  friend class LightTableBuilder;
  LightTable() = default;
  optics::PartEnergy CoreOf(const Row& row, const optics::RadialWeight& weight) const;

  std::vector<Region> regions_;
  std::vector<double> radius_deg_;   // ascending to the reach, even steps of the logarithm
  std::vector<Row> rows_;            // disk and rest of each reading, [2 readings]
  std::vector<double> tail_factor_;  // of the tail's energy within each radius, [2 readings, radii]
  std::vector<double> core_factor_;  // the same of a Gaussian core
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_LIGHT_TABLE_H_
