// Names of rigs, and of what they have not finished capturing.
#ifndef EYEBOX_SERVICE_SERVER_STORE_RIG_NAMES_H_
#define EYEBOX_SERVICE_SERVER_STORE_RIG_NAMES_H_

#include <string>
#include <string_view>

#include "service/server/store/names.h"

namespace eyebox::service {

inline constexpr NameRule kRigNameRule = {"a rig", "rigs/", 8, kIdCharacters};
// What follows in the name of its file.
inline constexpr std::string_view kRigSuffix = ".textproto";

// Where an unfinished recording is kept, in the served folder.
inline std::string PartialName(const std::string& recording_id) {
  return ".partial-" + recording_id;
}

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_RIG_NAMES_H_
