#include "agricolmap/report/draw/png_file.hpp"

#include <png.h>
#include <zlib.h>

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

/// False when memory ran out.
bool writeAll(png_structp png, png_infop info, const std::uint32_t* pixels, int width, int height,
              std::size_t stride) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's interface
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE,
               PNG_FILTER_TYPE_BASE);
  // Run lengths of differences alone: what else repeats in those of noise is not worth the search.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, Z_RLE);
  png_write_info(png, info);
  constexpr bool kLittle = std::endian::native == std::endian::little;
  png_set_filler(png, 0, kLittle ? PNG_FILLER_AFTER : PNG_FILLER_BEFORE);
  if (kLittle) png_set_bgr(png);
  for (int y = 0; y < height; ++y) {
    png_write_row(png, reinterpret_cast<png_const_bytep>(pixels + stride * y));
  }
  png_write_end(png, info);
  return true;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const std::uint32_t* pixels, int width, int height,
                                    std::size_t stride) {
  std::vector<std::uint8_t> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  bool written = false;
  if (info != nullptr) {
    png_set_write_fn(png, &out, append, nullptr);
    written = writeAll(png, info, pixels, width, height, stride);
  }
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::bad_alloc();
  return out;
}

}  // namespace agricolmap::report
