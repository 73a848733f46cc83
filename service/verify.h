// Measures again through a table: is luminance proportional to what was rendered, and as well as
// the certificate says?
#ifndef EYEBOX_SERVICE_VERIFY_H_
#define EYEBOX_SERVICE_VERIFY_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/verify.pb.h"
#include "service/watcher.h"

namespace eyebox::service {

struct VerifyRequest {
  std::filesystem::path measured;  // CSV (m_k,lum[,lum_sigma] or m_r,m_g,m_b,x,y,z) or a recording
  std::optional<std::string> series;
  std::filesystem::path certificate;  // what `eyebox cube --json` printed; may be empty
  std::string input;             // "srgb": u = s(m); "linear": u = m; "": as the table's target
  double noise_relative = 0;     // of a reading whose sigma is not known
  int place_px = 16;             // side of a place of a recording
  std::filesystem::path folder;  // for the maps of a recording; may be empty
};

// The verdict is in the result: a table that fails is no error.
// Errors: those of the readers, of FitLineThroughOrigin and of the recording; InvalidArgument (the
// certificate, input, noise or place).
absl::StatusOr<v1::VerifyResult> Verify(const VerifyRequest& request, const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_VERIFY_H_
