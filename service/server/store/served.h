// What lies below the served folder, by the names that clients use.
#ifndef EYEBOX_SERVICE_SERVER_STORE_SERVED_H_
#define EYEBOX_SERVICE_SERVER_STORE_SERVED_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "service/server/store/beneath.h"
#include "service/server/store/names.h"

namespace eyebox::service {

inline constexpr NameRule kRecordingNameRule = {"a recording", "recordings/", 8, kIdCharacters};

struct Served {
  std::vector<std::string> recordings;  // recordings/R, sorted
  std::vector<std::string> rigs;        // rigs/R, sorted
};

// Walks at most 8 folders deep, through no link, and into no recording. Hidden folders, unfinished
// recordings among them, and names that a client could not give are left out.
// Errors: ResourceExhausted (more than 100000 entries), the errno of the disk.
absl::StatusOr<Served> ListServed(const RootFolder& data);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_SERVED_H_
