#include "capture/recording/convert.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr int kLargestSidePx = 65535;
constexpr size_t kLongestName = 63;

absl::Status CheckRange(const std::string& where, double value, double minimum, double maximum) {
  if (value >= minimum && value <= maximum) return absl::OkStatus();
  return BadInput(where, "is " + std::to_string(value),
                  "give " + std::to_string(minimum) + " to " + std::to_string(maximum));
}

absl::Status CheckFinite(const std::string& where, double value) {
  if (std::isfinite(value)) return absl::OkStatus();
  return BadInput(where, "is not finite", "give a finite number");
}

absl::Status CheckPositive(const std::string& where, double value) {
  if (value > 0 && std::isfinite(value)) return absl::OkStatus();
  return BadInput(where, "is " + std::to_string(value), "give a positive number");
}

absl::Status CheckNotNegative(const std::string& where, double value) {
  if (value >= 0 && std::isfinite(value)) return absl::OkStatus();
  return BadInput(where, "is " + std::to_string(value), "give 0 or a positive number");
}

absl::Status Unspecified(const std::string& where) {
  return BadInput(where, "is missing or unknown to this version", "give one of its named values");
}

template <typename Domain, typename Proto>
using Pairs = std::initializer_list<std::pair<Domain, Proto>>;

constexpr Pairs<RecordingOrigin, v1::RecordingOrigin> kOrigins = {
    {RecordingOrigin::kCaptured, v1::RECORDING_ORIGIN_CAPTURED},
    {RecordingOrigin::kSimulated, v1::RECORDING_ORIGIN_SIMULATED},
    {RecordingOrigin::kImported, v1::RECORDING_ORIGIN_IMPORTED}};
constexpr Pairs<FrameKind, v1::FrameKind> kKinds = {{FrameKind::kLight, v1::FRAME_KIND_LIGHT},
                                                    {FrameKind::kDark, v1::FRAME_KIND_DARK},
                                                    {FrameKind::kFlat, v1::FRAME_KIND_FLAT}};
constexpr Pairs<StimulusPattern, v1::StimulusPattern> kPatterns = {
    {StimulusPattern::kFullField, v1::STIMULUS_PATTERN_FULL_FIELD},
    {StimulusPattern::kDisk, v1::STIMULUS_PATTERN_DISK},
    {StimulusPattern::kBlackDisk, v1::STIMULUS_PATTERN_BLACK_DISK},
    {StimulusPattern::kCheckerboard, v1::STIMULUS_PATTERN_CHECKERBOARD}};
constexpr Pairs<TriggerSource, v1::TriggerSource> kTriggers = {
    {TriggerSource::kSoftware, v1::TRIGGER_SOURCE_SOFTWARE},
    {TriggerSource::kLine, v1::TRIGGER_SOURCE_LINE},
    {TriggerSource::kFreeRun, v1::TRIGGER_SOURCE_FREE_RUN}};

constexpr Pairs<CaptureRole, v1::CaptureRole> kRoles = {
    {CaptureRole::kMeasurement, v1::CAPTURE_ROLE_UNSPECIFIED},
    {CaptureRole::kReference, v1::CAPTURE_ROLE_REFERENCE}};

template <typename Domain, typename Proto>
Proto ToProto(const Pairs<Domain, Proto>& pairs, Domain value) {
  return std::find_if(pairs.begin(), pairs.end(),
                      [value](const auto& pair) { return pair.first == value; })
      ->second;
}

template <typename Domain, typename Proto>
absl::StatusOr<Domain> FromProto(const Pairs<Domain, Proto>& pairs, Proto value,
                                 const std::string& where) {
  for (const auto& pair : pairs) {
    if (pair.second == value) return pair.first;
  }
  return Unspecified(where);
}

v1::Stimulus ToProto(const Stimulus& stimulus) {
  v1::Stimulus proto;
  proto.set_pattern(ToProto(kPatterns, stimulus.pattern));
  proto.set_diameter_deg(stimulus.diameter_deg);
  if (stimulus.drive) {
    proto.mutable_drive()->set_red((*stimulus.drive)[0]);
    proto.mutable_drive()->set_green((*stimulus.drive)[1]);
    proto.mutable_drive()->set_blue((*stimulus.drive)[2]);
  }
  return proto;
}

