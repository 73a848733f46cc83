#include "tests/hardware/vivid.h"

#include <errno.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstring>

#include "capture/camera/v4l2/v4l2_camera.h"

namespace eyebox::capture {
namespace {

int32_t Access(const std::string& node, unsigned long request, v4l2_control control) {
  const int fd = open(node.c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_GE(fd, 0) << node << ": " << std::strerror(errno);
  EXPECT_EQ(ioctl(fd, request, &control), 0)
      << node << " control " << std::hex << control.id << ": " << std::strerror(errno);
  close(fd);
  return control.value;
}

}  // namespace

std::vector<std::string> VividNodes() {
  std::vector<std::string> nodes;
  for (const V4l2Listing& listing : ListV4l2Cameras()) {
    if (listing.driver == "vivid") nodes.push_back(listing.uri.substr(listing.uri.find(':') + 1));
  }
  return nodes;
}

void SetVivid(const std::string& node, VividControl control, int32_t value) {
  Access(node, VIDIOC_S_CTRL, {.id = static_cast<uint32_t>(control), .value = value});
}

int32_t ReadControlOf(const std::string& node, uint32_t id) {
  return Access(node, VIDIOC_G_CTRL, {.id = id, .value = 0});
}

}  // namespace eyebox::capture
