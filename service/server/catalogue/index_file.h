// The SQLite file behind the catalogue: what was read from recordings, so that it can be searched.
// Only here are SQLite's words known, and its exceptions end here.
#ifndef EYEBOX_SERVICE_SERVER_CATALOGUE_INDEX_FILE_H_
#define EYEBOX_SERVICE_SERVER_CATALOGUE_INDEX_FILE_H_

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "eyebox/v1/recording_service.pb.h"
#include "service/server/catalogue/query.h"

namespace eyebox::service {

struct IndexRow {
  v1::RecordingEntry entry;
  std::string stamp;  // of the files that it was read from; empty: read them again next time
};

struct IndexChanges {
  std::vector<IndexRow> put;         // new, or in place of what was there under the name
  std::vector<std::string> removed;  // recordings/R
};

// One connection, for one thread. Any number may read while one writes, in this process or others.
// Errors of all calls: DataLoss (malformed, altered or of another version: it must be made anew),
// NotFound (no file), Unavailable (held by another for too long), ResourceExhausted (disk full),
// PermissionDenied, FailedPrecondition (no file that could be replaced), Internal. Each names the
// file.
class IndexFile {
 public:
  // A file that exists.
  static absl::StatusOr<IndexFile> Open(const std::filesystem::path& file);
  // A new one, without recordings.
  static absl::StatusOr<IndexFile> Create(const std::filesystem::path& file);
  IndexFile(IndexFile&&) noexcept;
  IndexFile& operator=(IndexFile&&) noexcept;
  ~IndexFile();

  // By name. Compares every row with its checksum.
  absl::StatusOr<std::map<std::string, std::string>> Stamps() const;
  // All or nothing.
  absl::Status Apply(const IndexChanges& changes);
  // At most query.page_size + 1 recordings, the first of the next page among them.
  absl::StatusOr<std::vector<v1::RecordingEntry>> Select(const CatalogueQuery& query) const;

 private:
  struct Connection;
  IndexFile(std::filesystem::path file, std::unique_ptr<Connection> connection);

  std::filesystem::path file_;
  std::unique_ptr<Connection> connection_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CATALOGUE_INDEX_FILE_H_
