// Mends what a crash left: a recording that was killed at any moment becomes one that verifies.
#ifndef EYEBOX_CAPTURE_RECORDING_RECOVER_H_
#define EYEBOX_CAPTURE_RECORDING_RECOVER_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"

namespace eyebox::capture {

// The capture that was under way.
struct RecoveredCapture {
  int number = 0;
  int frames_announced = 0;
  int frames_kept = 0;                 // record and pixels match their checksums
  std::vector<int> damaged_rows = {};  // a frame was there and is not whole: no longer shown as one
  int64_t samples_kept = 0;            // of the photodiode, whose group matches its checksums
  bool was_renamed = false;            // it had been published but for its record in the manifest
  std::filesystem::path file = {};  // where it is now; empty where it held no frame and was removed
  std::string remark = {};          // why it could not be published; empty otherwise
};

struct RecoverReport {
  uint64_t manifest_bytes_cut = 0;          // behind the last whole record
  std::optional<RecoveredCapture> capture;  // nothing: none was under way
  std::vector<std::filesystem::path> kept_aside;
  VerifyReport verified;  // of the recording as it is now
};

// A torn end of manifest.log is cut off, a capture file that had its name but no record is entered,
// and of a .partial the whole frames are published as a capture that stopped early. Nothing is
// returned as data that its checksums do not vouch for. What is removed from its place and held
// anything is kept in the folder aside/. May be repeated, also after a crash of its own.
// Errors: NotFound (no recording), FailedPrecondition (it is being recorded to), DataLoss (damage
// that no crash makes: a header, a manifest record with whole ones behind it, a published capture),
// the errno of the disk; each names the file.
absl::StatusOr<RecoverReport> RecoverRecording(const std::filesystem::path& recording);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_RECOVER_H_
