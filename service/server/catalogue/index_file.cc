#include "service/server/catalogue/index_file.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "capture/recording/checksum.h"
#include "service/server/catalogue/select.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

// To be raised when kSchema or the meaning of a column changes; the file is then made anew.
constexpr int kSchemaVersion = 1;
constexpr int kBusyTimeoutMs = 10'000;

// Without rowid, so that a row stands in one place alone, which its checksum covers.
constexpr char kSchema[] =
    "CREATE TABLE recordings (name TEXT PRIMARY KEY NOT NULL, rig TEXT NOT NULL, "
    "camera TEXT NOT NULL, state INTEGER NOT NULL, origin INTEGER NOT NULL, start_ns INTEGER, "
    "captures INTEGER NOT NULL, frames INTEGER NOT NULL, bytes INTEGER NOT NULL, "
    "levels INTEGER NOT NULL, series TEXT NOT NULL, results TEXT NOT NULL, entry BLOB NOT NULL, "
    "stamp TEXT NOT NULL, checksum INTEGER NOT NULL) WITHOUT ROWID";
constexpr char kColumns[] =
    "name, rig, camera, state, origin, start_ns, captures, frames, bytes, levels, series, results, "
    "entry, stamp, checksum";
constexpr int kNameColumn = 0;
constexpr int kEntryColumn = 12;
constexpr int kStampColumn = 13;
constexpr int kChecksumColumn = 14;

absl::Status Useless(const fs::path& file, const std::string& what) {
  return Corrupt(file.filename().string(), what, "eyebox catalogue --rebuild makes it anew");
}

absl::Status StatusOf(const fs::path& file, const SQLite::Exception& error) {
  const std::string where = file.filename().string();
  const std::string what = absl::StrCat("SQLite says ", Quoted(error.what()));
  switch (error.getErrorCode()) {
    case 5:   // SQLITE_BUSY
    case 6:   // SQLITE_LOCKED
    case 15:  // SQLITE_PROTOCOL
      return absl::UnavailableError(Complaint(where, what, "try again"));
    case 3:   // SQLITE_PERM
    case 8:   // SQLITE_READONLY
    case 23:  // SQLITE_AUTH
      return absl::PermissionDeniedError(Complaint(where, what, "make it and its folder writable"));
    case 13:  // SQLITE_FULL
      return absl::ResourceExhaustedError(Complaint(where, what, "free some of its disk"));
    case 7:   // SQLITE_NOMEM
    case 10:  // SQLITE_IOERR
    case 14:  // SQLITE_CANTOPEN
      return absl::InternalError(
          Complaint(where, what, "check the disk and the permissions of its folder"));
    default:
      // No statement here fails on the file that Create makes.
      return Useless(file, absl::StrCat("is no catalogue that can be used: ", what));
  }
}

// Where SQLite's exceptions end.
template <typename Do>
auto Guarded(const fs::path& file, Do run) -> decltype(run()) {
  try {
    return run();
  } catch (const SQLite::Exception& error) {
    return StatusOf(file, error);
  }
}

template <typename Names>
std::string Fenced(const Names& names) {
  std::string all;
  for (const std::string& name : names) absl::StrAppend(&all, std::string(1, kNameFence), name);
  return all.empty() ? all : all + kNameFence;
}

// Of all columns before it, each with its length, so that none can lend to another.
class RowChecksum {
 public:
  void Add(std::string_view text) { absl::StrAppend(&all_, text.size(), ":", std::string(text)); }
  int64_t Value() const { return static_cast<int64_t>(capture::Checksum(all_)); }

 private:
  std::string all_;
};

int64_t ChecksumOf(const SQLite::Statement& row) {
  RowChecksum checksum;
  for (int i = 0; i < kChecksumColumn; ++i) {
    const SQLite::Column column = row.getColumn(i);
    checksum.Add(absl::StrCat(column.getType()));
    checksum.Add(column.getString());
  }
  return checksum.Value();
}

absl::Status CheckRow(const fs::path& file, const SQLite::Statement& row) {
  if (row.getColumn(kChecksumColumn).getInt64() == ChecksumOf(row)) return absl::OkStatus();
  return Useless(file, "holds a row that is not as it was written");
}

void BindRow(const IndexRow& row, SQLite::Statement& statement) {
  const v1::RecordingEntry& entry = row.entry;
  const std::string bytes = entry.SerializeAsString();
  const int64_t start_ns = PlaceOf(entry).start_ns;
  int at = 0;
  statement.bind(++at, entry.name());
  statement.bind(++at, entry.header().rig().name());
  statement.bind(++at, entry.header().camera().uri());
  statement.bind(++at, static_cast<int>(entry.state()));
  statement.bind(++at, static_cast<int>(entry.header().origin()));
  ++at;
  if (start_ns > 0) statement.bind(at, start_ns);
  statement.bind(++at, entry.captures());
  statement.bind(++at, int64_t{entry.frames()});
  statement.bind(++at, int64_t{entry.bytes()});
  statement.bind(++at, entry.levels());
  statement.bind(++at, Fenced(entry.series()));
  statement.bind(++at, Fenced(entry.results()));
  statement.bind(++at, bytes.data(), static_cast<int>(bytes.size()));
  statement.bind(++at, row.stamp);
}

}  // namespace

struct IndexFile::Connection {
  Connection(const fs::path& file, int flags) : database(file.string(), flags, kBusyTimeoutMs) {
    // What stands in the file is not trusted, and the last commits may be lost with the power.
    database.exec(
        "PRAGMA trusted_schema=OFF; PRAGMA cell_size_check=ON; PRAGMA synchronous=NORMAL");
  }
  SQLite::Database database;
};

