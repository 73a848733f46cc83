#include "service/results/standard.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "service/result_json.h"

namespace eyebox::service {
namespace {

constexpr double kHalfStep = 0.5 / 255;

absl::Status Incomplete(const std::string& where, const char* field) {
  return BadInput(where, absl::StrCat("field ", field, " is missing or makes no sense"),
                  "give what `eyebox cube --json` prints for one grey table");
}

}  // namespace

double Standard::AllowedAt(double x) const {
  constexpr double kStep = 0.01;
  double allowed = certificate.max_relative();
  const double u = x * table.white_u;
  if (table.target == fit::TableTarget::kPtb) return allowed + kHalfStep / u;
  if (has_output) return allowed;
  // Luminance is proportional to u, so that a step in the drive value is one in u.
  const double slope =
      (fit::DriveThroughTable(table, u) - fit::DriveThroughTable(table, u * (1 - kStep))) / kStep;
  if (slope > 0) allowed += kHalfStep / slope;
  return allowed;
}

absl::StatusOr<Standard> StandardOf(const v1::CubeResult& cube, const std::string& where) {
  Standard standard;
  EYEBOX_ASSIGN_OR_RETURN(standard.table.target, fit::TableTargetOf(cube.target()));
  standard.table.size = cube.size();
  standard.table.entries.assign(cube.entries().begin(), cube.entries().end());
  standard.table.knots_u.assign(cube.knots_u().begin(), cube.knots_u().end());
  if (cube.size() < 2 || cube.entries_size() != cube.size() ||
      !std::ranges::all_of(cube.entries(), [](double entry) { return std::isfinite(entry); })) {
    return Incomplete(where, "entries");
  }
  standard.table.white_u = 0;
  for (const v1::Parameter& parameter : cube.parameters()) {
    if (parameter.name() == "white_u") standard.table.white_u = parameter.value();
  }
  if (!(standard.table.white_u > 0)) return Incomplete(where, "parameters.white_u");
  standard.certificate = cube.certificate();
  if (cube.storage_certificates_size() > 0) {
    const v1::StorageCertificate& all = *cube.storage_certificates().rbegin();
    standard.certificate = all.certificate();
    standard.has_output = all.storage().find("output8") != std::string::npos;
  }
  const v1::Certificate& certificate = standard.certificate;
  if (!(certificate.max_relative() >= 0 && certificate.max_relative() < 1) ||
      !(certificate.u_from() > 0 && certificate.u_from() < 1)) {
    return Incomplete(where, "certificate");
  }
  return standard;
}

absl::StatusOr<Standard> ReadStandard(const std::filesystem::path& file) {
  v1::CubeResult cube;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, cube));
  return StandardOf(cube, file.string());
}

}  // namespace eyebox::service
