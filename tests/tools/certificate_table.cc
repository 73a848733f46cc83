// Prints what tables leave of displays of several exponents and offsets beside what the published
// method leaves: by the evaluator of the tests, which shares no code with the designer.
#include <cstdio>
#include <string>

#include "fit/cube/design_table.h"
#include "fit/cube/table_file.h"
#include "tests/fit/cube/evaluator.h"

namespace eyebox::fit {
namespace {

using evaluator::Display;
using evaluator::Real;

constexpr Real kFrom = 0.05L;
constexpr int kSamples = 20011;

void PrintErrors(const evaluator::Errors& errors) {
  std::printf(" | %6.3Lf %6.3Lf %6.4Lf", 100 * errors.worst, 100 * errors.rms, errors.at);
}

int Print() {
  std::printf("luminance error of HDRP tables, u >= 5 %% of white: worst %%, rms %%, at u\n");
  std::printf("gamma offset | published, 32        | minimax, 32          | minimax, 64\n");
  for (Real gamma : {1.8L, 2.2L, 2.6L}) {
    for (Real offset : {0.0L, 0.01L}) {
      const Display display{200 * offset, 200, 0, gamma};
      std::printf("%5.1Lf %4.0Lf %%", gamma, 100 * offset);
      PrintErrors(evaluator::PublishedMethod(display, kFrom, kSamples));
      for (int size : {32, 64}) {
        const auto table = DesignTable(evaluator::ActivationOf(display), TableTarget::kHdrp, size);
        if (!table.ok()) return 1;
        PrintErrors(evaluator::Measure(display, ToCube(*table, ""), TableTarget::kHdrp, 1, kFrom,
                                       kSamples));
      }
      std::printf("\n");
    }
  }
  std::printf("\nafter storage, gamma 2.2, offset 0, 32 entries: certified worst %% (channel)\n");
  const Activation activation;
  const auto exact = DesignTable(activation, TableTarget::kHdrp, 32);
  for (const char* name :
       {"half", "r11g11b10", "filter8", "output8", "half,r11g11b10,filter8,output8"}) {
    const auto storage = StorageModelOf(name);
    if (!storage.ok() || !exact.ok()) return 1;
    const auto designed =
        DesignTable(activation, TableTarget::kHdrp, 32, {.designed_for = *storage});
    if (!designed.ok()) return 1;
    const auto before = CertifyStored(*exact, activation, {}, *storage);
    const auto after = CertifyStored(*designed, activation, {}, *storage);
    if (!before.ok() || !after.ok()) return 1;
    std::printf(
        "%-32s designed for an exact way %7.3f (%s), for this one %7.3f (%s)\n", name,
        100 * before->certificate.max_relative, std::string(NameOf(before->worst_channel)).c_str(),
        100 * after->certificate.max_relative, std::string(NameOf(after->worst_channel)).c_str());
  }
  return 0;
}

}  // namespace
}  // namespace eyebox::fit

int main() { return eyebox::fit::Print(); }
