// Frames that other software took, made a recording.
#ifndef EYEBOX_CAPTURE_RECORDING_IMPORT_H_
#define EYEBOX_CAPTURE_RECORDING_IMPORT_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"

namespace eyebox::capture {

struct ImportReport {
  int64_t frames = 0;
  int captures = 0;
  std::vector<std::string> series;  // of light frames, in order of appearance
};

// Called after every frame.
using ImportProgress = std::function<void(int64_t frames_done, int64_t frames_total)>;

// Reads `folder`/index.csv (see ReadImportIndex) and the 8- or 16-bit greyscale TIFF or PNG files
// that it names. Frames of one kind, series, stimulus, exposure, gain and luminance form a capture,
// in the order of `repeat`; captures stand in the order in which the index first names them.
// Significant bits are those of column bits, or else of the files. Camera ids count 1, 2, ...
// through the index; what the index does not tell (time of reception above all) stays 0 or unknown.
// `recording` appears whole or not at all. `clock` dates the header.
// Errors: those of ReadImportIndex and ReadGreyImage; InvalidArgument (frames of differing size or
// bits, counts beyond the bits, a repeat given twice), AlreadyExists, the errno of the disk.
absl::StatusOr<ImportReport> ImportFolder(const std::filesystem::path& folder,
                                          const std::filesystem::path& recording,
                                          const Clock* clock,
                                          const ImportProgress& progress = nullptr);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_IMPORT_H_
