// Which rows of a capture file that was never published hold whole frames.
#ifndef EYEBOX_CAPTURE_RECORDING_RECOVER_ROWS_H_
#define EYEBOX_CAPTURE_RECORDING_RECOVER_ROWS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/unix_file.h"
#include "capture/recording/manifest.h"

namespace eyebox::capture {

struct RowCensus {
  int whole = 0;                // record and pixels match
  std::vector<int> damaged;     // not so, or empty before a row that is whole
  std::vector<int> unreadable;  // of the damaged those whose record is not empty
};

// Whether the bytes that HDF5 reads by are those that were written.
// Errors: DataLoss (they are not), the errno of the disk.
absl::Status CheckStructure(const UnixFile& file, const BegunCapture& begun);

// Errors: the errno of the disk.
absl::StatusOr<RowCensus> TakeCensus(const UnixFile& file, const ManifestEntry& entry);

// All bytes of /frame_records.
absl::StatusOr<std::string> ReadRecords(const UnixFile& file, const ManifestEntry& entry);

// Makes the records of `rows` zeros: rows that hold no frame. Not yet durable.
absl::Status EmptyRows(const std::vector<int>& rows, const ManifestEntry& entry, UnixFile& file);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_RECOVER_ROWS_H_
