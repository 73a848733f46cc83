#include "service/server/catalogue/catalogue.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>

#include <chrono>
#include <iterator>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "service/server/catalogue/describe.h"
#include "service/server/store/served.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

constexpr char kRemedy[] = "give a state folder that can be written to";

constexpr std::chrono::milliseconds kLockPause(10);

absl::Status Stopped() { return absl::CancelledError("the catalogue is being closed"); }

// The file has to be made anew.
bool IsUseless(const absl::Status& status) {
  return absl::IsDataLoss(status) || absl::IsNotFound(status);
}

// SQLite would read a log that it finds beside a file into it, even another file's.
absl::Status RemoveLogs(const fs::path& file) {
  for (const char* log : {"-wal", "-shm", "-journal"}) {
    std::error_code error;
    fs::remove(file.string() + log, error);
    if (error) return SystemFailed(file.string() + log, error.value(), kRemedy);
  }
  return absl::OkStatus();
}

// Whether the next look at the same files would say the same.
bool IsLasting(const absl::Status& status) {
  return status.ok() || absl::IsDataLoss(status) || absl::IsInvalidArgument(status);
}

// Nothing if the recording is gone since the folder was listed.
std::optional<IndexRow> ReadRow(const RootFolder& data, const std::string& name,
                                std::string stamp) {
  const absl::StatusOr<OpenRecording> recording = OpenNamed(data, "name", name);
  if (absl::IsNotFound(recording.status())) return std::nullopt;
  if (!IsLasting(recording.status())) stamp.clear();
  return IndexRow{.entry = recording.ok() ? Describe(name, *recording)
                                          : DescribeDamaged(name, recording.status()),
                  .stamp = std::move(stamp)};
}

}  // namespace

Catalogue::Catalogue(fs::path state, const RootFolder* data, const Clock* clock, Tell tell)
    : state_(std::move(state)), data_(data), clock_(clock), tell_(std::move(tell)) {}

absl::StatusOr<OwnedFd> Catalogue::Lock() const {
  const fs::path file = state_ / "catalogue.lock";
  OwnedFd fd(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0660));
  if (fd.get() < 0) return SystemFailed(file.string(), errno, kRemedy);
  // Looks again and again instead of waiting in the kernel, where Stop would not be heard.
  while (flock(fd.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) return SystemFailed(file.string(), errno, kRemedy);
    if (stopping_) return Stopped();
    std::this_thread::sleep_for(kLockPause);
  }
  return fd;
}

absl::Status Catalogue::Refresh() {
  EYEBOX_ASSIGN_OR_RETURN(const OwnedFd lock, Lock());
  const absl::Status refreshed = RefreshLocked();
  if (!IsUseless(refreshed)) return refreshed;
  return RebuildLocked(std::string(refreshed.message()));
}

absl::Status Catalogue::Rebuild(const std::string& why) {
  EYEBOX_ASSIGN_OR_RETURN(const OwnedFd lock, Lock());
  return RebuildLocked(why);
}

absl::Status Catalogue::RefreshLocked() {
  EYEBOX_ASSIGN_OR_RETURN(IndexFile index, IndexFile::Open(File()));
  EYEBOX_ASSIGN_OR_RETURN(const Stamps known, index.Stamps());
  const absl::StatusOr<IndexChanges> changes = ChangesSince(known);
  if (!changes.ok()) {
    // Not the file's fault, whatever the code.
    return IsUseless(changes.status()) ? absl::InternalError(changes.status().message())
                                       : changes.status();
  }
  if (changes->put.empty() && changes->removed.empty()) return absl::OkStatus();
  return index.Apply(*changes);
}

absl::Status Catalogue::RebuildLocked(const std::string& why) {
  EYEBOX_ASSIGN_OR_RETURN(const IndexChanges all, ChangesSince({}));
  const fs::path fresh = File().string() + ".new";
  std::error_code error;
  fs::remove(fresh, error);
  if (error) return SystemFailed(fresh.string(), error.value(), kRemedy);
  EYEBOX_RETURN_IF_ERROR(RemoveLogs(fresh));
  {
    EYEBOX_ASSIGN_OR_RETURN(IndexFile index, IndexFile::Create(fresh));
    EYEBOX_RETURN_IF_ERROR(index.Apply(all));
  }
  EYEBOX_RETURN_IF_ERROR(RemoveLogs(File()));
  fs::rename(fresh, File(), error);
  if (error) return SystemFailed(File().string(), error.value(), kRemedy);
  tell_(absl::StrCat("catalogue made anew from ", all.put.size(), " recordings: ", why));
  return absl::OkStatus();
}

absl::StatusOr<IndexChanges> Catalogue::ChangesSince(const Stamps& known) const {
  EYEBOX_ASSIGN_OR_RETURN(const Served served, ListServed(*data_));
  Stamps gone = known;
  IndexChanges changes;
  for (const std::string& name : served.recordings) {
    if (stopping_) return Stopped();
    // Before the files are read: what is touched meanwhile is read again next time.
    std::string stamp = StampOf(*data_, name, clock_->RealNs());
    const auto before = known.find(name);
    if (before != known.end() && !stamp.empty() && before->second == stamp) {
      gone.erase(name);
    } else if (auto row = ReadRow(*data_, name, std::move(stamp))) {
      gone.erase(name);
      changes.put.push_back(*std::move(row));
    }
  }
  for (const auto& [name, stamp] : gone) changes.removed.push_back(name);
  return changes;
}

absl::StatusOr<v1::ListRecordingsResponse> Catalogue::List(
    const v1::ListRecordingsRequest& request) {
  EYEBOX_RETURN_IF_ERROR(QueryOf(request).status());
  EYEBOX_RETURN_IF_ERROR(Refresh());
  auto page = Look(request);
  if (!IsUseless(page.status())) return page;
  EYEBOX_RETURN_IF_ERROR(Rebuild(std::string(page.status().message())));
  return Look(request);
}

absl::StatusOr<v1::ListRecordingsResponse> Catalogue::Look(
    const v1::ListRecordingsRequest& request) const {
  EYEBOX_ASSIGN_OR_RETURN(const CatalogueQuery query, QueryOf(request));
  EYEBOX_ASSIGN_OR_RETURN(const IndexFile index, IndexFile::Open(File()));
  EYEBOX_ASSIGN_OR_RETURN(std::vector<v1::RecordingEntry> entries, index.Select(query));
  v1::ListRecordingsResponse response;
  if (static_cast<int>(entries.size()) > query.page_size) {
    entries.pop_back();
    response.set_next_page_token(TokenBehind(PlaceOf(entries.back()), query));
  }
  *response.mutable_recordings() = {std::make_move_iterator(entries.begin()),
                                    std::make_move_iterator(entries.end())};
  return response;
}

}  // namespace eyebox::service
