#include "capture/base/png.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "capture/base/status.h"

namespace eyebox {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr int kCompression = 6;  // fixed, so that the same picture gives the same bytes
constexpr png_uint_32 kLargestSide = 65535;
constexpr size_t kMostPixels = size_t{1} << 28;  // a few bytes can claim to be any number

// What libpng is told of its surroundings. It reports an error by a jump, which passes over the
// frames between: they hold nothing that has a destructor.
struct Context {
  std::jmp_buf on_error;
  char message[120] = "";
  const std::string* source = nullptr;
  size_t position = 0;
  std::string* target = nullptr;
};

[[noreturn]] void Fail(png_structp png, png_const_charp message) {
  auto* context = static_cast<Context*>(png_get_error_ptr(png));
  std::strncpy(context->message, message, sizeof(context->message) - 1);
  std::longjmp(context->on_error, 1);
}

void Ignore(png_structp, png_const_charp) {}

void Read(png_structp png, png_bytep to, size_t count) {
  auto* context = static_cast<Context*>(png_get_io_ptr(png));
  if (context->source->size() - context->position < count) Fail(png, "the file is truncated");
  std::memcpy(to, context->source->data() + context->position, count);
  context->position += count;
}

void Write(png_structp png, png_bytep from, size_t count) {
  static_cast<Context*>(png_get_io_ptr(png))
      ->target->append(reinterpret_cast<const char*>(from), count);
}

void Flush(png_structp) {}

// One image being read, a step a call. A step that returns false has left context().message.
class Reader {
 public:
  explicit Reader(const std::string& bytes) {
    context_.source = &bytes;
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &context_, Fail, Ignore);
    info_ = png_create_info_struct(png_);
    png_set_read_fn(png_, &context_, Read);
    png_set_user_limits(png_, kLargestSide, kLargestSide);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool ReadHeader() {
    if (setjmp(context_.on_error) != 0) return false;
    png_read_info(png_, info_);
    return true;
  }

  // `rows` point at rows of the sample size in the file; 16-bit samples come out little-endian.
  bool ReadRows(png_bytepp rows) {
    if (setjmp(context_.on_error) != 0) return false;
    if (bits() == 16) png_set_swap(png_);
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  ImageSize size() const {
    return {static_cast<int>(png_get_image_width(png_, info_)),
            static_cast<int>(png_get_image_height(png_, info_))};
  }
  int bits() const { return png_get_bit_depth(png_, info_); }
  bool Is(int colour_type) const {
    return png_get_color_type(png_, info_) == colour_type &&
           png_get_valid(png_, info_, PNG_INFO_tRNS) == 0;
  }
  const char* message() const { return context_.message; }

 private:
  Context context_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

absl::Status Damaged(const std::string& file, const Reader& reader) {
  return Corrupt(file, std::string("cannot be read to its end: ") + reader.message(),
                 "copy it again from where it was taken");
}

template <typename T>
std::vector<png_bytep> RowsOf(Image<T>& image) {
  std::vector<png_bytep> rows;
  for (int y = 0; y < image.size().height_px; ++y) {
    rows.push_back(reinterpret_cast<png_bytep>(image.row(y).data()));
  }
  return rows;
}

template <typename T>
absl::StatusOr<Image<T>> ReadSamples(const std::string& file, Reader& reader) {
  if (reader.size().PixelCount() > kMostPixels) {
    return BadInput(file, "has " + std::to_string(reader.size().PixelCount()) + " pixels",
                    "give images of at most " + std::to_string(kMostPixels));
  }
  Image<T> image(reader.size());
  std::vector<png_bytep> rows = RowsOf(image);
  if (!reader.ReadRows(rows.data())) return Damaged(file, reader);
  return image;
}

bool WriteImage(const Image<Rgb8>& image, png_bytepp rows, Context& context) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &context, Fail, Ignore);
  png_infop info = png_create_info_struct(png);
  if (setjmp(context.on_error) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &context, Write, Flush);
  png_set_compression_level(png, kCompression);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.size().width_px),
               static_cast<png_uint_32>(image.size().height_px), 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

bool LooksLikePng(const std::string& bytes) { return bytes.starts_with(kSignature); }

absl::StatusOr<StillImage> DecodeGreyPng(const std::string& file, const std::string& bytes) {
  Reader reader(bytes);
  if (!reader.ReadHeader()) return Damaged(file, reader);
  StillImage image;
  image.bits_per_sample = reader.bits();
  if (!reader.Is(PNG_COLOR_TYPE_GRAY) || image.bits_per_sample < 8) {
    return BadInput(file, "is not a greyscale image of 8 or 16 bit",
                    "save it as greyscale, 8 or 16 bit, without palette or transparency");
  }
  if (image.bits_per_sample == 16) {
    EYEBOX_ASSIGN_OR_RETURN(image.pixels_dn, ReadSamples<uint16_t>(file, reader));
    return image;
  }
  EYEBOX_ASSIGN_OR_RETURN(const Image<uint8_t> narrow, ReadSamples<uint8_t>(file, reader));
  image.pixels_dn = Image<uint16_t>(narrow.size());
  std::ranges::copy(narrow.pixels(), image.pixels_dn.pixels().begin());
  return image;
}

absl::StatusOr<Image<Rgb8>> DecodeRgbPng(const std::string& file, const std::string& bytes) {
  Reader reader(bytes);
  if (!reader.ReadHeader()) return Damaged(file, reader);
  if (!reader.Is(PNG_COLOR_TYPE_RGB) || reader.bits() != 8) {
    return BadInput(file, "is not 8-bit RGB", "save it as RGB, 8 bit, no transparency");
  }
  return ReadSamples<Rgb8>(file, reader);
}

absl::StatusOr<std::string> EncodePng(const Image<Rgb8>& image) {
  if (image.empty()) return BadInput("image", "has no pixel", "give one or more");
  Image<Rgb8> copy = image;  // libpng asks for rows that it may change
  std::vector<png_bytep> rows = RowsOf(copy);
  std::string encoded;
  Context context;
  context.target = &encoded;
  if (WriteImage(copy, rows.data(), context)) return encoded;
  return absl::InternalError(
      Complaint(std::to_string(image.size().width_px) + " x " +
                    std::to_string(image.size().height_px) + " image",
                std::string("was refused by the PNG encoder: ") + context.message,
                "report this with the command that led to it"));
}

}  // namespace eyebox
