// Uniform random numbers that are the same on every machine (std:: distributions are not).
#ifndef EYEBOX_CAPTURE_BASE_RANDOM_H_
#define EYEBOX_CAPTURE_BASE_RANDOM_H_

#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>

namespace eyebox {

// SplitMix64 (Steele, Lea & Flood 2014): one step of a bijective mixer, used to spread keys.
constexpr uint64_t MixBits(uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

// xoshiro256** (Blackman & Vigna 2021). Streams of different keys are independent for practical
// purposes; the same key gives the same stream. Not thread-safe; for simulation, not for secrets.
class RandomStream {
 public:
  explicit constexpr RandomStream(std::initializer_list<uint64_t> key) {
    uint64_t mixed = key.size();
    for (const uint64_t part : key) mixed = MixBits(mixed ^ MixBits(part));
    for (uint64_t& word : state_) word = mixed = MixBits(mixed);
  }

  constexpr uint64_t Next() {
    const uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  // In the open interval (0, 1): 2^52 equally spaced values, so that log() is always finite.
  constexpr double Uniform() { return (static_cast<double>(Next() >> 12) + 0.5) * 0x1p-52; }

  // In [0, bound), bound > 0, without bias: the few values past the last multiple are refused.
  constexpr uint64_t Below(uint64_t bound) {
    const uint64_t refused = -bound % bound;
    uint64_t value = Next();
    while (value < refused) value = Next();
    return value % bound;
  }

 private:
  std::array<uint64_t, 4> state_{};
};

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_RANDOM_H_
