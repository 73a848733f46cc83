// Images from outside: the strip PNG, and greyscale PNG and TIFF frames.
#include "capture/base/image_file.h"
#include "fit/cube/table_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::filesystem::path file = eyebox::fuzz::MemoryFile(eyebox::fuzz::AsText(data, size));
  const auto strip = eyebox::fit::ReadStrip(file);
  if (strip.ok()) {
    const auto side = static_cast<size_t>(strip->size);
    FUZZ_CHECK(side >= 2 && strip->entries.size() == side * side * side);
    for (const auto& entry : strip->entries) {
      for (const double value : entry) FUZZ_CHECK(value >= 0 && value <= 1);
    }
  }
  const auto grey = eyebox::ReadGreyImage(file);
  if (grey.ok()) {
    FUZZ_CHECK(grey->bits_per_sample == 8 || grey->bits_per_sample == 16);
    FUZZ_CHECK(!grey->pixels_dn.empty());
  }
  return 0;
}
