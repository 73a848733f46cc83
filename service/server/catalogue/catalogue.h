// The recordings below the served folder, to be searched: an index over files, never the truth.
#ifndef EYEBOX_SERVICE_SERVER_CATALOGUE_CATALOGUE_H_
#define EYEBOX_SERVICE_SERVER_CATALOGUE_CATALOGUE_H_

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "eyebox/v1/recording_service.pb.h"
#include "service/server/catalogue/index_file.h"
#include "service/server/catalogue/query.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {

// Keeps <state>/catalogue.sqlite. A file that is missing, malformed or of another version is made
// anew from the recordings, and `tell` is told why. Thread-safe; several processes may use one
// state folder: <state>/catalogue.lock is held by the one that brings the file up to date.
// Every call waits for the disk and does not belong in a reactor.
class Catalogue {
 public:
  using Tell = std::function<void(const std::string& what)>;

  // `state` exists. `data` and `clock` must outlive the catalogue.
  Catalogue(std::filesystem::path state, const RootFolder* data, const Clock* clock, Tell tell);

  // Brings it up to date, whoever wrote into the folder. Only recordings whose files were touched
  // are read. Errors: Cancelled (after Stop), ResourceExhausted (more than 100000 entries, disk
  // full), the errno of the disk.
  absl::Status Refresh();

  // Reads every recording, and puts a new file in the place of the old one.
  // Errors: those of Refresh.
  absl::Status Rebuild(const std::string& why);

  // Refreshes, then answers. Errors: InvalidArgument with the field, those of Refresh.
  absl::StatusOr<v1::ListRecordingsResponse> List(const v1::ListRecordingsRequest& request);

  // Answers from the file as it is. Errors: InvalidArgument with the field, those of IndexFile.
  absl::StatusOr<v1::ListRecordingsResponse> Look(const v1::ListRecordingsRequest& request) const;

  // Calls under way end with Cancelled before they read another recording, also those that wait for
  // another process.
  void Stop() { stopping_ = true; }

 private:
  using Stamps = std::map<std::string, std::string>;

  std::filesystem::path File() const { return state_ / "catalogue.sqlite"; }
  absl::StatusOr<OwnedFd> Lock() const;
  absl::Status RefreshLocked();
  absl::Status RebuildLocked(const std::string& why);
  // What differs from `known` on disk.
  absl::StatusOr<IndexChanges> ChangesSince(const Stamps& known) const;

  const std::filesystem::path state_;
  const RootFolder* const data_;
  const Clock* const clock_;
  const Tell tell_;
  std::atomic<bool> stopping_ = false;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CATALOGUE_CATALOGUE_H_