absl::StatusOr<Stimulus> FromProto(const v1::Stimulus& proto, const std::string& where) {
  Stimulus stimulus;
  EYEBOX_ASSIGN_OR_RETURN(stimulus.pattern,
                          FromProto(kPatterns, proto.pattern(), where + " pattern"));
  EYEBOX_RETURN_IF_ERROR(CheckRange(where + " diameter_deg", proto.diameter_deg(), 0, 180));
  stimulus.diameter_deg = proto.diameter_deg();
  if (!proto.has_drive()) return stimulus;
  const DriveRgb drive = {proto.drive().red(), proto.drive().green(), proto.drive().blue()};
  for (const double value : drive) {
    EYEBOX_RETURN_IF_ERROR(CheckRange(where + " drive", value, 0, 1));
  }
  stimulus.drive = drive;
  return stimulus;
}

bool IsResourceName(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string_view::npos;
}

absl::StatusOr<PinholeGeometry> FromProto(const v1::PinholeGeometry& proto,
                                          const std::string& where) {
  EYEBOX_RETURN_IF_ERROR(CheckPositive(where + " focal_length_px", proto.focal_length_px()));
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " principal_x_px", proto.principal_x_px()));
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " principal_y_px", proto.principal_y_px()));
  return PinholeGeometry{proto.focal_length_px(), proto.principal_x_px(), proto.principal_y_px()};
}

v1::CameraState ToProto(const CameraSettings& settings) {
  v1::CameraState proto;
  proto.set_trigger(ToProto(kTriggers, settings.trigger));
  proto.set_trigger_line(settings.trigger_line);
  proto.set_frame_rate_hz(settings.frame_rate_hz);
  if (settings.black_level) proto.set_black_level(*settings.black_level);
  return proto;
}

absl::StatusOr<CameraSettings> FromProto(const v1::CameraState& proto, const std::string& where) {
  CameraSettings settings;
  EYEBOX_ASSIGN_OR_RETURN(settings.trigger,
                          FromProto(kTriggers, proto.trigger(), where + " trigger"));
  if ((settings.trigger == TriggerSource::kLine) == proto.trigger_line().empty()) {
    return BadInput(where + " trigger_line", "is '" + proto.trigger_line() + "'",
                    "give it with TRIGGER_SOURCE_LINE and with nothing else");
  }
  EYEBOX_RETURN_IF_ERROR(CheckNotNegative(where + " frame_rate_hz", proto.frame_rate_hz()));
  settings.trigger_line = proto.trigger_line();
  settings.frame_rate_hz = proto.frame_rate_hz();
  if (!proto.has_black_level()) return settings;
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " black_level", proto.black_level()));
  settings.black_level = proto.black_level();
  return settings;
}

}  // namespace

v1::Rig ToProto(const RigConfig& rig) {
  v1::Rig proto;
  proto.set_name(rig.name);
  proto.set_camera_uri(rig.camera_uri);
  proto.set_seed(rig.seed);
  proto.set_photodiode_uri(rig.photodiode_uri);
  proto.set_trigger_uri(rig.trigger_uri);
  proto.set_camera_trigger_line(rig.camera_trigger_line);
  proto.set_sensor(rig.sensor);
  return proto;
}

v1::CameraInfo ToProto(const CameraInfo& camera) {
  v1::CameraInfo proto;
  proto.set_uri(camera.uri);
  proto.set_vendor(camera.vendor);
  proto.set_model(camera.model);
  proto.set_serial(camera.serial);
  proto.set_sensor_width_px(camera.sensor_size.width_px);
  proto.set_sensor_height_px(camera.sensor_size.height_px);
  proto.set_significant_bits(camera.significant_bits);
  proto.set_exposure_min_s(camera.exposure_min_s);
  proto.set_exposure_max_s(camera.exposure_max_s);
  proto.set_gain_min_db(camera.gain_min_db);
  proto.set_gain_max_db(camera.gain_max_db);
  proto.set_pixel_format(camera.pixel_format);
  proto.set_black_level_min(camera.black_level_min);
  proto.set_black_level_max(camera.black_level_max);
  proto.set_software_trigger(camera.software_trigger);
  for (const std::string& line : camera.trigger_lines) proto.add_trigger_lines(line);
  proto.set_free_run(camera.free_run);
  return proto;
}

