// The kernel's virtual video driver, and its buttons that make it misbehave.
#ifndef EYEBOX_TESTS_HARDWARE_VIVID_H_
#define EYEBOX_TESTS_HARDWARE_VIVID_H_

#include <cstdint>
#include <string>
#include <vector>

namespace eyebox::capture {

// Control numbers of vivid that no header exports: drivers/media/test-drivers/vivid/vivid-ctrls.c.
enum class VividControl : uint32_t {
  kTestPattern = 0x00f0f000,
  kOsdTextMode = 0x00f0f001,      // 2: no text over the picture
  kTimestampSource = 0x00f0f018,  // 0: end of frame, 1: start of exposure
  kDroppedPercent = 0x00f0f040,
  kDisconnect = 0x00f0f041,
  kSpoilNextBuffer = 0x00f0f042,
  kFatalStreamingError = 0x00f0f046,
};

enum class VividPattern : int32_t { kWhite = 6, kRed = 7, kGreen = 8, kBlue = 9, kBlack = 5 };

// /dev/videoN of every vivid camera; empty outside the virtual machine.
std::vector<std::string> VividNodes();

// Fails the running test where the driver refuses.
void SetVivid(const std::string& node, VividControl control, int32_t value);
int32_t ReadControlOf(const std::string& node, uint32_t id);

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_HARDWARE_VIVID_H_
