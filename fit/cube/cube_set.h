// One table for a field, or several: what a single table leaves at each place, and the fewest
// tables that keep every place within a tolerance.
//
// A place answers with L = k v^gamma + delta. Its table is known once delta / k and gamma are: k
// alone only scales luminance, so that places that differ in k alone share a table exactly.
#ifndef EYEBOX_FIT_CUBE_CUBE_SET_H_
#define EYEBOX_FIT_CUBE_CUBE_SET_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/cube/design_table.h"

namespace eyebox::fit {

struct PlaceResponse {
  double offset_over_gain = 0;  // delta / k; NaN: no value here
  double offset_over_gain_sigma = 0;
  double gamma = 0;
};

struct CubeSetOptions {
  TableTarget target = TableTarget::kHdrp;
  int size = 32;
  double tolerance = 0.02;  // largest error, the table's own included
  DesignOptions design = {};
};

// The error at a place is the departure from proportionality: the smallest e such that some scale c
// gives |L(x) / (c x) - 1| <= e for all x from the certified range above the table's cutoff.
struct RegionTable {
  TableDesign table;
  double offset_over_gain = 0;  // that it was designed for
  double gamma = 0;
  size_t places = 0;        // that it serves
  double max_relative = 0;  // largest error at any of them, through the finished table
  double max_relative_sigma = 0;
};

struct CubeSet {
  RegionTable single;               // smallest worst error over the region
  std::vector<float> single_error;  // [places], outside the region too; NaN without a value
  std::vector<float> single_error_sigma;
  double single_rms = 0;  // over the region
  std::vector<RegionTable>
      tables;                 // the smallest set, rising offset_over_gain where gamma is common
  std::vector<int> table_of;  // [places], from 1; 0 outside the region or without a value
  size_t at_least = 0;        // fewer are proven not to do, each with the error of its own entries
};

// `in_region` [places], not 0 where a place counts. With one gamma the set is the smallest (places
// on a line, covered from one end); with several it is found greedily and `at_least` is the number
// of places of which no two can share a table. Errors: those of DesignTable; InvalidArgument
// (tolerance, sizes disagree), FailedPrecondition (no place in the region has a value; the
// tolerance is below what a table of this size leaves by itself: says how much).
absl::StatusOr<CubeSet> DesignCubeSet(std::span<const PlaceResponse> places,
                                      std::span<const uint8_t> in_region,
                                      const CubeSetOptions& options);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_CUBE_SET_H_