v1::CaptureSpec ToProto(const CaptureSpec& spec) {
  v1::CaptureSpec proto;
  proto.set_kind(ToProto(kKinds, spec.kind));
  proto.set_series(spec.series);
  proto.set_level_id(spec.level_id);
  *proto.mutable_stimulus() = ToProto(spec.stimulus);
  proto.set_exposure_s(spec.exposure_s);
  proto.set_gain_db(spec.gain_db);
  proto.set_repeats(spec.repeats);
  if (spec.luminance_cd_m2) proto.set_luminance_cd_m2(*spec.luminance_cd_m2);
  if (spec.luminance_relative_sigma) {
    proto.set_luminance_relative_sigma(*spec.luminance_relative_sigma);
  }
  proto.set_role(ToProto(kRoles, spec.role));
  return proto;
}

v1::CapturePlan ToProto(const CapturePlan& plan) {
  v1::CapturePlan proto;
  for (const CaptureSpec& spec : plan.captures) *proto.add_captures() = ToProto(spec);
  return proto;
}

v1::Recording ToProto(const RecordingHeader& header) {
  v1::Recording proto;
  proto.set_origin(ToProto(kOrigins, header.origin));
  *proto.mutable_rig() = ToProto(header.rig);
  *proto.mutable_camera() = ToProto(header.camera);
  if (header.geometry) {
    v1::PinholeGeometry& geometry = *proto.mutable_geometry();
    geometry.set_focal_length_px(header.geometry->focal_length_px);
    geometry.set_principal_x_px(header.geometry->principal_x_px);
    geometry.set_principal_y_px(header.geometry->principal_y_px);
  }
  *proto.mutable_plan() = ToProto(header.plan);
  proto.set_software_version(header.software_version);
  proto.set_created_real_ns(header.created_real_ns);
  if (header.camera_settings) *proto.mutable_camera_state() = ToProto(*header.camera_settings);
  return proto;
}

absl::StatusOr<RigConfig> FromProto(const v1::Rig& proto, const std::string& where) {
  if (!IsResourceName(proto.name())) {
    return BadInput(where + " name", "is '" + proto.name() + "'",
                    "give 1 to 63 characters of a-z, 0-9 and -");
  }
  if (proto.camera_uri().empty()) {
    return BadInput(where + " camera_uri", "is empty", "give for example \"sim:rift-s-like\"");
  }
  if (!proto.camera_trigger_line().empty() && proto.trigger_uri().empty()) {
    return BadInput(where + " camera_trigger_line", "is given without a trigger",
                    "name the trigger that is wired to it in trigger_uri");
  }
  return RigConfig{.name = proto.name(),
                   .camera_uri = proto.camera_uri(),
                   .seed = proto.seed(),
                   .photodiode_uri = proto.photodiode_uri(),
                   .trigger_uri = proto.trigger_uri(),
                   .camera_trigger_line = proto.camera_trigger_line(),
                   .sensor = proto.sensor()};
}

