// Camera to disk: Aravis' in-process fake camera, 512 x 512 Mono16, software-triggered, into
// captures of 512 frames, each frame read back, its checksum and its picture compared. Beside it
// what plain pwrite + fdatasync of the same bytes reaches before and after, the better of both.
// Needs 9 GB of free space in the temporary folder ($TMPDIR).
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/status.h"
#include "capture/camera/aravis/aravis_rig.h"
#include "capture/camera/aravis/fake_scene.h"
#include "capture/recording/reader.h"
#include "capture/recording/writer.h"
#include "capture/run.h"

namespace eyebox::capture {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr ImageSize kFrameSize = {.width_px = 512, .height_px = 512};
constexpr size_t kFrameBytes = 512 * 512 * 2;
constexpr int kFramesPerCapture = 512;
constexpr int kFramesPerSync = 64;
constexpr int kTriggersAhead = 8;
constexpr double kExposureS = 0.001;
constexpr const char* kCamera = "aravis:fake?region=512x512+0+0&fake_rate_hz=4000&buffers=1024";

double SecondsSince(SteadyClock::time_point start) {
  return Seconds(SteadyClock::now() - start).count();
}

// Frames on their way from the camera to the disk.
class FrameQueue {
 public:
  void Push(std::optional<Frame> frame) {  // nothing: the last one was there
    const std::lock_guard lock(mutex_);
    frames_.push_back(std::move(frame));
    deepest_ = std::max(deepest_, frames_.size());
    filled_.notify_one();
  }
  std::optional<Frame> Pop() {
    std::unique_lock lock(mutex_);
    filled_.wait(lock, [this] { return !frames_.empty(); });
    std::optional<Frame> frame = std::move(frames_.front());
    frames_.pop_front();
    return frame;
  }
  size_t deepest() const { return deepest_; }

