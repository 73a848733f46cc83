#include "capture/base/tiff.h"

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

#include "capture/base/status.h"

namespace eyebox {
namespace {

constexpr uint64_t kMostPixels = uint64_t{1} << 28;  // before memory is taken

// A file in memory and what libtiff complains of, so that nothing is printed.
struct Source {
  const std::string& bytes;
  uint64_t at = 0;
  std::string complaint;
};

Source& SourceOf(thandle_t handle) { return *static_cast<Source*>(handle); }

tmsize_t Read(thandle_t handle, void* to, tmsize_t size) {
  Source& source = SourceOf(handle);
  if (source.at >= source.bytes.size()) return 0;
  const size_t got = std::min(static_cast<size_t>(size), source.bytes.size() - source.at);
  std::memcpy(to, source.bytes.data() + source.at, got);
  source.at += got;
  return static_cast<tmsize_t>(got);
}

tmsize_t RefuseToWrite(thandle_t, void*, tmsize_t) { return 0; }

toff_t Seek(thandle_t handle, toff_t offset, int whence) {
  Source& source = SourceOf(handle);
  if (whence == SEEK_CUR) offset += source.at;
  if (whence == SEEK_END) offset += source.bytes.size();
  return source.at = offset;
}

int Close(thandle_t) { return 0; }
toff_t Size(thandle_t handle) { return SourceOf(handle).bytes.size(); }

int KeepComplaint(TIFF*, void* source, const char*, const char* format, va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof(text), format, arguments);
  std::string& complaint = static_cast<Source*>(source)->complaint;
  if (complaint.empty()) complaint = text;  // the first is the cause of the others
  return 1;
}

int IgnoreWarning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

struct TiffCloser {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffHandle = std::unique_ptr<TIFF, TiffCloser>;

TiffHandle Open(const std::string& file, Source& source) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, KeepComplaint, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options, IgnoreWarning, nullptr);
  TiffHandle tiff(TIFFClientOpenExt(file.c_str(), "rm", &source, Read, RefuseToWrite, Seek, Close,
                                    Size, nullptr, nullptr, options));
  TIFFOpenOptionsFree(options);
  return tiff;
}

absl::Status Damaged(const std::string& file, const Source& source) {
  return Corrupt(
      file,
      "is truncated or damaged" + (source.complaint.empty() ? "" : " (" + source.complaint + ")"),
      "copy it again from where it was taken");
}

uint16_t Field16(TIFF* tiff, ttag_t tag) {
  uint16_t value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

uint32_t Field32(TIFF* tiff, ttag_t tag) {
  uint32_t value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

absl::Status CheckKind(const std::string& file, TIFF* tiff) {
  constexpr const char* kRemedy =
      "save it as greyscale TIFF of 8 or 16 bit, one page, in strips, black is zero";
  const uint16_t bits = Field16(tiff, TIFFTAG_BITSPERSAMPLE);
  if (Field16(tiff, TIFFTAG_SAMPLESPERPIXEL) != 1) {
    return BadInput(file, "has more than one channel", kRemedy);
  }
  if (bits != 8 && bits != 16) {
    return BadInput(file, "has " + std::to_string(bits) + " bits per sample", kRemedy);
  }
  if (Field16(tiff, TIFFTAG_SAMPLEFORMAT) != SAMPLEFORMAT_UINT) {
    return BadInput(file, "holds samples that are not unsigned integers", kRemedy);
  }
  if (Field16(tiff, TIFFTAG_PHOTOMETRIC) != PHOTOMETRIC_MINISBLACK) {
    return BadInput(file, "is not greyscale with black as zero", kRemedy);
  }
  if (Field16(tiff, TIFFTAG_COMPRESSION) == COMPRESSION_JPEG) {
    return BadInput(file, "is compressed with loss", kRemedy);
  }
  if (TIFFIsTiled(tiff)) return BadInput(file, "is stored in tiles", kRemedy);
  if (!TIFFLastDirectory(tiff)) return BadInput(file, "has more than one page", kRemedy);
  return absl::OkStatus();
}

void Widen(const std::string& samples, int bytes_per_sample, std::span<uint16_t> pixels_dn) {
  if (bytes_per_sample == 2) {
    std::memcpy(pixels_dn.data(), samples.data(), samples.size());
    return;
  }
  std::transform(samples.begin(), samples.end(), pixels_dn.begin(),
                 [](char sample) { return static_cast<uint8_t>(sample); });
}

}  // namespace

bool LooksLikeTiff(const std::string& bytes) {
  return bytes.starts_with(std::string("II*\0", 4)) || bytes.starts_with(std::string("MM\0*", 4));
}

absl::StatusOr<StillImage> DecodeTiff(const std::string& file, const std::string& bytes) {
  Source source{.bytes = bytes, .at = 0, .complaint = {}};
  const TiffHandle tiff = Open(file, source);
  if (!tiff) return Damaged(file, source);
  EYEBOX_RETURN_IF_ERROR(CheckKind(file, tiff.get()));
  const uint32_t width = Field32(tiff.get(), TIFFTAG_IMAGEWIDTH);
  const uint32_t height = Field32(tiff.get(), TIFFTAG_IMAGELENGTH);
  if (width == 0 || height == 0 || uint64_t{width} * height > kMostPixels) {
    return BadInput(file, "is " + std::to_string(width) + " x " + std::to_string(height) + " px",
                    "give 1 to " + std::to_string(kMostPixels) + " px in all");
  }
  StillImage image;
  image.bits_per_sample = Field16(tiff.get(), TIFFTAG_BITSPERSAMPLE);
  image.pixels_dn = Image<uint16_t>({static_cast<int>(width), static_cast<int>(height)});
  const int bytes_per_sample = image.bits_per_sample / 8;
  const uint32_t rows_per_strip = std::min(Field32(tiff.get(), TIFFTAG_ROWSPERSTRIP), height);
  if (rows_per_strip == 0) return Damaged(file, source);
  std::string samples;
  for (uint32_t y = 0; y < height; y += rows_per_strip) {
    const size_t rows = std::min(rows_per_strip, height - y);
    samples.resize(rows * width * bytes_per_sample);
    const tmsize_t got = TIFFReadEncodedStrip(tiff.get(), y / rows_per_strip, samples.data(),
                                              static_cast<tmsize_t>(samples.size()));
    if (got != static_cast<tmsize_t>(samples.size()) || !source.complaint.empty()) {
      return Damaged(file, source);
    }
    Widen(samples, bytes_per_sample,
          image.pixels_dn.pixels().subspan(size_t{y} * width, rows * width));
  }
  return image;
}

}  // namespace eyebox
