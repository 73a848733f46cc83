// Every target over its corpus and a fixed number of seeded mutations of it. A crash is the
// failure; libFuzzer itself is run with the preset fuzz (README.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "capture/base/file.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/mutate.h"

#define F(name) extern "C" int Fuzz_##name(const uint8_t* data, size_t size);
EYEBOX_FUZZ_TARGETS
#undef F

namespace eyebox::fuzz {
namespace {

struct Target {
  const char* name;
  int (*run)(const uint8_t*, size_t);
};

constexpr Target kTargets[] = {
#define F(name) {#name, Fuzz_##name},
    EYEBOX_FUZZ_TARGETS
#undef F
};
constexpr int kMutations = 2000;

class FuzzSmoke : public testing::TestWithParam<Target> {};

std::vector<std::string> Corpus(const std::string& target) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path folder = EYEBOX_SOURCE_DIR "/tests/fuzz/corpus/" + target;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<std::string> corpus;
  for (const auto& file : files) corpus.push_back(*ReadWholeFile(file));
  return corpus;
}

TEST_P(FuzzSmoke, NoInputBringsItDown) {
  const Target& target = GetParam();
  const auto run = [&](const std::string& input) {
    // An allocation of exactly its length, so that AddressSanitizer sees the first byte beyond.
    const std::vector<uint8_t> bytes(input.begin(), input.end());
    EXPECT_EQ(target.run(bytes.data(), bytes.size()), 0);
  };
  const std::vector<std::string> corpus = Corpus(target.name);
  ASSERT_GE(corpus.size(), 3u) << "a target without examples tries nothing";
  run("");
  for (const std::string& input : corpus) run(input);
  std::mt19937_64 random(1);
  for (int i = 0; i < kMutations; ++i) {
    run(Mutated(corpus[static_cast<size_t>(i) % corpus.size()], corpus, random));
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzSmoke, testing::ValuesIn(kTargets),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace eyebox::fuzz
