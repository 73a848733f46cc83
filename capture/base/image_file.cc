#include "capture/base/image_file.h"

#include <array>
#include <bit>
#include <cstring>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/base/tiff.h"

namespace eyebox {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t kLargestFile = size_t{1} << 30;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr uint8_t kPngGrey = 0;
constexpr uint8_t kPngRgb = 2;
constexpr int kPngCompression = 6;  // fixed, so that the same picture gives the same bytes

// ISO 3309, as PNG chunks carry it (PNG specification, annex D).
uint32_t Crc32(std::string_view bytes) {
  static const std::array<uint32_t, 256> table = [] {
    std::array<uint32_t, 256> entries{};
    for (uint32_t i = 0; i < 256; ++i) {
      entries[i] = i;
      for (int k = 0; k < 8; ++k) {
        entries[i] = entries[i] & 1 ? 0xedb88320 ^ (entries[i] >> 1) : entries[i] >> 1;
      }
    }
    return entries;
  }();
  uint32_t crc = 0xffffffff;
  for (const char byte : bytes) crc = table[(crc ^ static_cast<uint8_t>(byte)) & 0xff] ^ (crc >> 8);
  return ~crc;
}

uint32_t BigEndian32(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  return value;
}

absl::Status DamagedPng(const std::string& file, const std::string& what) {
  return Corrupt(file, what, "copy it again from where it was taken");
}

// Every chunk whole and up to IEND: libpng alone returns what it has of a truncated file.
absl::Status CheckChunks(const std::string& file, std::string_view bytes) {
  constexpr size_t kFrame = 12;  // length, type and CRC of a chunk
  size_t at = kPngSignature.size();
  while (true) {
    const bool framed = bytes.size() - at >= kFrame;
    const size_t length = framed ? BigEndian32(bytes, at) : 0;
    if (!framed || bytes.size() - at - kFrame < length) return DamagedPng(file, "is truncated");
    const std::string_view type = bytes.substr(at + 4, 4);
    if (Crc32(bytes.substr(at + 4, length + 4)) != BigEndian32(bytes, at + 8 + length)) {
      return DamagedPng(file, "is damaged in its chunk at byte " + std::to_string(at));
    }
    at += kFrame + length;
    if (type == "IEND") return absl::OkStatus();
  }
}

struct PngKind {
  uint8_t bits = 0;
  uint8_t colour_type = 0;
};

absl::StatusOr<PngKind> CheckPng(const std::string& file, std::string_view bytes) {
  EYEBOX_RETURN_IF_ERROR(CheckChunks(file, bytes));
  constexpr size_t kDepth = 24;  // signature, chunk frame, width and height stand before it
  if (bytes.size() < 33 || bytes.substr(12, 4) != "IHDR") {
    return DamagedPng(file, "does not begin with an image header");
  }
  return PngKind{static_cast<uint8_t>(bytes[kDepth]), static_cast<uint8_t>(bytes[kDepth + 1])};
}

cv::Mat DecodeSilently(const std::string& bytes) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  try {
    return cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return {};
  }
}

absl::StatusOr<StillImage> DecodeGreyPng(const std::string& file, const std::string& bytes) {
  EYEBOX_ASSIGN_OR_RETURN(const PngKind kind, CheckPng(file, bytes));
  if (kind.colour_type != kPngGrey || (kind.bits != 8 && kind.bits != 16)) {
    return BadInput(file, "is not a greyscale image of 8 or 16 bit",
                    "save it as greyscale, 8 or 16 bit, without palette or transparency");
  }
  const cv::Mat pixels = DecodeSilently(bytes);
  if (pixels.empty()) return DamagedPng(file, "cannot be decoded");
  if (pixels.type() != (kind.bits == 8 ? CV_8UC1 : CV_16UC1)) {
    return BadInput(file, "has a transparent colour", "save it without transparency");
  }
  StillImage image;
  image.bits_per_sample = kind.bits;
  image.pixels_dn = Image<uint16_t>({pixels.cols, pixels.rows});
  cv::Mat widened(pixels.rows, pixels.cols, CV_16UC1, image.pixels_dn.pixels().data());
  pixels.convertTo(widened, CV_16U);
  return image;
}

}  // namespace

absl::StatusOr<StillImage> ReadGreyImage(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, kLargestFile));
  if (LooksLikeTiff(bytes)) return DecodeTiff(file.string(), bytes);
  if (bytes.starts_with(kPngSignature)) return DecodeGreyPng(file.string(), bytes);
  return BadInput(file.string(), "is neither TIFF nor PNG",
                  "give frames as 8- or 16-bit greyscale TIFF or PNG");
}

absl::StatusOr<std::string> EncodePng(const Image<Rgb8>& image) {
  if (image.empty()) return BadInput("image", "has no pixel", "give one or more");
  const ImageSize size = image.size();
  cv::Mat bgr(size.height_px, size.width_px, CV_8UC3);
  for (int y = 0; y < size.height_px; ++y) {
    auto* row = bgr.ptr<cv::Vec3b>(y);
    for (int x = 0; x < size.width_px; ++x) {
      const Rgb8& rgb = image.at(x, y);
      row[x] = cv::Vec3b(rgb[2], rgb[1], rgb[0]);
    }
  }
  std::vector<uint8_t> encoded;
  try {
    if (cv::imencode(".png", bgr, encoded, {cv::IMWRITE_PNG_COMPRESSION, kPngCompression})) {
      return std::string(encoded.begin(), encoded.end());
    }
  } catch (const cv::Exception&) {
    encoded.clear();
  }
  return absl::InternalError(
      Complaint(std::to_string(size.width_px) + " x " + std::to_string(size.height_px) + " image",
                "was refused by the PNG encoder", "report this with the command that led to it"));
}

absl::Status WritePng(const std::filesystem::path& file, const Image<Rgb8>& image) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, EncodePng(image));
  return WriteFileAtomically(file, bytes);
}

absl::StatusOr<Image<Rgb8>> ReadPngRgb8(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, kLargestFile));
  if (!bytes.starts_with(kPngSignature)) {
    return BadInput(file.string(), "is not a PNG", "give an 8-bit RGB PNG");
  }
  EYEBOX_ASSIGN_OR_RETURN(const PngKind kind, CheckPng(file.string(), bytes));
  if (kind.colour_type != kPngRgb || kind.bits != 8) {
    return BadInput(file.string(), "is not 8-bit RGB", "save it as RGB, 8 bit, no transparency");
  }
  const cv::Mat bgr = DecodeSilently(bytes);
  if (bgr.empty() || bgr.type() != CV_8UC3) return DamagedPng(file.string(), "cannot be decoded");
  Image<Rgb8> image({bgr.cols, bgr.rows});
  for (int y = 0; y < bgr.rows; ++y) {
    const auto* row = bgr.ptr<cv::Vec3b>(y);
    for (int x = 0; x < bgr.cols; ++x) image.at(x, y) = {row[x][2], row[x][1], row[x][0]};
  }
  return image;
}

}  // namespace eyebox
