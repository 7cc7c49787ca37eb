#include "agricolmap/report/draw/png_file.hpp"

#include <png.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <new>

namespace agricolmap::report {
namespace {

/// Out of memory is all that can go wrong: libpng jumps back, past C++ objects if there were any.
void append(png_structp png, png_bytep bytes, std::size_t count) {
  auto& out = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bool full = false;
  try {
    out.insert(out.end(), bytes, bytes + count);
  } catch (const std::bad_alloc&) {
    full = true;
  }
  if (full) png_error(png, "out of memory");
}

void writeHead(png_structp png, png_infop info, int width, int height, int colour_type) {
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
}

struct Words {
  const std::uint32_t* pixels;
  int width;
  int height;
  std::size_t stride;
};

/// False when memory ran out.
bool writeAll(png_structp png, png_infop info, const Words& picture) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's interface
  writeHead(png, info, picture.width, picture.height, PNG_COLOR_TYPE_RGB);
  // Run lengths of differences alone: what else repeats in those of noise is not worth the search.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, Z_RLE);
  png_write_info(png, info);
  constexpr bool kLittle = std::endian::native == std::endian::little;
  png_set_filler(png, 0, kLittle ? PNG_FILLER_AFTER : PNG_FILLER_BEFORE);
  if (kLittle) png_set_bgr(png);
  for (int y = 0; y < picture.height; ++y) {
    png_write_row(png, reinterpret_cast<png_const_bytep>(picture.pixels + picture.stride * y));
  }
  png_write_end(png, info);
  return true;
}

struct Bytes {
  std::span<const std::uint8_t> bytes;
  int width;
  int height;
  int channels;
};

/// False when memory ran out.
bool writeAll(png_structp png, png_infop info, const Bytes& picture) {
  constexpr std::array kTypes = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA};
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's interface
  const auto channels = static_cast<std::size_t>(picture.channels);
  writeHead(png, info, picture.width, picture.height, kTypes[channels - 1]);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
  png_set_compression_level(png, 3);
  png_set_compression_strategy(png, Z_FILTERED);
  png_write_info(png, info);
  const std::size_t row = channels * static_cast<std::size_t>(picture.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    png_write_row(png, picture.bytes.data() + row * y);
  }
  png_write_end(png, info);
  return true;
}

template <typename Picture>
std::vector<std::uint8_t> encoded(const Picture& picture) {
  std::vector<std::uint8_t> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  bool written = false;
  if (info != nullptr) {
    png_set_write_fn(png, &out, append, nullptr);
    written = writeAll(png, info, picture);
  }
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::bad_alloc();
  return out;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const std::uint32_t* pixels, int width, int height,
                                    std::size_t stride) {
  return encoded(Words{pixels, width, height, stride});
}

std::vector<std::uint8_t> encodePng(std::span<const std::uint8_t> bytes, int width, int height,
                                    int channels) {
  return encoded(Bytes{bytes, width, height, channels});
}

}  // namespace agricolmap::report
