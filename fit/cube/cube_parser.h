// The .cube grammar (Adobe "Cube LUT Specification" 1.0), strictly.
#ifndef EYEBOX_FIT_CUBE_CUBE_PARSER_H_
#define EYEBOX_FIT_CUBE_CUBE_PARSER_H_

#include <string_view>

#include "absl/status/statusor.h"
#include "fit/cube/table_file.h"

namespace eyebox::fit {

// Lines end in LF or CRLF; blank lines and lines that begin with # are skipped. TITLE,
// LUT_3D_SIZE (required, 2 to 129) and either DOMAIN_MIN and DOMAIN_MAX or Resolve's
// LUT_3D_INPUT_RANGE (low high) stand before the entries, once each.
// Entries are kept as float32. `name` stands for the text in messages.
// Errors: InvalidArgument "NAME:LINE: ..."
absl::StatusOr<Cube3d> ParseCube(std::string_view text, std::string_view name);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_CUBE_PARSER_H_
