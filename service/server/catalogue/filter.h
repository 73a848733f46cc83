// Which recordings a client wants: conditions joined by AND, a part of AIP-160.
#ifndef EYEBOX_SERVICE_SERVER_CATALOGUE_FILTER_H_
#define EYEBOX_SERVICE_SERVER_CATALOGUE_FILTER_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::service {

enum class FilterField {
  kName,
  kRig,
  kCamera,
  kState,
  kOrigin,
  kStartTime,
  kCaptures,
  kFrames,
  kBytes,
  kLevels,
  kSeries,
  kResults,
};

enum class FilterOperator {
  kEqual,
  kNotEqual,
  kLess,
  kLessOrEqual,
  kGreater,
  kGreaterOrEqual,
  kHas
};

struct FilterCondition {
  FilterField field = FilterField::kName;
  FilterOperator comparison = FilterOperator::kEqual;
  // Numbers, values of v1::RecordingState and v1::RecordingOrigin, nanoseconds since 1970; or text.
  std::variant<int64_t, std::string> value;
  bool any_rest = false;  // the text is the beginning of what is looked for
};

// All of them hold; empty: every recording passes.
using Filter = std::vector<FilterCondition>;

// What ListRecordingsRequest.filter says; recording_service.proto describes its form.
// Errors: InvalidArgument naming the field filter, the character (from 1) and what was expected.
absl::StatusOr<Filter> ParseFilter(std::string_view filter);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CATALOGUE_FILTER_H_
