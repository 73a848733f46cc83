// Every name that a client may send, checked against one table before it touches anything.
#ifndef EYEBOX_SERVICE_SERVER_STORE_NAMES_H_
#define EYEBOX_SERVICE_SERVER_STORE_NAMES_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::service {

// A name is `prefix`, then 1 to `max_parts` parts with '/' between. A part is 1 to 64 characters
// of `characters`, and neither "." nor "..".
struct NameRule {
  std::string_view what;  // for messages
  std::string_view prefix;
  int max_parts = 1;
  std::string_view characters;
};

inline constexpr std::string_view kIdCharacters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";
inline constexpr std::string_view kRigCharacters = "abcdefghijklmnopqrstuvwxyz0123456789-";

inline constexpr NameRule kRequestIdRule = {"a request id", "", 1, kIdCharacters};
inline constexpr NameRule kJobRule = {"a job", "jobs/", 1, kIdCharacters};
inline constexpr NameRule kRecordingRule = {"a recording", "", 8, kIdCharacters};
inline constexpr NameRule kArtifactRule = {"a file of a result", "", 1, kIdCharacters};
inline constexpr NameRule kRigRule = {"a rig", "", 1, kRigCharacters};
inline constexpr NameRule kCameraRule = {"a simulated camera", "sim:", 1, kIdCharacters};
inline constexpr NameRule kPhotodiodeRule = {"a simulated photodiode", "sim:", 1, kIdCharacters};
inline constexpr NameRule kTriggerRule = {"a simulated trigger", "sim:", 1, kIdCharacters};
inline constexpr NameRule kLineRule = {"an input of a camera", "", 1, kIdCharacters};

// What follows the prefix. `field` is the request's field, for example "rig.name".
// Errors: InvalidArgument with the field (see BadField).
absl::StatusOr<std::string> CheckName(const NameRule& rule, std::string_view field,
                                      std::string_view name);

// InvalidArgument whose message starts with the field, and which carries it for FieldOf.
absl::Status BadField(std::string_view field, std::string_view what, std::string_view remedy);
// `status` naming the field that led to it.
absl::Status WithField(absl::Status status, std::string_view field);
// The field that the status names, empty if none.
std::string FieldOf(const absl::Status& status);

// As much of `text` as fits a message, without control characters.
std::string Quoted(std::string_view text);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_NAMES_H_
