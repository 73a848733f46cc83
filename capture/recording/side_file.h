// Writes, reads and mends the rows of a capture file that are no frames.
#ifndef EYEBOX_CAPTURE_RECORDING_SIDE_FILE_H_
#define EYEBOX_CAPTURE_RECORDING_SIDE_FILE_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/unix_file.h"
#include "capture/recording/side_rows.h"

namespace eyebox::capture {

// The state of one file that is being filled. `file` is given with each call: the caller's own.
class SideWriter {
 public:
  explicit SideWriter(const SideRows& room) : rows_(room) {}

  // What a caller must not give; found before anything is written. Errors: InvalidArgument (no
  // samples, or device times of another number), ResourceExhausted (no row is left).
  static absl::Status Check(const SampleBlock& block, const UnixFile& file);
  absl::Status CheckRoomForTriple(const UnixFile& file) const;

  // Writes what fits at its place; the rest is counted as lost. Not yet durable.
  // Errors of this and the following: the errno of the disk.
  absl::Status Append(const SampleBlock& block, UnixFile& file);
  // Writes the record of what was appended since the last group. To be called before a sync.
  absl::Status CloseGroup(UnixFile& file);
  absl::Status Append(const ClockTriple& triple, UnixFile& file);

  // As they are to stand in the manifest; sample_count is what groups vouch for.
  const SideRows& rows() const { return rows_; }

 private:
  SideRows rows_;
  std::vector<SampleRow> pending_;  // without a group
  uint64_t lost_told_ = 0;          // of samples_lost, what the last group says
  uint64_t groups_ = 0;
  uint64_t triples_ = 0;
};

using BlockVisitor = std::function<absl::Status(const SampleBlock&)>;

// Every block in order, each group compared with its checksum before it is shown.
// Errors: DataLoss (file and group named), the visitor's, the errno of the disk.
absl::Status VisitSideSamples(const UnixFile& file, const SideRows& rows,
                              const BlockVisitor& visit);
absl::StatusOr<std::vector<ClockTriple>> ReadTriples(const UnixFile& file, const SideRows& rows);

// Rows of a file that was never published: those that do not match their checksums become zeros,
// and `rows` counts what is left. `damaged` are the bytes of what was emptied. Not yet durable.
absl::Status MendSideRows(UnixFile& file, SideRows& rows, std::string& damaged);

// The same bytes in another file with as much room.
absl::Status CopySideRows(const UnixFile& from, const SideRows& from_rows, UnixFile& to,
                          const SideRows& to_rows);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_SIDE_FILE_H_
