// index.csv of frames to import. Beside it lie a.tif and b.png, which it may name.
#include <cmath>
#include <fstream>

#include "capture/recording/import_index.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

const std::filesystem::path& Folder() {
  static const std::filesystem::path folder = [] {
    std::filesystem::path made = eyebox::fuzz::ScratchFolder() / "frames";
    std::filesystem::create_directory(made);
    for (const char* name : {"a.tif", "b.png"}) std::ofstream(made / name) << "x";
    return made;
  }();
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::ofstream(Folder() / "index.csv", std::ios::binary) << eyebox::fuzz::AsText(data, size);
  const auto frames = eyebox::capture::ReadImportIndex(Folder());
  if (!frames.ok()) return 0;
  FUZZ_CHECK(!frames->empty());
  for (const auto& frame : *frames) {
    FUZZ_CHECK(std::isfinite(frame.spec.exposure_s) && frame.spec.exposure_s > 0);
    FUZZ_CHECK(std::filesystem::is_regular_file(frame.file));
  }
  return 0;
}
