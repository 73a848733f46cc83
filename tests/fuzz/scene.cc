// A scene file.
#include "service/scene/read_scene.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(eyebox::fuzz::AsText(data, size));
  const auto scene = eyebox::service::ParseScene(text, "scene.textproto");
  if (!scene.ok()) return 0;
  FUZZ_CHECK(!scene->patches.empty() && scene->patches.size() == scene->patch_names.size());
  return 0;
}
