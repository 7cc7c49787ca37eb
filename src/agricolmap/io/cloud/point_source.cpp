#include "agricolmap/io/cloud/point_source.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace agricolmap::io {
namespace {

static_assert(std::endian::native == std::endian::little, "written for little-endian machines");

template <typename T, bool kSwap>
T load(const std::byte* from) {
  if constexpr (!kSwap || sizeof(T) == 1) {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
  } else if constexpr (sizeof(T) == 2) {
    return std::bit_cast<T>(__builtin_bswap16(load<std::uint16_t, false>(from)));
  } else if constexpr (sizeof(T) == 4) {
    return std::bit_cast<T>(__builtin_bswap32(load<std::uint32_t, false>(from)));
  } else {
    return std::bit_cast<T>(__builtin_bswap64(load<std::uint64_t, false>(from)));
  }
}

/// Calls `visit` with a value of the C++ type of `type`.
template <typename Visit>
decltype(auto) withType(ScalarType type, const Visit& visit) {
  switch (type) {
    case ScalarType::kInt8:
      return visit(std::int8_t{});
    case ScalarType::kUint8:
      return visit(std::uint8_t{});
    case ScalarType::kInt16:
      return visit(std::int16_t{});
    case ScalarType::kUint16:
      return visit(std::uint16_t{});
    case ScalarType::kInt32:
      return visit(std::int32_t{});
    case ScalarType::kUint32:
      return visit(std::uint32_t{});
    case ScalarType::kInt64:
      return visit(std::int64_t{});
    case ScalarType::kUint64:
      return visit(std::uint64_t{});
    case ScalarType::kFloat32:
      return visit(float{});
    case ScalarType::kFloat64:
      break;
  }
  return visit(double{});
}

template <typename Out>
void loadColumn(const Column& column, std::size_t begin, std::size_t count, Out* out) {
  withType(column.type, [&](auto zero) {
    using T = decltype(zero);
    const std::byte* from = column.base + begin * column.stride;
    const std::size_t stride = column.stride;
    if (column.swap) {
      for (std::size_t i = 0; i < count; ++i)
        out[i] = static_cast<Out>(load<T, true>(from + i * stride));
    } else {
      for (std::size_t i = 0; i < count; ++i)
        out[i] = static_cast<Out>(load<T, false>(from + i * stride));
    }
  });
}

}  // namespace

std::size_t sizeOf(ScalarType type) {
  return withType(type, [](auto zero) { return sizeof(zero); });
}

bool isFloating(ScalarType type) {
  return type == ScalarType::kFloat32 || type == ScalarType::kFloat64;
}

double loadScalar(const std::byte* from, ScalarType type, bool swap) {
  return withType(type, [&](auto zero) {
    using T = decltype(zero);
    return static_cast<double>(swap ? load<T, true>(from) : load<T, false>(from));
  });
}

ColourKind colourKindOf(const std::array<ScalarType, 3>& types) {
  ColourKind kind = ColourKind::kByte;
  for (const ScalarType type : types) {
    if (isFloating(type)) return ColourKind::kWideFloat;
    if (type != ScalarType::kUint8) kind = ColourKind::kWideInteger;
  }
  return kind;
}

std::string fieldList(const std::vector<std::string>& names) {
  constexpr std::size_t kMostBytes = 200;
  std::string list;
  for (const std::string& name : names) {
    if (list.size() + name.size() > kMostBytes) return list + ", …";
    list += list.empty() ? "" : ", ";
    for (const char c : name) list += c >= ' ' && c <= '~' ? c : '?';
  }
  return list;
}

void warnOfRest(std::size_t count, std::string_view unit, PointFile& file) {
  if (count == 0) return;
  file.notes.push_back(
      fmt::format("{}: {} {} after the last point, ignored", file.name, count, unit));
}

ColourKind BinarySource::colourKind() const {
  if (columns_.packed) return ColourKind::kByte;
  if (!columns_.colour) return ColourKind::kNone;
  const auto& colour = *columns_.colour;
  return colourKindOf({colour[0].type, colour[1].type, colour[2].type});
}

bool BinarySource::floatCoordinates() const {
  return columns_.xyz[0].type == ScalarType::kFloat32 ||
         columns_.xyz[1].type == ScalarType::kFloat32;
}

void BinarySource::loadColours(std::size_t begin, PointBlock& block) const {
  if (columns_.packed) {
    const std::byte* from = columns_.packed->base + begin * columns_.packed->stride;
    for (std::size_t i = 0; i < block.count; ++i, from += columns_.packed->stride) {
      const auto bits = load<std::uint32_t, false>(from);
      block.rgb[i] = {static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
                      static_cast<std::uint8_t>(bits)};
    }
    return;
  }
  const auto& colour = *columns_.colour;
  if (colourKind() != ColourKind::kByte) {
    for (std::size_t c = 0; c < 3; ++c) {
      loadColumn(colour[c], begin, block.count, block.wide[c].data());
    }
    return;
  }
  const auto at = [&](std::size_t c, std::size_t i) {
    return std::to_integer<std::uint8_t>(colour[c].base[(begin + i) * colour[c].stride]);
  };
  for (std::size_t i = 0; i < block.count; ++i) block.rgb[i] = {at(0, i), at(1, i), at(2, i)};
}

void BinarySource::decode(std::size_t chunk, const Sink& sink) const {
  const ColourKind kind = colourKind();
  const std::size_t end = std::min(columns_.points, (chunk + 1) * kChunk);
  PointBlock block;
  for (std::size_t begin = chunk * kChunk; begin < end; begin += block.count) {
    block.count = std::min(PointBlock::kCapacity, end - begin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      loadColumn(columns_.xyz[axis], begin, block.count, block.xyz[axis].data());
    }
    if (kind != ColourKind::kNone) loadColours(begin, block);
    sink(block);
  }
}

}  // namespace agricolmap::io
