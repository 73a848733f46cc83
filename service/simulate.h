// A recording of a simulated headset with its truth beside it.
#ifndef EYEBOX_SERVICE_SIMULATE_H_
#define EYEBOX_SERVICE_SIMULATE_H_

#include <cstdint>
#include <filesystem>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "capture/plan.h"
#include "eyebox/v1/results.pb.h"
#include "service/watcher.h"

namespace eyebox::service {

struct SimulateRequest {
  capture::RigConfig rig;        // sim: only
  std::optional<uint64_t> seed;  // instead of the rig's
  capture::PlanOptions plan;
  std::filesystem::path recording;  // must not exist
};

// Errors: InvalidArgument (rig, plan), AlreadyExists, Cancelled, the errno of the disk.
absl::StatusOr<v1::SimulateResult> Simulate(const SimulateRequest& request, const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SIMULATE_H_
