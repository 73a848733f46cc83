// .cube files and gamma tables as text. What is accepted has the entries that it announces, all
// finite, and is written as it was read.
#include <cmath>

#include "fit/cube/cube_parser.h"
#include "fit/cube/table_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eyebox::fit;
  const auto cube = ParseCube(eyebox::fuzz::AsText(data, size), "fuzz");
  if (!cube.ok()) return 0;
  const auto side = static_cast<size_t>(cube->size);
  FUZZ_CHECK(side >= 2 && cube->entries.size() == side * side * side);
  for (const auto& entry : cube->entries) {
    for (const double value : entry) FUZZ_CHECK(std::isfinite(value));
  }
  const std::string written = EncodeCube(*cube);
  const auto again = ParseCube(written, "fuzz");
  FUZZ_CHECK(again.ok());
  FUZZ_CHECK(again->entries == cube->entries && EncodeCube(*again) == written);
  return 0;
}
