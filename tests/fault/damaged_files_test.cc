// Recordings and images that somebody damaged on purpose: HDF5 through the server, TIFF and PNG
// through the import. A job may fail and a worker may die of it; the server stays.
//
// EYEBOX_DAMAGED_FILES=500 tries as many of each kind instead of a few.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "capture/base/file.h"
#include "capture/base/unix_file.h"
#include "capture/recording/manifest.h"
#include "tests/fault/recorder_run.h"
#include "tests/fault/served_eyebox.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

int FileCount(int few) {
  const char* asked = std::getenv("EYEBOX_DAMAGED_FILES");
  return asked ? std::atoi(asked) : few;
}

// A recording whose capture 1 holds `bytes`, and whose manifest says that this is right: only then
// do they come before libhdf5.
void MakeRecording(const fs::path& fixture, const fs::path& recording, const std::string& bytes) {
  fs::create_directories(recording / "captures");
  for (const auto& entry : fs::directory_iterator(fixture / "captures")) {
    fs::create_hard_link(entry.path(), recording / "captures" / entry.path().filename());
  }
  const fs::path damaged = recording / "captures/000001.h5";
  fs::remove(damaged);
  ASSERT_TRUE(WriteFileAtomically(damaged, bytes).ok());
  const std::string header = *ReadWholeFile(fixture / "recording.textproto");
  ASSERT_TRUE(WriteFileAtomically(recording / "recording.textproto", header).ok());
  auto manifest = capture::ReadManifest(fixture / "manifest.log");
  ASSERT_TRUE(manifest.ok());
  auto log = capture::ManifestLog::Create(recording / "manifest.log", header);
  ASSERT_TRUE(log.ok()) << log.status();
  for (capture::ManifestEntry& entry : manifest->entries) {
    if (entry.number == 1) {
      entry.file_bytes = bytes.size();
      const auto digest = capture::DigestOf(*UnixFile::OpenToRead(damaged), entry);
      if (digest.ok()) entry.digest_xxh3 = *digest;
    }
    ASSERT_TRUE(log->Append(entry).ok());
  }
}

v1::Job RunToItsEnd(v1::RunService::Stub& stub, const std::string& recording) {
  v1::CreateRunRequest create;
  create.set_request_id(recording);
  create.set_recording(recording);
  grpc::ClientContext creating;
  v1::Job job;
  grpc::Status status = stub.CreateRun(&creating, create, &job);
  EXPECT_TRUE(status.ok()) << status.error_message();
  v1::WaitJobRequest wait;
  wait.set_name(job.name());
  wait.set_timeout_s(120);
  grpc::ClientContext waiting;
  status = stub.WaitJob(&waiting, wait, &job);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return job;
}

TEST(DamagedFiles, NoRecordingTakesTheServerDown) {
  const TemporaryFolder folder;
  const fs::path fixture = fs::path(EYEBOX_SOURCE_DIR) / "fixtures/rift-s-like-seed1";
  const fs::path local = folder / "fixture";  // hard links cannot leave a file system
  fs::copy(fixture, local, fs::copy_options::recursive);
  fs::create_directories(folder / "data");
  const std::string whole = *ReadWholeFile(local / "captures/000001.h5");
  ServedEyebox server(folder.path(), {});
  std::mt19937_64 random(7);
  std::map<std::string, int> ends;
  const int count = FileCount(6);
  for (int i = 0; i < count; ++i) {
    // The beginning holds what libhdf5 parses; most of the rest are pixels.
    const size_t head = i % 4 == 3 ? whole.size() : std::min<size_t>(whole.size(), 4096);
    const std::string part = whole.substr(0, head);
    const std::string bytes = fuzz::Mutated(part, {&part, 1}, random) + whole.substr(head);
    const std::string name = "rec-" + std::to_string(i);
    MakeRecording(local, folder.path() / "data" / name, bytes);
    const v1::Job job = RunToItsEnd(server.stub(), name);
    const bool ended =
        job.state() == v1::JOB_STATE_SUCCEEDED || job.state() == v1::JOB_STATE_FAILED;
    EXPECT_TRUE(ended) << job.DebugString();
    const bool died = job.error_message().find("ended by signal") != std::string::npos;
    ++ends[died ? "worker died" : v1::JobState_Name(job.state())];
    ASSERT_TRUE(server.Alive());
    fs::remove_all(folder.path() / "data" / name);
  }
  for (const auto& [end, number] : ends) RecordProperty(end, number);
  for (const auto& [end, number] : ends) std::printf("%s: %d\n", end.c_str(), number);
  EXPECT_EQ(server.Stop(), 0);
}

// `name` as the only frame of an import by the binary: it may refuse, and must not die.
void TryImport(const fs::path& folder, const std::string& name, const std::string& bytes,
               std::map<int, int>& exits) {
  ASSERT_TRUE(WriteFileAtomically(folder / "frames" / name, bytes).ok());
  ASSERT_TRUE(WriteFileAtomically(
                  folder / "frames/index.csv",
                  "file,kind,exposure_s,gain_db,series,repeat\n" + name + ",light,0.1,0,s,1\n")
                  .ok());
  fs::remove_all(folder / "rec");
  const auto run =
      capture::RunShell(EYEBOX_BINARY_DIR "/bin/eyebox import " + (folder / "frames").string() +
                        " --out " + (folder / "rec").string());
  ++exits[run.exit_code];
  EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 3) << run.exit_code << " " << run.text;
  EXPECT_EQ(fs::exists(folder / "rec"), run.exit_code == 0) << run.text;
}

TEST(DamagedFiles, NoImageTakesTheImportDown) {
  const TemporaryFolder folder;
  const fs::path corpus = fs::path(EYEBOX_SOURCE_DIR) / "tests/fuzz/corpus/strip";
  std::mt19937_64 random(7);
  const int count = FileCount(4);
  for (const std::string kind : {"tiff", "grey"}) {
    const std::vector<std::string> seeds = {*ReadWholeFile(corpus / (kind + "-8")),
                                            *ReadWholeFile(corpus / (kind + "-16"))};
    std::map<int, int> exits;
    for (int i = 0; i < count; ++i) {
      const std::string bytes = fuzz::Mutated(seeds[static_cast<size_t>(i) % 2], seeds, random);
      TryImport(folder.path(), kind == "tiff" ? "a.tif" : "a.png", bytes, exits);
    }
    for (const auto& [code, number] : exits) {
      std::printf("%s, exit %d: %d\n", kind.c_str(), code, number);
    }
  }
}

}  // namespace
}  // namespace eyebox::service
