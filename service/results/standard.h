// A certificate as something to be judged by.
#ifndef EYEBOX_SERVICE_RESULTS_STANDARD_H_
#define EYEBOX_SERVICE_RESULTS_STANDARD_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/results.pb.h"
#include "fit/cube/design_table.h"

namespace eyebox::service {

struct Standard {
  fit::TableDesign table;
  v1::Certificate certificate;  // the one after all storage models, where there is one
  bool has_output = false;      // its error holds 8-bit output already

  // Largest relative luminance error at `x`, a fraction of white: the certificate's, and half of
  // the step that 8-bit output makes there unless the certificate holds it.
  double AllowedAt(double x) const;
};

// Of the one table (target, size, white_u, entries) that `cube` describes. Errors: InvalidArgument
// naming `where` and the field.
absl::StatusOr<Standard> StandardOf(const v1::CubeResult& cube, const std::string& where);
// What `eyebox cube --json` printed. Errors: NotFound, InvalidArgument.
absl::StatusOr<Standard> ReadStandard(const std::filesystem::path& file);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_STANDARD_H_
