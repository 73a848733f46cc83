#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "capture/base/image_file.h"
#include "capture/base/status.h"
#include "fit/cube/table_file.h"

namespace eyebox::fit {
namespace {

constexpr int kSmallestStrip = 2;
constexpr int kLargestStrip = 32;
constexpr double kTop = 255;

// Where an entry of the cube, red fastest, lies in the strip.
struct StripPixel {
  int x = 0;
  int y = 0;
};

StripPixel PixelOf(int size, size_t entry) {
  const int index = static_cast<int>(entry);
  const int red = index % size;
  const int green = index / size % size;
  const int blue = index / (size * size);
  return {red + blue * size, size - 1 - green};
}

}  // namespace

absl::StatusOr<std::string> EncodeStrip(const Cube3d& cube) {
  const int size = cube.size;
  if (size < kSmallestStrip || size > kLargestStrip) {
    return BadInput("strip", absl::StrCat("size ", size, " is outside 2 to ", kLargestStrip),
                    "design a smaller table");
  }
  Image<Rgb8> image({size * size, size});
  for (size_t i = 0; i < cube.entries.size(); ++i) {
    const StripPixel pixel = PixelOf(size, i);
    for (size_t channel = 0; channel < 3; ++channel) {
      const double entry = cube.entries[i][channel];
      if (!(entry >= 0 && entry <= 1)) {
        return BadInput("strip", "an entry is outside [0, 1]", "give drive values");
      }
      image.at(pixel.x, pixel.y)[channel] = static_cast<uint8_t>(std::lround(kTop * entry));
    }
  }
  return EncodePng(image);
}

absl::StatusOr<std::string> EncodeStrip(const TableDesign& table) {
  if (table.target != TableTarget::kPps) {
    return BadInput("strip",
                    absl::StrCat("the table was designed for ", std::string(NameOf(table.target))),
                    "design it for pps");
  }
  return EncodeStrip(ToCube(table, ""));
}

absl::StatusOr<Cube3d> ReadStrip(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const Image<Rgb8> image, ReadPngRgb8(file));
  const auto [width, size] = image.size();
  if (size < kSmallestStrip || size > kLargestStrip || width != size * size) {
    return BadInput(
        file.string(),
        absl::StrCat("is ", width, " x ", size, " pixels, not n^2 x n with n 2 to ", kLargestStrip),
        "give a strip such as 1024 x 32");
  }
  Cube3d cube;
  cube.size = size;
  cube.entries.resize(static_cast<size_t>(size) * size * size);
  for (size_t i = 0; i < cube.entries.size(); ++i) {
    const StripPixel pixel = PixelOf(size, i);
    const Rgb8& rgb = image.at(pixel.x, pixel.y);
    cube.entries[i] = {rgb[0] / kTop, rgb[1] / kTop, rgb[2] / kTop};
  }
  return cube;
}

}  // namespace eyebox::fit
