// Recording against plain pwrite + fdatasync of the same bytes into files as large, synced as
// often, with their space reserved likewise. Both in one run, in turn, best of each. What recording
// does besides: checksums, records, HDF5's own bytes, the manifest, renaming. Needs 1 GB in
// $TMPDIR.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "capture/base/status.h"
#include "capture/base/unix_file.h"
#include "capture/recording/rolling.h"
#include "capture/recording/writer.h"

namespace eyebox::capture {
namespace {

constexpr int kCaptures = 2;
constexpr int kRounds = 5;

struct Shape {
  ImageSize frame_size;
  int frames_per_capture = 0;
  int frames_per_sync = 0;
};

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

// Counts of 12 bits that do not compress.
std::vector<uint16_t> NoisyCounts(ImageSize size) {
  std::mt19937 random(1);
  std::vector<uint16_t> counts_dn(size.PixelCount());
  for (uint16_t& count_dn : counts_dn) count_dn = static_cast<uint16_t>(random() & 0xfff);
  return counts_dn;
}

absl::Status RecordFrames(const std::filesystem::path& folder, const Frame& frame,
                          const Shape& shape) {
  RecordingHeader header;
  header.rig = {.name = "bench", .camera_uri = "sim:bench"};
  header.camera.sensor_size = frame.view.size;
  header.camera.significant_bits = 12;
  CaptureSpec spec;
  spec.exposure_s = 0.01;
  spec.repeats = shape.frames_per_capture;
  EYEBOX_ASSIGN_OR_RETURN(const auto writer,
                          RecordingWriter::Create(folder, header, SystemClock()));
  RollingCapture rolling(*writer, {.spec = spec,
                                   .frame_size = frame.view.size,
                                   .frames_per_acknowledgement = shape.frames_per_sync});
  for (int i = 0; i < kCaptures * shape.frames_per_capture; ++i) {
    EYEBOX_RETURN_IF_ERROR(rolling.Append(frame));
  }
  return rolling.Finish();
}

bool WritePlainFile(const std::filesystem::path& file, const Frame& frame, const Shape& shape) {
  const size_t size = frame.view.pixels_dn.size_bytes();
  const int fd = open(file.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  bool ok =
      fd >= 0 && posix_fallocate(fd, 0, static_cast<off_t>(shape.frames_per_capture * size)) == 0;
  for (int i = 0; ok && i < shape.frames_per_capture; ++i) {
    ok = pwrite(fd, frame.view.pixels_dn.data(), size, static_cast<off_t>(i * size)) ==
         static_cast<ssize_t>(size);
    if (ok && (i + 1) % shape.frames_per_sync == 0) ok = fdatasync(fd) == 0;
  }
  close(fd);
  return ok;
}

absl::Status WritePlain(const std::filesystem::path& folder, const Frame& frame,
                        const Shape& shape) {
  for (int i = 0; i < kCaptures; ++i) {
    if (!WritePlainFile(folder / (std::to_string(i) + ".raw"), frame, shape)) {
      return SystemFailed(folder.string(), errno, "check the disk");
    }
  }
  return absl::OkStatus();
}

// Seconds of `write` into a fresh folder.
template <typename Write>
absl::StatusOr<double> Time(const Write& write, const Frame& frame, const Shape& shape) {
  const TemporaryFolder folder;
  EYEBOX_RETURN_IF_ERROR(CreateFolders(folder.path() / "written"));
  ::sync();  // nobody else's pages are waited for
  const auto start = std::chrono::steady_clock::now();
  EYEBOX_RETURN_IF_ERROR(write(folder.path() / "written", frame, shape));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Recording(benchmark::State& state) {
  const Shape shape = {
      .frame_size = {static_cast<int>(state.range(0)), static_cast<int>(state.range(1))},
      .frames_per_capture = static_cast<int>(state.range(2)),
      .frames_per_sync = static_cast<int>(state.range(3))};
  const std::vector<uint16_t> counts_dn = NoisyCounts(shape.frame_size);
  Frame frame;
  frame.view = {.pixels_dn = counts_dn, .size = shape.frame_size};
  for (auto _ : state) {
    double recording_s = 1e9;
    double plain_s = 1e9;
    for (int round = 0; round < kRounds; ++round) {
      const auto plain = Time(WritePlain, frame, shape);
      if (!plain.ok()) return state.SkipWithError(plain.status().ToString().c_str());
      const auto recorded = Time(RecordFrames, frame, shape);
      if (!recorded.ok()) return state.SkipWithError(recorded.status().ToString().c_str());
      plain_s = std::min(plain_s, *plain);
      recording_s = std::min(recording_s, *recorded);
    }
    const double megabytes = kCaptures * shape.frames_per_capture *
                             static_cast<double>(frame.view.pixels_dn.size_bytes()) / 1e6;
    state.SetIterationTime(recording_s);
    state.counters["MB_s"] = megabytes / recording_s;
    state.counters["plain_MB_s"] = megabytes / plain_s;
    state.counters["of_plain"] = plain_s / recording_s;
  }
}

// A fast small camera, one of 1.2 megapixels, and a slow one of 12: 0.5, 0.6 and 0.8 GB.
BENCHMARK(Recording)
    ->ArgNames({"width_px", "height_px", "frames_per_capture", "frames_per_sync"})
    ->Args({512, 512, 512, 64})
    ->Args({1280, 960, 128, 32})
    ->Args({4096, 3000, 16, 4})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace eyebox::capture
