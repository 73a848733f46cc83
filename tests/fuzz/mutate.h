// Seeded damage to an input, of the kinds that a fuzzer tries first.
#ifndef EYEBOX_TESTS_FUZZ_MUTATE_H_
#define EYEBOX_TESTS_FUZZ_MUTATE_H_

#include <random>
#include <span>
#include <string>

namespace eyebox::fuzz {

// One to four changes of `input`: bits, bytes, numbers, blocks cut, doubled, moved or taken from
// one of `others`, and a cut end. The same generator state gives the same result on any machine.
std::string Mutated(std::string input, std::span<const std::string> others,
                    std::mt19937_64& random);

}  // namespace eyebox::fuzz

#endif  // EYEBOX_TESTS_FUZZ_MUTATE_H_
