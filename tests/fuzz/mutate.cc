#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace eyebox::fuzz {
namespace {

constexpr size_t kLongestInput = size_t{1} << 16;

// Not std::uniform_int_distribution, whose results differ between libraries.
size_t Below(size_t bound, std::mt19937_64& random) { return bound == 0 ? 0 : random() % bound; }

constexpr std::array<uint64_t, 10> kNumbers = {
    0, 1, 0x7f, 0x80, 0xff, 0x7fffffff, 0x80000000, 0xffffffff, 0x7fffffffffffffff, ~uint64_t{0}};
constexpr std::array<const char*, 14> kWords = {
    "-1", "0",  "1e400", "nan", "inf", "-0.0", "99999999999999999999",
    "\"", "\n", "{",     "}",   "../", ",",    "0x1p-1074"};

void SetBytes(std::string& text, std::mt19937_64& random) {
  const uint64_t value = kNumbers[Below(kNumbers.size(), random)];
  const size_t width = size_t{1} << Below(4, random);
  if (text.size() < width) return;
  std::memcpy(text.data() + Below(text.size() - width + 1, random), &value, width);
}

void CopyBlock(std::string& text, const std::string& from, std::mt19937_64& random) {
  const size_t begin = Below(from.size(), random);
  const size_t length = Below(std::min<size_t>(from.size() - begin, 256) + 1, random);
  const std::string block = from.substr(begin, length);
  const size_t at = Below(text.size() + 1, random);
  text.replace(at, random() % 2 == 0 ? 0 : std::min(length, text.size() - at), block);
}

void Change(std::string& text, std::span<const std::string> others, std::mt19937_64& random) {
  const size_t at = Below(text.size(), random);
  switch (random() % 8) {
    case 0:
      if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << Below(8, random)));
      return;
    case 1:
      if (!text.empty()) text[at] = static_cast<char>(random());
      return;
    case 2:
      return SetBytes(text, random);
    case 3:
      text.insert(at, kWords[Below(kWords.size(), random)]);
      return;
    case 4:
      text.erase(at, 1 + Below(32, random));
      return;
    case 5:
      return CopyBlock(text, std::string(text), random);
    case 6:
      return CopyBlock(text, others[Below(others.size(), random)], random);
    default:
      text.resize(at);
  }
}

}  // namespace

std::string Mutated(std::string input, std::span<const std::string> others,
                    std::mt19937_64& random) {
  const size_t changes = 1 + Below(4, random);
  for (size_t i = 0; i < changes; ++i) Change(input, others, random);
  if (input.size() > kLongestInput) input.resize(kLongestInput);
  return input;
}

}  // namespace eyebox::fuzz
