// fault_recorder FOLDER CAPTURES FRAMES SIDE_PX: records and says on stdout, after each group, how
// many frames of which capture are acknowledged ("ack 2 4"). After an error it goes on like a
// careless caller, who must be refused; exit status 3, the error on stderr.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "capture/base/status.h"
#include "capture/recording/writer.h"
#include "tests/fault/fault_frame.h"

namespace eyebox::capture {
namespace {

constexpr int kFramesPerGroup = 2;
constexpr int kRefused = 3;
constexpr int kWasNotRefused = 9;

// One write(): what the reader of the pipe sees was said before the next system call.
void Say(const std::string& line) {
  if (::write(STDOUT_FILENO, line.data(), line.size()) < 0) std::_Exit(1);
}

struct Options {
  std::string folder;
  int captures = 0;
  int frames = 0;
  int side_px = 0;
};

absl::Status Fill(CaptureWriter& capture, int number, const Options& options) {
  const ClockTriple triple = {
      .monotonic_ns = number, .real_ns = 2, .device_ns = std::nullopt, .window_ns = 3};
  EYEBOX_RETURN_IF_ERROR(capture.AppendClockTriple(triple));
  for (int i = 0; i < options.frames; ++i) {
    const uint64_t id = kIdsPerCapture * static_cast<uint64_t>(number) + static_cast<uint64_t>(i);
    EYEBOX_RETURN_IF_ERROR(capture.Append(FaultFrame(id, {options.side_px, options.side_px})));
    EYEBOX_RETURN_IF_ERROR(capture.AppendSamples(FaultSamples(i)));
    if ((i + 1) % kFramesPerGroup != 0 && i + 1 != options.frames) continue;
    EYEBOX_RETURN_IF_ERROR(capture.Acknowledge());
    Say("ack " + std::to_string(number) + " " + std::to_string(i + 1) + "\n");
  }
  EYEBOX_RETURN_IF_ERROR(capture.AppendClockTriple(triple));
  return capture.Publish();
}

bool TakesMore(CaptureWriter& capture, const Options& options) {
  return capture.Append(FaultFrame(0, {options.side_px, options.side_px})).ok() ||
         capture.AppendSamples(FaultSamples(0)).ok() || capture.Acknowledge().ok() ||
         capture.Publish().ok() || capture.PublishEarly().ok();
}

absl::Status Record(const Options& options) {
  RecordingHeader header;
  header.rig = {.name = "fault", .camera_uri = "sim:fault"};
  header.camera.sensor_size = {options.side_px, options.side_px};
  header.camera.significant_bits = 16;
  EYEBOX_ASSIGN_OR_RETURN(const auto writer,
                          RecordingWriter::Create(options.folder, header, SystemClock()));
  CaptureSpec spec;
  spec.exposure_s = 0.01;
  spec.repeats = options.frames;
  const SideRoom room = {.samples = static_cast<int64_t>(kSamplesPerFrame) * options.frames,
                         .clock_triples = 2};
  for (int number = 1; number <= options.captures; ++number) {
    EYEBOX_ASSIGN_OR_RETURN(const auto capture,
                            writer->BeginCapture(spec, header.camera.sensor_size, room));
    const absl::Status filled = Fill(*capture, number, options);
    if (filled.ok()) continue;
    if (TakesMore(*capture, options)) std::_Exit(kWasNotRefused);
    return filled;
  }
  return absl::OkStatus();
}

int Main(int argc, char** argv) {
  if (argc != 5) return 2;
  const Options options = {argv[1], std::atoi(argv[2]), std::atoi(argv[3]), std::atoi(argv[4])};
  Say("begin\n");
  const absl::Status status = Record(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s\n", std::string(status.message()).c_str());
  return kRefused;
}

}  // namespace
}  // namespace eyebox::capture

int main(int argc, char** argv) { return eyebox::capture::Main(argc, argv); }
