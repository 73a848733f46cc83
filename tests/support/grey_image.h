// Writes the TIFF files that tests read: uncompressed, in two strips, byte for byte known.
#ifndef EYEBOX_TESTS_SUPPORT_GREY_IMAGE_H_
#define EYEBOX_TESTS_SUPPORT_GREY_IMAGE_H_

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "capture/base/image.h"

namespace eyebox {

// Little-endian baseline TIFF: header, directory, then the strips; `bits` is 8 or 16.
inline std::string EncodeGreyTiff(const Image<uint16_t>& image, int bits) {
  std::string file("II*\0", 4);
  const auto put16 = [&file](uint32_t value) {
    file.push_back(static_cast<char>(value & 0xff));
    file.push_back(static_cast<char>(value >> 8 & 0xff));
  };
  const auto put32 = [&put16](uint32_t value) {
    put16(value & 0xffff);
    put16(value >> 16);
  };
  const auto width = static_cast<uint32_t>(image.size().width_px);
  const auto height = static_cast<uint32_t>(image.size().height_px);
  const uint32_t bytes = static_cast<uint32_t>(bits) / 8;
  const uint32_t rows = (height + 1) / 2;  // of the first strip
  constexpr uint32_t kFields = 9;
  constexpr uint32_t kArrays = 8 + 2 + 12 * kFields + 4;  // offsets, then byte counts
  const uint32_t pixels = kArrays + 16;
  const auto field = [&](uint32_t tag, uint32_t type, uint32_t count, uint32_t value) {
    put16(tag);
    put16(type);
    put32(count);
    put32(value);
  };
  put32(8);
  put16(kFields);
  field(256, 4, 1, width);
  field(257, 4, 1, height);
  field(258, 3, 1, static_cast<uint32_t>(bits));
  field(259, 3, 1, 1);  // no compression
  field(262, 3, 1, 1);  // black is zero
  field(273, 4, 2, kArrays);
  field(277, 3, 1, 1);
  field(278, 4, 1, rows);
  field(279, 4, 2, kArrays + 8);
  put32(0);  // no further page
  put32(pixels);
  put32(pixels + rows * width * bytes);
  put32(rows * width * bytes);
  put32((height - rows) * width * bytes);
  for (const uint16_t count_dn : image.pixels()) {
    if (bytes == 2) {
      put16(count_dn);
    } else {
      file.push_back(static_cast<char>(count_dn));
    }
  }
  return file;
}

inline void WriteGreyTiff(const std::filesystem::path& file, const Image<uint16_t>& image,
                          int bits) {
  std::ofstream(file, std::ios::binary) << EncodeGreyTiff(image, bits);
}

}  // namespace eyebox

#endif  // EYEBOX_TESTS_SUPPORT_GREY_IMAGE_H_
