#include "capture/base/pixel_format.h"

#include <algorithm>
#include <array>
#include <string>

#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox {
namespace {

using enum PixelPacking;

constexpr std::array kFormats = {
    PixelFormat{0x01100007, "Mono16", 16, kWords},
    PixelFormat{0x01100025, "Mono14", 14, kWords},
    PixelFormat{0x01100005, "Mono12", 12, kWords},
    PixelFormat{0x010C0047, "Mono12p", 12, k12Lsb},
    PixelFormat{0x010C0006, "Mono12Packed", 12, k12GigE},
    PixelFormat{0x01100003, "Mono10", 10, kWords},
    PixelFormat{0x010A0046, "Mono10p", 10, k10Lsb},
    PixelFormat{0x010C0004, "Mono10Packed", 10, k10GigE},
    PixelFormat{0x01080001, "Mono8", 8, kBytes},
    PixelFormat{0x0110002E, "BayerGR16", 16, kWords, BayerMosaic::kGrbg},
    PixelFormat{0x0110002F, "BayerRG16", 16, kWords, BayerMosaic::kRggb},
    PixelFormat{0x01100030, "BayerGB16", 16, kWords, BayerMosaic::kGbrg},
    PixelFormat{0x01100031, "BayerBG16", 16, kWords, BayerMosaic::kBggr},
    PixelFormat{0x01100010, "BayerGR12", 12, kWords, BayerMosaic::kGrbg},
    PixelFormat{0x01100011, "BayerRG12", 12, kWords, BayerMosaic::kRggb},
    PixelFormat{0x01100012, "BayerGB12", 12, kWords, BayerMosaic::kGbrg},
    PixelFormat{0x01100013, "BayerBG12", 12, kWords, BayerMosaic::kBggr},
    PixelFormat{0x0110000C, "BayerGR10", 10, kWords, BayerMosaic::kGrbg},
    PixelFormat{0x0110000D, "BayerRG10", 10, kWords, BayerMosaic::kRggb},
    PixelFormat{0x0110000E, "BayerGB10", 10, kWords, BayerMosaic::kGbrg},
    PixelFormat{0x0110000F, "BayerBG10", 10, kWords, BayerMosaic::kBggr},
    PixelFormat{0x01080008, "BayerGR8", 8, kBytes, BayerMosaic::kGrbg},
    PixelFormat{0x01080009, "BayerRG8", 8, kBytes, BayerMosaic::kRggb},
    PixelFormat{0x0108000A, "BayerGB8", 8, kBytes, BayerMosaic::kGbrg},
    PixelFormat{0x0108000B, "BayerBG8", 8, kBytes, BayerMosaic::kBggr},
};

absl::Status Unknown(const std::string& format) {
  std::string known;
  for (const PixelFormat& each : kFormats) known.append(" ").append(each.name);
  return BadInput("pixel format " + format, "is not one whose counts can be read",
                  "set the camera to one of" + known);
}

struct Group {
  size_t pixels;
  size_t bytes;
};

constexpr Group GroupOf(PixelPacking packing) {
  switch (packing) {
    case kBytes:
      return {1, 1};
    case kWords:
      return {1, 2};
    case k10Lsb:
    case k10Mipi:
      return {4, 5};
    case k12Lsb:
    case k10GigE:
    case k12GigE:
    case k12Mipi:
      return {2, 3};
  }
  return {1, 2};
}

}  // namespace

std::span<const PixelFormat> KnownPixelFormats() { return kFormats; }

absl::StatusOr<PixelFormat> FindPixelFormat(uint32_t pfnc) {
  const auto found = std::ranges::find(kFormats, pfnc, &PixelFormat::pfnc);
  if (found == kFormats.end()) return Unknown(absl::StrFormat("0x%08X", pfnc));
  return *found;
}

absl::StatusOr<PixelFormat> FindPixelFormat(std::string_view name) {
  const auto found = std::ranges::find(kFormats, name, &PixelFormat::name);
  if (found == kFormats.end()) return Unknown("'" + std::string(name) + "'");
  return *found;
}

size_t PackedBytes(PixelPacking packing, size_t pixels) {
  const Group group = GroupOf(packing);
  const size_t rest = pixels % group.pixels;
  size_t bytes = pixels / group.pixels * group.bytes;
  if (rest == 0) return bytes;
  // A MIPI or GigE group keeps low bits behind its high bytes, so that a part of it needs them too.
  if (packing == k10Mipi) return bytes + 5;
  if (packing == k12Mipi) return bytes + 3;
  return bytes + (rest * group.bytes + group.pixels - 1) / group.pixels;
}

}  // namespace eyebox
