// Rigs that clients may name.
#ifndef EYEBOX_SERVICE_SERVER_STORE_RIGS_H_
#define EYEBOX_SERVICE_SERVER_STORE_RIGS_H_

#include <string>

#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "eyebox/v1/capture_service.pb.h"
#include "service/server/store/beneath.h"
#include "service/server/store/rig_names.h"

namespace eyebox::service {

// The rig file of rigs/R below the served folder; messages name the rig, no path of the host.
// Errors: InvalidArgument (the name, the file), NotFound, PermissionDenied; FailedPrecondition (it
// names a folder of a sensor, which this version does not follow).
absl::StatusOr<capture::RigConfig> ReadRig(const RootFolder& data, const std::string& name);

// The rig that a capture job names. Errors: those of ReadRig().
absl::StatusOr<capture::RigConfig> RigOfWork(const RootFolder& data, const v1::CaptureWork& work);

// Of a rig that a client gave as a message.
capture::RigConfig ConfigOf(const v1::Rig& rig);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_RIGS_H_
