// Patches that tell a table which reached the display from one that was changed on the way.
#ifndef EYEBOX_SERVICE_PROBE_H_
#define EYEBOX_SERVICE_PROBE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "eyebox/v1/table.pb.h"
#include "service/single_steps.h"

namespace eyebox::service {

struct ProbeRequest {
  CubeRequest cube;                // the fit, and the table if it is to be designed; no `out`
  std::filesystem::path table;     // a table as it was loaded (.cube, .png); empty: design it
  std::filesystem::path out;       // folder for the patches and the table; empty with readings
  std::filesystem::path readings;  // CSV u,lum[,lum_sigma] or m_k,lum[,lum_sigma]; may be empty
  int patches = 16;                // 4 to 40
  double noise_relative = 0.005;   // of a reading whose sigma is not known, and to plan by
};

// Without readings: writes probe.csv (u, m_k, the luminance to expect from each hypothesis) and the
// table. With readings: says what happened to the table.
// Errors: those of the readers, of DesignTable and of JudgeProbe; InvalidArgument.
absl::StatusOr<v1::ProbeResult> Probe(const ProbeRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PROBE_H_