IndexFile::IndexFile(fs::path file, std::unique_ptr<Connection> connection)
    : file_(std::move(file)), connection_(std::move(connection)) {}
IndexFile::IndexFile(IndexFile&&) noexcept = default;
IndexFile& IndexFile::operator=(IndexFile&&) noexcept = default;
IndexFile::~IndexFile() = default;

absl::StatusOr<IndexFile> IndexFile::Open(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (status.type() == fs::file_type::not_found) {
    return Missing(file.filename().string(), "does not exist",
                   "eyebox catalogue --rebuild makes it");
  }
  if (!fs::is_regular_file(status)) {
    return Rejected(file.filename().string(), "stands where the catalogue is kept and is no file",
                    "move it out of the state folder");
  }
  return Guarded(file, [&]() -> absl::StatusOr<IndexFile> {
    auto connection = std::make_unique<Connection>(file, SQLite::OPEN_READWRITE);
    SQLite::Database& database = connection->database;
    const int version = database.execAndGet("PRAGMA user_version").getInt();
    if (version != kSchemaVersion) {
      return Useless(file, absl::StrCat("is of version ", version, " instead of ", kSchemaVersion));
    }
    SQLite::Statement schema(database, "SELECT sql FROM sqlite_schema");
    if (!schema.executeStep() || schema.getColumn(0).getString() != kSchema ||
        schema.executeStep()) {
      return Useless(file, "has other tables than this version makes");
    }
    return IndexFile(file, std::move(connection));
  });
}

absl::StatusOr<IndexFile> IndexFile::Create(const fs::path& file) {
  return Guarded(file, [&]() -> absl::StatusOr<IndexFile> {
    auto connection =
        std::make_unique<Connection>(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    SQLite::Database& database = connection->database;
    const std::string mode = database.execAndGet("PRAGMA journal_mode=WAL").getString();
    if (mode != "wal") {
      return absl::UnimplementedError(Complaint(
          file.string(), "cannot be kept in WAL mode: its file system has no shared memory",
          "keep the state folder on a local disk"));
    }
    database.exec(kSchema);
    database.exec(absl::StrCat("PRAGMA user_version=", kSchemaVersion));
    return IndexFile(file, std::move(connection));
  });
}

absl::StatusOr<std::map<std::string, std::string>> IndexFile::Stamps() const {
  return Guarded(file_, [&]() -> absl::StatusOr<std::map<std::string, std::string>> {
    std::map<std::string, std::string> stamps;
    SQLite::Statement rows(connection_->database,
                           absl::StrCat("SELECT ", kColumns, " FROM recordings"));
    while (rows.executeStep()) {
      EYEBOX_RETURN_IF_ERROR(CheckRow(file_, rows));
      const std::string name = rows.getColumn(kNameColumn).getString();
      // The table is a tree by name: a row out of its order would not be found.
      if (!stamps.empty() && name <= stamps.rbegin()->first) {
        return Useless(file_, "holds rows out of their order");
      }
      stamps.emplace_hint(stamps.end(), name, rows.getColumn(kStampColumn).getString());
    }
    return stamps;
  });
}

absl::Status IndexFile::Apply(const IndexChanges& changes) {
  return Guarded(file_, [&]() -> absl::Status {
    SQLite::Transaction transaction(connection_->database, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement remove(connection_->database, "DELETE FROM recordings WHERE name = ?1");
    for (const std::string& name : changes.removed) {
      remove.bind(1, name);
      remove.exec();
      remove.reset();
    }
    // Bound values come back as they will be read, for the checksum.
    SQLite::Statement echo(connection_->database,
                           "SELECT ?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14");
    SQLite::Statement put(connection_->database,
                          absl::StrCat("INSERT OR REPLACE INTO recordings (", kColumns,
                                       ") VALUES (?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14,"
                                       "?15)"));
    for (const IndexRow& row : changes.put) {
      for (SQLite::Statement* statement : {&echo, &put}) {
        statement->reset();
        statement->clearBindings();
        BindRow(row, *statement);
      }
      echo.executeStep();
      put.bind(kChecksumColumn + 1, ChecksumOf(echo));
      put.exec();
    }
    transaction.commit();
    return absl::OkStatus();
  });
}

absl::StatusOr<std::vector<v1::RecordingEntry>> IndexFile::Select(
    const CatalogueQuery& query) const {
  return Guarded(file_, [&]() -> absl::StatusOr<std::vector<v1::RecordingEntry>> {
    const BoundSql sql = SqlOf(query);
    SQLite::Statement rows(
        connection_->database,
        absl::StrCat("SELECT ", kColumns, " FROM recordings", sql.where_and_order));
    for (size_t i = 0; i < sql.values.size(); ++i) {
      std::visit([&](const auto& value) { rows.bind(static_cast<int>(i) + 1, value); },
                 sql.values[i]);
    }
    std::vector<v1::RecordingEntry> entries;
    while (rows.executeStep()) {
      EYEBOX_RETURN_IF_ERROR(CheckRow(file_, rows));
      const SQLite::Column bytes = rows.getColumn(kEntryColumn);
      v1::RecordingEntry entry;
      if (!entry.ParseFromArray(bytes.getBlob(), bytes.getBytes())) {
        return Useless(file_, "holds a recording that is no message");
      }
      entries.push_back(std::move(entry));
    }
    return entries;
  });
}

}  // namespace eyebox::service
