// kill -9 between two frames of a capture: it is taken again, and nothing else is lost or changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/file.h"
#include "capture/recording/reader.h"
#include "tests/fault/persistent_client.h"
#include "tests/fault/recorder_run.h"
#include "tests/fault/served_eyebox.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr int kCutCapture = 4;
constexpr int kTaken = 6;
constexpr int kFrameBytes = 160 * 120 * 2;

// What a session of six captures of two frames left.
struct Session {
  std::vector<std::vector<uint16_t>> whole;  // pixels of every frame of its whole captures
  std::vector<int> cut_short;                // numbers of the others in the recording
  std::vector<int> frames_cut_short;         // frames that these kept
  std::vector<double> means_dn;              // as acknowledged
};

class KillCapture : public testing::Test {
 protected:
  void SetUp() override {
    if (capture::RunShell("strace -D -o /dev/null true").exit_code != 0) {
      GTEST_SKIP() << "strace is not installed or may not trace here; scripts/bootstrap.sh check";
    }
  }

  fs::path Folder(const std::string& name) const { return folder_ / name; }
  fs::path Partial(const std::string& name) const {
    return Folder(name) / "data/.partial-session/captures/000004.h5.partial";
  }

  void Start(const std::string& name, const std::vector<std::string>& launcher) {
    fs::create_directories(Folder(name) / "data");
    std::ofstream(Folder(name) / "data/left.textproto")
        << "name: \"left\" camera_uri: \"sim:rift-s-like\" seed: 5\n";
    server_ = std::make_unique<ServedEyebox>(Folder(name), launcher);
  }

  // strace of the writes to the capture that is to be cut, which does `inject` to them.
  std::vector<std::string> Trace(const std::string& name, const std::string& inject) const {
    std::vector<std::string> launcher = {"strace", "-D",
                                         "-f",     "-qq",
                                         "-o",     (Folder(name) / "trace").string(),
                                         "-P",     Partial(name).string(),
                                         "-e",     "trace=pwrite64"};
    if (!inject.empty()) {
      launcher.emplace_back("-e");
      launcher.push_back("inject=pwrite64:" + inject);
    }
    return launcher;
  }

  // The writes of its two frames among all writes to the capture, counted from 1. strace writes a
  // little later than the process ends.
  std::vector<int> FrameWrites(const std::string& name) const {
    std::vector<int> frames;
    for (int i = 0; i < 600 && frames.size() < 2; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      frames = TracedFrameWrites(name);
    }
    return frames;
  }

  std::vector<int> TracedFrameWrites(const std::string& name) const {
    std::istringstream lines(*ReadWholeFile(Folder(name) / "trace"));
    std::vector<int> frames;
    int write = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.find("pwrite64(") == std::string::npos) continue;
      ++write;
      if (line.find(", " + std::to_string(kFrameBytes) + ", ") != std::string::npos) {
        frames.push_back(write);
      }
    }
    return frames;
  }

  // Captures until the server dies of it, starts it again, and goes on.
  Session Run(const std::string& name, bool is_cut) {
    PersistentClient client(server_->Connect());
    const v1::CapturePlan plan = client.Plan();
    const std::string job = client.CreateSession("session", plan);
    Session session;
    for (int i = 1; i <= kTaken; ++i) {
      if (is_cut && i == kCutCapture) {
        grpc::ClientContext context;
        v1::CaptureReply reply;
        const grpc::Status status = client.Capture(&context, job, i, plan.captures(i - 1), &reply);
        EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE) << "it should have died";
        EXPECT_EQ(server_->Kill(), 128 + SIGKILL);
        EXPECT_TRUE(fs::exists(Partial(name)));
        Start(name, {});
      }
      session.means_dn.push_back(client.Capture(job, i, plan.captures(i - 1)).mean_dn());
    }
    client.Finish(job);
    EXPECT_EQ(client.Wait(job).attempts(), is_cut ? 2 : 1);
    EXPECT_EQ(server_->Stop(), 0);
    Read(Folder(name) / "data/session", session);
    return session;
  }

  static void Read(const fs::path& recording, Session& session) {
    const auto verified = capture::VerifyRecording(recording);
    EXPECT_TRUE(verified.ok()) << verified.status();
    const auto reader = capture::RecordingReader::Open(recording);
    ASSERT_TRUE(reader.ok()) << reader.status();
    for (const capture::CaptureEntry& entry : (*reader)->Captures()) {
      if (entry.frame_count < entry.spec.repeats) {
        session.cut_short.push_back(entry.number);
        session.frames_cut_short.push_back(entry.frame_count);
        continue;
      }
      const absl::Status read = (*reader)->VisitFrames(entry, [&](const Frame& frame) {
        session.whole.emplace_back(frame.view.pixels_dn.begin(), frame.view.pixels_dn.end());
        return absl::OkStatus();
      });
      EXPECT_TRUE(read.ok()) << read;
    }
  }

  const TemporaryFolder folder_;
  std::unique_ptr<ServedEyebox> server_;
};

TEST_F(KillCapture, CutShortIsTakenAgainAndTheRestIsUntouched) {
  Start("whole", Trace("whole", ""));
  const Session whole = Run("whole", false);
  EXPECT_EQ(whole.whole.size(), 2u * kTaken);
  EXPECT_THAT(whole.cut_short, IsEmpty());
  const std::vector<int> frames = FrameWrites("whole");
  ASSERT_EQ(frames.size(), 2u);
  struct Moment {
    std::string name;
    int write;        // that the kill comes in place of
    int frames_kept;  // which recovery finds whole
  };
  // The record of a frame follows its pixels, and something else the last record.
  for (const Moment& moment :
       {Moment{"before-frame-1", frames[0], 0}, Moment{"before-record-1", frames[0] + 1, 0},
        Moment{"before-frame-2", frames[1], 1}, Moment{"before-record-2", frames[1] + 1, 1},
        Moment{"before-the-end", frames[1] + 2, 2}}) {
    SCOPED_TRACE(moment.name);
    Start(moment.name, Trace(moment.name, "signal=KILL:when=" + std::to_string(moment.write)));
    const Session cut = Run(moment.name, true);
    EXPECT_TRUE(cut.whole == whole.whole) << "frames differ";
    EXPECT_EQ(cut.means_dn, whole.means_dn);
    if (moment.frames_kept != 1) {
      EXPECT_THAT(cut.cut_short, IsEmpty());
    } else {
      EXPECT_THAT(cut.cut_short, ElementsAre(kCutCapture));
      EXPECT_THAT(cut.frames_cut_short, ElementsAre(moment.frames_kept));
    }
  }
}

}  // namespace
}  // namespace eyebox::service
