#include "service/steps/capture_log.h"

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "capture/base/status.h"
#include "capture/base/unix_file.h"

namespace eyebox::service {
namespace {

constexpr const char* kColumns =
    "number,kind,role,series,level_id,drive_r,drive_g,drive_b,exposure_s,gain_db,frames,attempts,"
    "settle_s,settle_frames,settled,mean_dn,sigma_dn,remark\n";

const char* NameOf(FrameKind kind) {
  if (kind == FrameKind::kDark) return "dark";
  return kind == FrameKind::kFlat ? "flat" : "light";
}

std::string Quoted(const std::string& text) {
  return absl::StrCat("\"", absl::StrReplaceAll(text, {{"\"", "\"\""}}), "\"");
}

std::string DriveColumns(const Stimulus& stimulus) {
  if (!stimulus.drive) return ",,";
  const DriveRgb& drive = *stimulus.drive;
  return absl::StrFormat("%.9g,%.9g,%.9g", drive[0], drive[1], drive[2]);
}

std::string SettleColumns(const std::optional<capture::Settling>& settling) {
  if (!settling) return ",,";
  return absl::StrFormat("%.6f,%d,%d", settling->seconds, settling->frames,
                         settling->settled ? 1 : 0);
}

std::string LineOf(const capture::CaptureFigures& figures) {
  const CaptureSpec& spec = figures.reading.spec;
  const char* role = spec.role == CaptureRole::kReference ? "reference" : "measurement";
  return absl::StrFormat("%d,%s,%s,%s,%d,%s,%.9g,%.9g,%d,%d,%s,%.6f,%.6f,%s\n",
                         figures.reading.number, NameOf(spec.kind), role, Quoted(spec.series),
                         spec.level_id, DriveColumns(spec.stimulus), spec.exposure_s, spec.gain_db,
                         spec.repeats, figures.attempts, SettleColumns(figures.settling),
                         figures.reading.mean.mean_dn, figures.reading.mean.sigma_dn,
                         Quoted(figures.remark));
}

}  // namespace

std::filesystem::path CaptureLogPath(const std::filesystem::path& recording) {
  return recording / "results" / "capture" / "captures.csv";
}

absl::Status LogCapture(const std::filesystem::path& recording,
                        const capture::CaptureFigures& figures) {
  const std::filesystem::path file = CaptureLogPath(recording);
  EYEBOX_RETURN_IF_ERROR(CreateFolders(file.parent_path()));
  std::error_code absent;
  const bool begin = std::filesystem::file_size(file, absent) == 0 || absent;
  errno = 0;
  std::ofstream log(file, std::ios::app);
  log << (begin ? kColumns : "") << LineOf(figures) << std::flush;
  if (log.good()) return absl::OkStatus();
  return SystemFailed(file.string(), errno == 0 ? EIO : errno, "check the disk");
}

}  // namespace eyebox::service
