// Between the words of a measurement and the messages that store them. Domain structs know no
// proto; this is the edge.
#ifndef EYEBOX_CAPTURE_RECORDING_CONVERT_H_
#define EYEBOX_CAPTURE_RECORDING_CONVERT_H_

#include <string>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/recording/header.h"
#include "eyebox/v1/recording.pb.h"

namespace eyebox::capture {

v1::Rig ToProto(const RigConfig& rig);
v1::CameraInfo ToProto(const CameraInfo& camera);
v1::CaptureSpec ToProto(const CaptureSpec& spec);
v1::CapturePlan ToProto(const CapturePlan& plan);
v1::Recording ToProto(const RecordingHeader& header);

// `where` names the message in errors, for example "rig.textproto" or "recording.textproto, plan".
// Errors: InvalidArgument (a field that is missing, out of range or not finite: named).

// The name must be [a-z0-9-]{1,63}. The URI's scheme is not looked up: a recording may come from a
// camera that is not known here.
absl::StatusOr<RigConfig> FromProto(const v1::Rig& rig, const std::string& where);
absl::StatusOr<CameraInfo> FromProto(const v1::CameraInfo& camera, const std::string& where);
absl::StatusOr<CaptureSpec> FromProto(const v1::CaptureSpec& spec, const std::string& where);
absl::StatusOr<RecordingHeader> FromProto(const v1::Recording& recording, const std::string& where);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_CONVERT_H_
