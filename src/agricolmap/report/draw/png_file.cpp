#include "agricolmap/report/draw/png_file.hpp"

#include <zlib.h>

#include <array>
#include <new>
#include <string_view>

namespace agricolmap::report {
namespace {

constexpr std::size_t kChannels = 3;
constexpr std::uint8_t kSubFilter = 1;

void append32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) {
    out.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

void appendChunk(std::vector<std::uint8_t>& out, std::string_view type,
                 const std::vector<std::uint8_t>& data) {
  append32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append32(out, static_cast<std::uint32_t>(crc32_z(0, out.data() + begin, out.size() - begin)));
}

/// Rows as differences to the left neighbour, each behind its filter byte (PNG, section 9).
std::vector<std::uint8_t> filteredRows(const std::uint32_t* pixels, int width, int height,
                                       std::size_t stride) {
  std::vector<std::uint8_t> rows((static_cast<std::size_t>(width) * kChannels + 1) *
                                 static_cast<std::size_t>(height));
  std::uint8_t* out = rows.data();
  for (int y = 0; y < height; ++y) {
    const std::uint32_t* row = pixels + static_cast<std::size_t>(y) * stride;
    *out++ = kSubFilter;
    std::uint32_t left = 0;
    for (int x = 0; x < width; ++x) {
      const std::uint32_t here = row[x];
      out[0] = static_cast<std::uint8_t>((here >> 16) - (left >> 16));
      out[1] = static_cast<std::uint8_t>((here >> 8) - (left >> 8));
      out[2] = static_cast<std::uint8_t>(here - left);
      out += kChannels;
      left = here;
    }
  }
  return rows;
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  z_stream stream{};
  // Run lengths alone: what else repeats in differences of noise is not worth the search.
  if (deflateInit2(&stream, 1, Z_DEFLATED, MAX_WBITS, 9, Z_RLE) != Z_OK) throw std::bad_alloc();
  std::vector<std::uint8_t> out(deflateBound(&stream, bytes.size()));
  stream.next_in = const_cast<Bytef*>(bytes.data());  // zlib's interface lacks the const
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::bad_alloc();
  return out;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const std::uint32_t* pixels, int width, int height,
                                    std::size_t stride) {
  constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  std::vector<std::uint8_t> png(kSignature.begin(), kSignature.end());
  std::vector<std::uint8_t> header;
  append32(header, static_cast<std::uint32_t>(width));
  append32(header, static_cast<std::uint32_t>(height));
  // 8 bits, RGB, deflate, adaptive filters, not interlaced.
  header.insert(header.end(), {8, 2, 0, 0, 0});
  appendChunk(png, "IHDR", header);
  appendChunk(png, "IDAT", deflated(filteredRows(pixels, width, height, stride)));
  appendChunk(png, "IEND", {});
  return png;
}

}  // namespace agricolmap::report
