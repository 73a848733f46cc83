// A rig file, and recording.textproto, which holds the plan. What is accepted is written as it was
// read.
#include "capture/recording/header_file.h"
#include "capture/recording/rig_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eyebox::capture;
  const std::string text(eyebox::fuzz::AsText(data, size));
  const auto rig = ReadRigFile(eyebox::fuzz::MemoryFile(text));
  if (rig.ok()) FUZZ_CHECK(!rig->name.empty() && !rig->camera_uri.empty());
  const auto header = ParseHeader(text, "recording.textproto");
  if (!header.ok()) return 0;
  const auto written = HeaderText(*header);
  FUZZ_CHECK(written.ok());
  const auto again = ParseHeader(*written, "recording.textproto");
  FUZZ_CHECK(again.ok());
  FUZZ_CHECK(*HeaderText(*again) == *written);
  return 0;
}
