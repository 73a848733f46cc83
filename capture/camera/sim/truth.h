// What a simulated recording should be reduced to: the parameters and maps that made it.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_TRUTH_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_TRUTH_H_

#include <cstdint>
#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "capture/base/image.h"
#include "capture/camera/rig.h"
#include "capture/camera/sim/parameters.h"

namespace eyebox::capture {

struct SimTruth {
  SimParameters parameters;
  uint64_t seed = 0;
  Image<float> g;  // [height, width], 1 at the image centre
};

SimTruth MakeSimTruth(const SimParameters& parameters, uint64_t seed);

// One JSON object, "simulated": true, units in the names; numbers in the shortest form that reads
// back to the same double. "gamma" and "cutoff_drive" stand at the top where all channels share
// them, and always under "channels".
std::string SimTruthJson(const SimTruth& truth);

// Writes truth.json and truth_g.npy into `folder`. Errors: the errno of the file system.
absl::Status WriteSimTruth(const std::filesystem::path& folder, const SimTruth& truth);

// The same for a rig that OpenRig() would open. Errors: also InvalidArgument (not a sim: rig).
absl::Status WriteSimTruth(const std::filesystem::path& folder, const RigConfig& config);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_TRUTH_H_
