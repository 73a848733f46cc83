// The version that stands in every recording and result.
#ifndef EYEBOX_CAPTURE_BASE_VERSION_H_
#define EYEBOX_CAPTURE_BASE_VERSION_H_

#include <string_view>

namespace eyebox {

inline constexpr std::string_view kVersion = "0.1.0";

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_VERSION_H_
