// Simulated recordings for tests, made once a process.
#ifndef EYEBOX_TESTS_SERVICE_RECORDED_RIG_H_
#define EYEBOX_TESTS_SERVICE_RECORDED_RIG_H_

#include <gtest/gtest.h>

#include <filesystem>

#include "service/simulate.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {

// `plan` captured with sim:rift-s-like, seed 5, into folder/name.
inline std::filesystem::path Record(const std::filesystem::path& folder, const std::string& name,
                                    const capture::PlanOptions& plan) {
  SimulateRequest request;
  request.rig = {.name = "rift-s-like", .camera_uri = "sim:rift-s-like", .seed = 5};
  request.plan = plan;
  request.recording = folder / name;
  const auto made = Simulate(request, {});
  EXPECT_TRUE(made.ok()) << made.status();
  return request.recording;
}

// The default plan: 17 levels x 3 exposures x 2 repeats, darks and flats.
inline const std::filesystem::path& RecordedRig() {
  static const TemporaryFolder folder;
  static const std::filesystem::path recording = Record(folder.path(), "recording", {});
  return recording;
}

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_RECORDED_RIG_H_
