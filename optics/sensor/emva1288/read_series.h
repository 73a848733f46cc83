// A series of images, set by set, to statistics and to the stacks that the defect map needs.
#ifndef EYEBOX_OPTICS_SENSOR_EMVA1288_READ_SERIES_H_
#define EYEBOX_OPTICS_SENSOR_EMVA1288_READ_SERIES_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/sensor/emva1288/descriptor.h"
#include "optics/sensor/emva1288/set_statistics.h"

namespace eyebox::optics {

// Collects finished sets in one pass. Memory: three mean images, whatever the length.
class SeriesCollector {
 public:
  void Add(SetAccumulator::Finished set);

  std::vector<SetStatistics> sets;     // in the order in which they were added
  std::optional<Stack> shortest_dark;  // of equal exposures the one of more images
  std::optional<Stack> longest_dark;
  // Nearest to half of full scale, of equally near ones the one of more images.
  std::optional<Stack> half_bright;
};

// Reads every image of the descriptor once. Errors: those of ReadGreyImage and SetAccumulator with
// the descriptor's line; InvalidArgument (image of another size than the n line says).
absl::StatusOr<SeriesCollector> ReadSeries(const Emva1288Descriptor& descriptor,
                                           const std::string& name, int colour_period_px = 1);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_EMVA1288_READ_SERIES_H_
