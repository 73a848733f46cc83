// events.log of a job: what is accepted has events 1, 2, ... and is left as whole lines.
#include "capture/base/file.h"
#include "service/server/store/event_log.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::filesystem::path file = eyebox::fuzz::MemoryFile(eyebox::fuzz::AsText(data, size));
  const auto events = eyebox::service::RecoverEvents(file);
  if (!events.ok()) return 0;
  for (size_t i = 0; i < events->size(); ++i) FUZZ_CHECK((*events)[i].sequence() == i + 1);
  const std::string left = *eyebox::ReadWholeFile(file);
  FUZZ_CHECK(left.empty() || left.back() == '\n');
  return 0;
}
