// The contract on the kernel's virtual video driver, whose picture does not follow the exposure.
#include <gtest/gtest.h>

#include <string>

#include "tests/contract/camera_contract.h"
#include "tests/hardware/vivid.h"

namespace eyebox::capture {
namespace {

std::string VividUri(size_t index) {
  const auto nodes = VividNodes();
  return index < nodes.size() ? "v4l2:" + nodes[index] + "?size=320x180&format=Y12" : "";
}

std::string SinglePlanarUri(const std::filesystem::path&) { return VividUri(0); }
std::string MultiPlanarUri(const std::filesystem::path&) { return VividUri(1); }

// The guest is emulated and may be slow.
constexpr std::chrono::milliseconds kTimeout{10000};

INSTANTIATE_TEST_SUITE_P(
    Vivid, CameraContract,
    testing::Values(CameraCase{"single_planar", SinglePlanarUri, false, true, kTimeout},
                    CameraCase{"multi_planar", MultiPlanarUri, false, true, kTimeout}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace eyebox::capture
