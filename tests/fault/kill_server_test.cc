// kill -9 of the server at any moment: a run on a rig starts again by itself and gives the bytes of
// a run that nothing disturbed, and every capture that a session acknowledged is still there.
//
// EYEBOX_KILLS=100 kills so often instead of a few times.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/file.h"
#include "capture/recording/reader.h"
#include "tests/fault/persistent_client.h"
#include "tests/fault/served_eyebox.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

// A job that is started for the fourth time is given up: it might be what kills the server.
constexpr int kKillsOfAJob = 2;

int KillCount() {
  const char* asked = std::getenv("EYEBOX_KILLS");
  return asked ? std::atoi(asked) : 4;
}

// Of a job that has ended: by name, the bytes of its artifacts.
using Files = std::map<std::string, std::string>;
// Of a recording: the pixels of every frame of its whole captures. One that a kill cut short stays
// beside the one that was taken in its place.
using Pixels = std::vector<std::vector<uint16_t>>;

class KillServer : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "data");
    std::ofstream(folder_ / "data/left.textproto")
        << "name: \"left\" camera_uri: \"sim:rift-s-like\" seed: 5\n";
    Start();
  }

  void Start() {
    server_ = std::make_unique<ServedEyebox>(folder_.path(), std::vector<std::string>{});
  }

  Files FilesOf(const v1::Job& job) {
    Files files;
    for (const v1::Artifact& artifact : job.artifacts()) {
      const auto bytes =
          ReadWholeFile(folder_.path() / "state" / job.name() / "result" / artifact.name());
      EXPECT_TRUE(bytes.ok()) << bytes.status();
      files[artifact.name()] = bytes.ok() ? *bytes : "";
    }
    EXPECT_FALSE(files.empty());
    return files;
  }

  Pixels PixelsOf(const std::string& recording) {
    Pixels pixels;
    const auto reader = capture::RecordingReader::Open(folder_ / ("data/" + recording));
    EXPECT_TRUE(reader.ok()) << reader.status();
    if (!reader.ok()) return pixels;
    for (const capture::CaptureEntry& entry : (*reader)->Captures()) {
      if (entry.frame_count < entry.spec.repeats) {
        ++cut_short_;
        continue;
      }
      const absl::Status read = (*reader)->VisitFrames(entry, [&](const Frame& frame) {
        pixels.emplace_back(frame.view.pixels_dn.begin(), frame.view.pixels_dn.end());
        return absl::OkStatus();
      });
      EXPECT_TRUE(read.ok()) << read;
    }
    return pixels;
  }

  // A run and a session beside it until both have ended, killed `kills` times meanwhile. Repeats
  // what was acknowledged: an answer that has changed would be a capture that was lost.
  void Round(const std::string& id, int kills) {
    PersistentClient client(server_->Connect());
    const v1::CapturePlan plan = client.Plan();
    const std::string run = client.CreateRun("run-" + id);
    const std::string session = client.CreateSession("session-" + id, plan);
    std::vector<v1::CaptureReply> replies;
    std::thread script([&] {
      for (int i = 0; i < plan.captures_size(); ++i) {
        replies.push_back(client.Capture(session, i + 1, plan.captures(i)));
        ++acknowledged_;
      }
      for (int i = 0; i < plan.captures_size(); ++i) {
        const v1::CaptureReply again = client.Capture(session, i + 1, plan.captures(i));
        EXPECT_EQ(again.mean_dn(), replies[i].mean_dn()) << "capture " << i + 1;
        EXPECT_EQ(again.sigma_dn(), replies[i].sigma_dn()) << "capture " << i + 1;
      }
    });
    for (int i = 0; i < kills; ++i) KillAtRandom();
    script.join();
    client.Finish(session);
    const v1::Job run_job = client.Wait(run);
    const v1::Job session_job = client.Wait(session);
    run_kills_ += run_job.attempts() - 1;
    session_kills_ += session_job.attempts() - 1;
    files_ = FilesOf(run_job);
    pixels_ = PixelsOf("session-" + id);
    means_.clear();
    for (const v1::CaptureReply& reply : replies) means_.push_back(reply.mean_dn());
  }

  void KillAtRandom() {
    std::uniform_real_distribution<double> moment_s(0, round_s_);
    std::this_thread::sleep_for(std::chrono::duration<double>(moment_s(random_)));
    EXPECT_EQ(server_->Kill(), 128 + SIGKILL) << "it had ended by itself";
    Start();
  }

  const TemporaryFolder folder_;
  std::unique_ptr<ServedEyebox> server_;
  std::mt19937 random_{11};
  double round_s_ = 0;
  // Of the last round.
  Files files_;
  Pixels pixels_;
  std::vector<double> means_;
  // Of all rounds.
  std::atomic<int> acknowledged_ = 0;
  int run_kills_ = 0;
  int session_kills_ = 0;
  int cut_short_ = 0;
};

TEST_F(KillServer, AtAnyMomentLosesNoCaptureAndChangesNoByteOfAResult) {
  const auto begin = steady_clock::now();
  Round("whole", 0);
  round_s_ = std::chrono::duration<double>(steady_clock::now() - begin).count();
  const Files files = files_;
  const Pixels pixels = pixels_;
  const std::vector<double> means = means_;
  ASSERT_GE(pixels.size(), 50u);
  const int kills = KillCount();
  for (int done = 0; done < kills && !HasFailure(); done += kKillsOfAJob) {
    Round(std::to_string(done), std::min(kKillsOfAJob, kills - done));
    EXPECT_EQ(means_, means);
    EXPECT_TRUE(pixels_ == pixels) << "frames differ";
    ASSERT_EQ(files_.size(), files.size());
    for (const auto& [name, bytes] : files) EXPECT_TRUE(files_[name] == bytes) << name;
  }
  std::printf(
      "%d kills, %d while the run and %d while the session was under way; %d captures "
      "acknowledged, %d cut short and taken again; a round takes %.2f s undisturbed\n",
      kills, run_kills_, session_kills_, acknowledged_.load(), cut_short_, round_s_);
  EXPECT_EQ(server_->Stop(), 0);
}

}  // namespace
}  // namespace eyebox::service