absl::StatusOr<CameraInfo> FromProto(const v1::CameraInfo& proto, const std::string& where) {
  EYEBOX_RETURN_IF_ERROR(
      CheckRange(where + " sensor_width_px", proto.sensor_width_px(), 1, kLargestSidePx));
  EYEBOX_RETURN_IF_ERROR(
      CheckRange(where + " sensor_height_px", proto.sensor_height_px(), 1, kLargestSidePx));
  EYEBOX_RETURN_IF_ERROR(CheckRange(where + " significant_bits", proto.significant_bits(), 1, 16));
  EYEBOX_RETURN_IF_ERROR(CheckNotNegative(where + " exposure_min_s", proto.exposure_min_s()));
  EYEBOX_RETURN_IF_ERROR(CheckNotNegative(where + " exposure_max_s", proto.exposure_max_s()));
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " gain_min_db", proto.gain_min_db()));
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " gain_max_db", proto.gain_max_db()));
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " black_level_min", proto.black_level_min()));
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " black_level_max", proto.black_level_max()));
  CameraInfo camera;
  camera.uri = proto.uri();
  camera.vendor = proto.vendor();
  camera.model = proto.model();
  camera.serial = proto.serial();
  camera.sensor_size = {proto.sensor_width_px(), proto.sensor_height_px()};
  camera.significant_bits = proto.significant_bits();
  camera.exposure_min_s = proto.exposure_min_s();
  camera.exposure_max_s = proto.exposure_max_s();
  camera.gain_min_db = proto.gain_min_db();
  camera.gain_max_db = proto.gain_max_db();
  camera.pixel_format = proto.pixel_format();
  camera.black_level_min = proto.black_level_min();
  camera.black_level_max = proto.black_level_max();
  camera.software_trigger = !proto.has_software_trigger() || proto.software_trigger();
  camera.trigger_lines = {proto.trigger_lines().begin(), proto.trigger_lines().end()};
  camera.free_run = proto.free_run();
  return camera;
}

absl::StatusOr<CaptureSpec> FromProto(const v1::CaptureSpec& proto, const std::string& where) {
  CaptureSpec spec;
  EYEBOX_ASSIGN_OR_RETURN(spec.kind, FromProto(kKinds, proto.kind(), where + " kind"));
  EYEBOX_ASSIGN_OR_RETURN(spec.stimulus, FromProto(proto.stimulus(), where + " stimulus"));
  EYEBOX_RETURN_IF_ERROR(CheckPositive(where + " exposure_s", proto.exposure_s()));
  EYEBOX_RETURN_IF_ERROR(CheckFinite(where + " gain_db", proto.gain_db()));
  EYEBOX_RETURN_IF_ERROR(CheckPositive(where + " repeats", proto.repeats()));
  spec.series = proto.series();
  spec.level_id = proto.level_id();
  spec.exposure_s = proto.exposure_s();
  spec.gain_db = proto.gain_db();
  spec.repeats = proto.repeats();
  if (proto.has_luminance_cd_m2()) {
    EYEBOX_RETURN_IF_ERROR(CheckNotNegative(where + " luminance_cd_m2", proto.luminance_cd_m2()));
    spec.luminance_cd_m2 = proto.luminance_cd_m2();
  }
  if (proto.has_luminance_relative_sigma()) {
    EYEBOX_RETURN_IF_ERROR(
        CheckRange(where + " luminance_relative_sigma", proto.luminance_relative_sigma(), 0, 1));
    spec.luminance_relative_sigma = proto.luminance_relative_sigma();
  }
  EYEBOX_ASSIGN_OR_RETURN(spec.role, FromProto(kRoles, proto.role(), where + " role"));
  return spec;
}

absl::StatusOr<RecordingHeader> FromProto(const v1::Recording& proto, const std::string& where) {
  RecordingHeader header;
  EYEBOX_ASSIGN_OR_RETURN(header.origin, FromProto(kOrigins, proto.origin(), where + " origin"));
  EYEBOX_ASSIGN_OR_RETURN(header.rig, FromProto(proto.rig(), where + ", rig"));
  EYEBOX_ASSIGN_OR_RETURN(header.camera, FromProto(proto.camera(), where + ", camera"));
  if (proto.has_geometry()) {
    EYEBOX_ASSIGN_OR_RETURN(header.geometry, FromProto(proto.geometry(), where + ", geometry"));
    header.camera.geometry = header.geometry;
  }
  for (int i = 0; i < proto.plan().captures_size(); ++i) {
    const std::string capture = where + ", plan, capture " + std::to_string(i + 1);
    EYEBOX_ASSIGN_OR_RETURN(header.plan.captures.emplace_back(),
                            FromProto(proto.plan().captures(i), capture));
  }
  header.software_version = proto.software_version();
  header.created_real_ns = proto.created_real_ns();
  if (proto.has_camera_state()) {
    EYEBOX_ASSIGN_OR_RETURN(header.camera_settings,
                            FromProto(proto.camera_state(), where + ", camera_state"));
  }
  return header;
}

}  // namespace eyebox::capture
