#include "capture/camera/v4l2/v4l2_format.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>

namespace eyebox::capture {
namespace {

using enum BayerMosaic;
using enum PixelPacking;

constexpr uint32_t kY12P = v4l2_fourcc('Y', '1', '2', 'P');  // newer than Debian 12's header

constexpr std::array kFormats = {
    V4l2Format{V4L2_PIX_FMT_GREY, "GREY", 8, kBytes, kNone},
    V4l2Format{V4L2_PIX_FMT_Y10, "Y10", 10, kWords, kNone},
    V4l2Format{V4L2_PIX_FMT_Y10P, "Y10P", 10, k10Mipi, kNone},
    V4l2Format{V4L2_PIX_FMT_Y12, "Y12", 12, kWords, kNone},
    V4l2Format{kY12P, "Y12P", 12, k12Mipi, kNone},
    V4l2Format{V4L2_PIX_FMT_Y14, "Y14", 14, kWords, kNone},
    V4l2Format{V4L2_PIX_FMT_Y16, "Y16", 16, kWords, kNone},
    V4l2Format{V4L2_PIX_FMT_SBGGR8, "BA81", 8, kBytes, kBggr},
    V4l2Format{V4L2_PIX_FMT_SGBRG8, "GBRG", 8, kBytes, kGbrg},
    V4l2Format{V4L2_PIX_FMT_SGRBG8, "GRBG", 8, kBytes, kGrbg},
    V4l2Format{V4L2_PIX_FMT_SRGGB8, "RGGB", 8, kBytes, kRggb},
    V4l2Format{V4L2_PIX_FMT_SBGGR10, "BG10", 10, kWords, kBggr},
    V4l2Format{V4L2_PIX_FMT_SGBRG10, "GB10", 10, kWords, kGbrg},
    V4l2Format{V4L2_PIX_FMT_SGRBG10, "BA10", 10, kWords, kGrbg},
    V4l2Format{V4L2_PIX_FMT_SRGGB10, "RG10", 10, kWords, kRggb},
    V4l2Format{V4L2_PIX_FMT_SBGGR10P, "pBAA", 10, k10Mipi, kBggr},
    V4l2Format{V4L2_PIX_FMT_SGBRG10P, "pGAA", 10, k10Mipi, kGbrg},
    V4l2Format{V4L2_PIX_FMT_SGRBG10P, "pgAA", 10, k10Mipi, kGrbg},
    V4l2Format{V4L2_PIX_FMT_SRGGB10P, "pRAA", 10, k10Mipi, kRggb},
    V4l2Format{V4L2_PIX_FMT_SBGGR12, "BG12", 12, kWords, kBggr},
    V4l2Format{V4L2_PIX_FMT_SGBRG12, "GB12", 12, kWords, kGbrg},
    V4l2Format{V4L2_PIX_FMT_SGRBG12, "BA12", 12, kWords, kGrbg},
    V4l2Format{V4L2_PIX_FMT_SRGGB12, "RG12", 12, kWords, kRggb},
    V4l2Format{V4L2_PIX_FMT_SBGGR12P, "pBCC", 12, k12Mipi, kBggr},
    V4l2Format{V4L2_PIX_FMT_SGBRG12P, "pGCC", 12, k12Mipi, kGbrg},
    V4l2Format{V4L2_PIX_FMT_SGRBG12P, "pgCC", 12, k12Mipi, kGrbg},
    V4l2Format{V4L2_PIX_FMT_SRGGB12P, "pRCC", 12, k12Mipi, kRggb},
    V4l2Format{V4L2_PIX_FMT_SBGGR14, "BG14", 14, kWords, kBggr},
    V4l2Format{V4L2_PIX_FMT_SGBRG14, "GB14", 14, kWords, kGbrg},
    V4l2Format{V4L2_PIX_FMT_SGRBG14, "GR14", 14, kWords, kGrbg},
    V4l2Format{V4L2_PIX_FMT_SRGGB14, "RG14", 14, kWords, kRggb},
    V4l2Format{V4L2_PIX_FMT_SBGGR16, "BYR2", 16, kWords, kBggr},
    V4l2Format{V4L2_PIX_FMT_SGBRG16, "GB16", 16, kWords, kGbrg},
    V4l2Format{V4L2_PIX_FMT_SGRBG16, "GR16", 16, kWords, kGrbg},
    V4l2Format{V4L2_PIX_FMT_SRGGB16, "RG16", 16, kWords, kRggb},
};

}  // namespace

std::span<const V4l2Format> V4l2Formats() { return kFormats; }

const V4l2Format* FindV4l2Format(uint32_t fourcc) {
  const auto* found = std::ranges::find(kFormats, fourcc, &V4l2Format::fourcc);
  return found == kFormats.end() ? nullptr : found;
}

const V4l2Format* FindV4l2Format(std::string_view name) {
  const auto* found = std::ranges::find(kFormats, name, &V4l2Format::name);
  return found == kFormats.end() ? nullptr : found;
}

std::string FourccName(uint32_t fourcc) {
  if (const V4l2Format* known = FindV4l2Format(fourcc)) return std::string(known->name);
  std::string name;
  for (int shift = 0; shift < 32; shift += 8) name += static_cast<char>(fourcc >> shift & 0x7f);
  name.erase(name.find_last_not_of(' ') + 1);
  return name;
}

}  // namespace eyebox::capture
