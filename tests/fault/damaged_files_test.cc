// Recordings and images that somebody damaged on purpose: HDF5 through the server, TIFF and PNG
// through the import. A job may fail and a worker may die of it; the server stays.
//
// EYEBOX_DAMAGED_FILES=500 tries as many of each kind instead of a few.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

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

v1::Job RunToItsEnd(v1::RunService::Stub& stub, const std::string& id,
                    const std::string& recording) {
  v1::CreateRunRequest create;
  create.set_request_id(id);
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

// By name, the bytes of what the job left.
std::map<std::string, std::string> FilesOf(const fs::path& state, const v1::Job& job) {
  std::map<std::string, std::string> files;
  for (const v1::Artifact& artifact : job.artifacts()) {
    files[artifact.name()] = *ReadWholeFile(state / job.name() / "result" / artifact.name());
  }
  return files;
}

// A server, and the packed fixture with other bytes as its first capture.
class DamagedRecordings : public testing::Test {
 protected:
  void SetUp() override {
    fs::copy(fs::path(EYEBOX_SOURCE_DIR) / "fixtures/rift-s-like-seed1", local_,
             fs::copy_options::recursive);
    fs::create_directories(folder_ / "data");
    whole_ = *ReadWholeFile(local_ / "captures/000001.h5");
    server_ = std::make_unique<ServedEyebox>(folder_.path(), std::vector<std::string>{});
    const v1::Job job = Run(whole_);
    ASSERT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED) << job.error_message();
    truth_ = FilesOf(folder_ / "state", job);
    ASSERT_FALSE(truth_.empty());
  }
  void TearDown() override { EXPECT_EQ(server_->Stop(), 0); }

  v1::Job Run(const std::string& bytes) {
    const fs::path recording = folder_ / "data/rec";
    MakeRecording(local_, recording, bytes);
    v1::Job job = RunToItsEnd(server_->stub(), "run-" + std::to_string(++runs_), "rec");
    fs::remove_all(recording);
    return job;
  }
  // One that succeeded gives what the undamaged recording gives: every frame still has to match the
  // checksum in its record.
  void ExpectTruth(const v1::Job& job) {
    EXPECT_TRUE(FilesOf(folder_ / "state", job) == truth_) << job.name();
  }

  const TemporaryFolder folder_;
  const fs::path local_ = folder_ / "fixture";  // hard links cannot leave a file system
  std::string whole_;
  std::unique_ptr<ServedEyebox> server_;
  std::map<std::string, std::string> truth_;
  int runs_ = 0;
};

// Of 500, 65 succeed: in two of them the damage undid itself; in the others it lies in what no
// frame is read by: room that HDF5 left unused, names of the fields of a record, /meta.
TEST_F(DamagedRecordings, NoneTakesTheServerDownOrChangesAResult) {
  std::mt19937_64 random(7);
  std::map<std::string, int> ends;
  const int count = FileCount(6);
  for (int i = 0; i < count; ++i) {
    // The beginning holds what libhdf5 parses; most of the rest are pixels.
    const size_t head = i % 4 == 3 ? whole_.size() : std::min<size_t>(whole_.size(), 4096);
    const std::string part = whole_.substr(0, head);
    const v1::Job job = Run(fuzz::Mutated(part, {&part, 1}, random) + whole_.substr(head));
    const bool succeeded = job.state() == v1::JOB_STATE_SUCCEEDED;
    EXPECT_TRUE(succeeded || job.state() == v1::JOB_STATE_FAILED) << job.DebugString();
    if (succeeded) ExpectTruth(job);
    const bool died = job.error_message().find("ended by signal") != std::string::npos;
    ++ends[died ? "worker died" : v1::JobState_Name(job.state())];
    ASSERT_TRUE(server_->Alive());
  }
  for (const auto& [end, number] : ends) RecordProperty(end, number);
  for (const auto& [end, number] : ends) std::printf("%s: %d\n", end.c_str(), number);
}

TEST_F(DamagedRecordings, MetaMayChangeButNoPixelAndNoRecord) {
  std::string meta = whole_;
  const size_t model = meta.find("simulator");
  ASSERT_NE(model, std::string::npos);
  meta[model] = 'S';
  const v1::Job unaffected = Run(meta);
  EXPECT_EQ(unaffected.state(), v1::JOB_STATE_SUCCEEDED) << unaffected.error_message();
  ExpectTruth(unaffected);

  const auto manifest = capture::ReadManifest(local_ / "manifest.log");
  ASSERT_TRUE(manifest.ok());
  ASSERT_TRUE(manifest->entries[0].packed) << "the fixture should come before libhdf5";
  const size_t record = manifest->entries[0].RecordOffset(1);
  for (const size_t at : {record, record + 88, record + 112, whole_.size() - 100}) {
    std::string bytes = whole_;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    const v1::Job refused = Run(bytes);
    EXPECT_EQ(refused.state(), v1::JOB_STATE_FAILED) << "byte " << at;
    EXPECT_NE(refused.error_message().find("000001.h5"), std::string::npos)
        << refused.error_message();
  }
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
