// A recording below the served folder, and what its files say of it.
#ifndef EYEBOX_SERVICE_SERVER_CATALOGUE_DESCRIBE_H_
#define EYEBOX_SERVICE_SERVER_CATALOGUE_DESCRIBE_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "eyebox/v1/recording_service.pb.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {

struct OpenRecording {
  OwnedFd folder;
  std::unique_ptr<capture::RecordingReader> reader;
};

// `name` is recordings/R, from the request's field `field`; messages name it, no path of the host.
// Errors: InvalidArgument with the field, PermissionDenied, those of RecordingReader::Open.
absl::StatusOr<OpenRecording> OpenNamed(const RootFolder& data, const std::string& field,
                                        const std::string& name);

// All of the entry. Reads the folder, but no frame.
v1::RecordingEntry Describe(const std::string& name, const OpenRecording& recording);
// Of one that OpenNamed refused.
v1::RecordingEntry DescribeDamaged(const std::string& name, const absl::Status& problem);

// Changes whenever a file of the recording is written, renamed, added or removed, down to the files
// of its folders; looks at none of their bytes. Empty where a file was touched so shortly before
// `now_real_ns` (CLOCK_REALTIME) that another touch could look the same, or cannot be looked at:
// then nothing may be concluded.
std::string StampOf(const RootFolder& data, const std::string& name, int64_t now_real_ns);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CATALOGUE_DESCRIBE_H_