 private:
  std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<std::optional<Frame>> frames_;
  size_t deepest_ = 0;
};

// Rolling captures until the queue ends. The last one announces what is left of `frames`.
absl::Status Record(FrameQueue& queue, RecordingWriter& writer, int frames) {
  CaptureSpec spec;
  spec.series = "rolling";
  spec.exposure_s = kExposureS;
  for (int written = 0; written < frames; written += spec.repeats) {
    spec.repeats = std::min(kFramesPerCapture, frames - written);
    EYEBOX_ASSIGN_OR_RETURN(auto capture, writer.BeginCapture(spec, kFrameSize));
    for (int i = 0; i < spec.repeats; ++i) {
      const std::optional<Frame> frame = queue.Pop();
      if (!frame) return absl::AbortedError("the camera ended early");
      EYEBOX_RETURN_IF_ERROR(capture->Append(*frame));
      if ((i + 1) % kFramesPerSync == 0 || i + 1 == spec.repeats) {
        EYEBOX_RETURN_IF_ERROR(capture->Acknowledge());
      }
    }
    EYEBOX_RETURN_IF_ERROR(capture->Publish());
  }
  return absl::OkStatus();
}

struct Tally {
  int lost = 0;
  int waited_for_disk = 0;  // triggers that found all buffers waiting for the disk
};

// A trigger that finds no buffer comes later: it slows the run down and loses nothing.
absl::Status TriggerWhenFree(Camera& camera, Tally& tally) {
  absl::Status triggered = camera.Trigger();
  while (absl::IsFailedPrecondition(triggered)) {
    ++tally.waited_for_disk;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    triggered = camera.Trigger();
  }
  return triggered;
}

absl::Status TakeFrame(Camera& camera, FrameQueue& queue, std::optional<uint64_t>& previous_id,
                       Tally& tally) {
  EYEBOX_ASSIGN_OR_RETURN(Frame frame, camera.NextFrame(std::chrono::seconds(5)));
  if (frame.metadata.status != BufferStatus::kComplete) {
    return absl::DataLossError("a frame arrived incomplete");
  }
  const uint64_t id = frame.metadata.camera_frame_id;
  if (previous_id) tally.lost += static_cast<int>(id - *previous_id - 1);
  previous_id = id;
  queue.Push(std::move(frame));
  return absl::OkStatus();
}

// Triggers by the clock, a few of them ahead of their frames, as a camera allows that exposes while
// it reads out.
absl::StatusOr<Tally> Film(Camera& camera, double rate_hz, int frames, FrameQueue& queue) {
  Tally tally;
  std::optional<uint64_t> previous_id;
  const auto start = SteadyClock::now();
  const auto due = [&](int i) {
    return start + std::chrono::duration_cast<SteadyClock::duration>(Seconds(i / rate_hz));
  };
  for (int triggered = 0, taken = 0; taken < frames; ++taken) {
    if (triggered == taken) std::this_thread::sleep_until(due(triggered));
    while (triggered < frames && triggered < taken + kTriggersAhead &&
           due(triggered) <= SteadyClock::now()) {
      EYEBOX_RETURN_IF_ERROR(TriggerWhenFree(camera, tally));
      ++triggered;
    }
    EYEBOX_RETURN_IF_ERROR(TakeFrame(camera, queue, previous_id, tally));
  }
  return tally;
}

// Checksums are compared by the reader; the picture tells that no frame stands in for another.
absl::StatusOr<int> Verify(const std::filesystem::path& recording) {
  EYEBOX_ASSIGN_OR_RETURN(auto reader, RecordingReader::Open(recording));
  int verified = 0;
  for (const CaptureEntry& capture : reader->Captures()) {
    EYEBOX_RETURN_IF_ERROR(reader->VisitFrames(capture, [&](const Frame& frame) {
      const uint64_t id = (frame.metadata.camera_frame_id - 1) % 65535 + 1;
      for (int x = 0; x < kFrameSize.width_px; ++x) {
        const int position = static_cast<int>((x + id) % aravis::kFakeRampPixels);
        if (frame.view.pixels_dn[x] != aravis::FakeRampCount(position, kExposureS, 65535)) {
          return absl::DataLossError("a frame shows another picture");
        }
      }
      ++verified;
      return absl::OkStatus();
    }));
  }
  return verified;
}

struct Outcome {
  Tally tally;
  double seconds = 0;
  size_t deepest_queue = 0;
};

absl::StatusOr<Outcome> FilmToDisk(const std::filesystem::path& folder, double rate_hz,
                                   int frames) {
  EYEBOX_ASSIGN_OR_RETURN(Rig rig,
                          OpenAravisRig({.name = "bench", .camera_uri = kCamera}, SystemClock()));
  EYEBOX_ASSIGN_OR_RETURN(
      auto writer,
      RecordingWriter::Create(folder, MakeHeader(rig, {}, *SystemClock()), SystemClock()));
  EYEBOX_RETURN_IF_ERROR(rig.camera->Configure({.exposure_s = kExposureS}).status());
  EYEBOX_RETURN_IF_ERROR(rig.camera->Start());
  FrameQueue queue;
  absl::Status recorded;
  const auto start = SteadyClock::now();
  std::thread recorder([&] { recorded = Record(queue, *writer, frames); });
  const absl::StatusOr<Tally> tally = Film(*rig.camera, rate_hz, frames, queue);
  queue.Push(std::nullopt);
  recorder.join();
  EYEBOX_RETURN_IF_ERROR(recorded);
  if (!tally.ok()) return tally.status();
  return Outcome{*tally, SecondsSince(start), queue.deepest()};
}

// A folder that is gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "eyebox-bench-XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

bool HasSpaceFor(int frames) {
  std::error_code error;
  const auto space = std::filesystem::space(std::filesystem::temp_directory_path(), error);
  const size_t needed = 2 * (frames + frames / 16) * kFrameBytes;  // recording and plain files
  return !error && space.available >= needed;
}

// MB/s of pwrite + fdatasync, files and groups as large as those of the recording.
double PlainMegabytesPerSecond(int frames) {
  const TemporaryFolder folder;
  const std::vector<std::byte> pixels(kFrameBytes, std::byte{0x5A});
  const auto start = SteadyClock::now();
  for (int written = 0; written < frames; written += kFramesPerCapture) {
    const int count = std::min(kFramesPerCapture, frames - written);
    const auto file = folder.path() / (std::to_string(written) + ".raw");
    const int fd = open(file.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
    bool ok = fd >= 0 && posix_fallocate(fd, 0, static_cast<off_t>(count * kFrameBytes)) == 0;
    for (int i = 0; ok && i < count; ++i) {
      ok = pwrite(fd, pixels.data(), kFrameBytes, static_cast<off_t>(i * kFrameBytes)) ==
           static_cast<ssize_t>(kFrameBytes);
      if (ok && ((i + 1) % kFramesPerSync == 0 || i + 1 == count)) ok = fdatasync(fd) == 0;
    }
    close(fd);
    if (!ok) return 0;
  }
  return static_cast<double>(frames) * kFrameBytes / 1e6 / SecondsSince(start);
}

void CameraToDisk(benchmark::State& state) {
  const double rate_hz = static_cast<double>(state.range(0));
  const int frames = static_cast<int>(state.range(0) * state.range(1));
  for (auto _ : state) {
    if (!HasSpaceFor(frames)) {
      return state.SkipWithError("the temporary folder lacks space; set TMPDIR");
    }
    double plain_mb_s = PlainMegabytesPerSecond(frames);
    const TemporaryFolder folder;
    const auto outcome = FilmToDisk(folder.path() / "recording", rate_hz, frames);
    if (!outcome.ok()) return state.SkipWithError(outcome.status().ToString().c_str());
    plain_mb_s = std::max(plain_mb_s, PlainMegabytesPerSecond(frames));
    const auto verified = Verify(folder.path() / "recording");
    if (!verified.ok()) return state.SkipWithError(verified.status().ToString().c_str());
    state.SetIterationTime(outcome->seconds);
    const double mb_s = frames * kFrameBytes / 1e6 / outcome->seconds;
    state.counters["frames_per_s"] = frames / outcome->seconds;
    state.counters["lost"] = outcome->tally.lost;
    state.counters["verified"] = *verified;
    state.counters["waited_for_disk"] = outcome->tally.waited_for_disk;
    state.counters["deepest_queue"] = static_cast<double>(outcome->deepest_queue);
    state.counters["MB_s"] = mb_s;
    state.counters["plain_MB_s"] = plain_mb_s;
    if (outcome->tally.lost != 0 || *verified != frames) state.SkipWithError("frames are missing");
  }
}

// Frames a second, seconds.
BENCHMARK(CameraToDisk)
    ->ArgNames({"rate_hz", "seconds"})
    ->Args({800, 10})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace eyebox::capture
