#include "agricolmap/io/cloud/pcd_reader.hpp"

#include <fmt/format.h>

#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/ascii_source.hpp"
#include "agricolmap/io/cloud/pcd_data.hpp"
#include "agricolmap/io/cloud/pcd_header.hpp"

namespace agricolmap::io {
namespace {

/// Which fields hold what.
struct Roles {
  std::array<std::size_t, 3> xyz{};
  std::optional<std::array<std::size_t, 3>> colour;
  std::optional<std::size_t> packed;
};

std::optional<std::size_t> findField(const PcdHeader& header, std::string_view name) {
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (header.fields[i].name == name && header.fields[i].count == 1) return i;
  }
  return std::nullopt;
}

std::optional<std::array<std::size_t, 3>> findThree(const PcdHeader& header,
                                                    const std::array<std::string_view, 3>& names) {
  std::array<std::size_t, 3> indices{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto index = findField(header, names[c]);
    if (!index) return std::nullopt;
    indices[c] = *index;
  }
  return indices;
}

Roles findRoles(const PcdHeader& header, const std::string& name, const ReadOptions& options) {
  Roles roles;
  const auto xyz = findThree(header, {"x", "y", "z"});
  if (!xyz) throw InputError(fmt::format("{}: it lacks one of the fields x, y, z", name));
  roles.xyz = *xyz;
  if (!options.colours) return roles;
  roles.packed = findField(header, "rgb");
  if (!roles.packed) roles.packed = findField(header, "rgba");
  if (roles.packed && sizeOf(header.fields[*roles.packed].type) != 4) {
    throw InputError(fmt::format("{}: packed colours must have 4 bytes (float or uint32)", name));
  }
  if (roles.packed) return roles;
  roles.colour = findThree(header, {"r", "g", "b"});
  if (!roles.colour) roles.colour = findThree(header, {"red", "green", "blue"});
  return roles;
}

/// `interleaved`: point after point; otherwise field after field (binary_compressed).
BinaryColumns columnsOf(const PcdHeader& header, const Roles& roles, const std::byte* data,
                        bool interleaved) {
  const auto column = [&](std::size_t index) {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < index; ++i) offset += header.fields[i].bytes();
    const PcdField& field = header.fields[index];
    if (interleaved) return Column{data + offset, header.pointBytes(), field.type, false};
    return Column{data + offset * header.points, field.bytes(), field.type, false};
  };
  BinaryColumns columns;
  columns.points = header.points;
  for (std::size_t axis = 0; axis < 3; ++axis) columns.xyz[axis] = column(roles.xyz[axis]);
  if (roles.packed) columns.packed = column(*roles.packed);
  if (roles.colour) {
    const auto& c = *roles.colour;
    columns.colour = {column(c[0]), column(c[1]), column(c[2])};
  }
  return columns;
}

Cloud readAscii(const PcdHeader& header, const Roles& roles, std::string_view text,
                const std::string& name, const CoordinateMap* map) {
  using Use = AsciiColumn::Use;
  const auto use_of = [&](std::size_t field) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (roles.xyz[c] == field) return std::array{Use::kX, Use::kY, Use::kZ}[c];
      if (roles.colour && (*roles.colour)[c] == field) {
        return std::array{Use::kRed, Use::kGreen, Use::kBlue}[c];
      }
    }
    return roles.packed == field ? Use::kPacked : Use::kSkip;
  };
  AsciiLayout layout;
  layout.name = name;
  layout.text = text;
  layout.points = header.points;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    layout.columns.insert(layout.columns.end(), header.fields[i].count, {use_of(i)});
  }
  if (roles.packed) layout.colour = ColourKind::kByte;
  if (roles.colour) {
    const auto type = [&](std::size_t c) { return header.fields[(*roles.colour)[c]].type; };
    layout.colour = colourKindOf({type(0), type(1), type(2)});
  }
  const AsciiSource source(std::move(layout));
  Cloud cloud = assembleCloud(source, name, map);
  warnOfRest(source.extraLines(), "lines", cloud);
  return cloud;
}

Cloud readPoints(const PcdHeader& header, const Roles& roles, const MappedFile& file,
                 const std::string& name, const CoordinateMap* map) {
  const std::span<const std::byte> data = file.bytes().subspan(header.bytes);
  switch (header.encoding) {
    case PcdEncoding::kAscii:
      return readAscii(header, roles, file.text().substr(header.bytes), name, map);
    case PcdEncoding::kBinary: {
      const std::uint64_t used = pcdBytes(header, data.size(), name);
      Cloud cloud =
          assembleCloud(BinarySource(columnsOf(header, roles, data.data(), true)), name, map);
      warnOfRest(data.size() - used, "bytes", cloud);
      return cloud;
    }
    case PcdEncoding::kCompressed:
      break;
  }
  std::size_t rest = 0;
  const std::vector<std::byte> plain = decompressPcd(header, data, name, rest);
  Cloud cloud =
      assembleCloud(BinarySource(columnsOf(header, roles, plain.data(), false)), name, map);
  warnOfRest(rest, "bytes", cloud);
  return cloud;
}

}  // namespace

Cloud readPcd(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  const PcdHeader header = parsePcdHeader(file.text(), name);
  Cloud cloud = readPoints(header, findRoles(header, name, options), file, name, options.map);
  std::vector<std::string> names;
  for (const PcdField& field : header.fields) names.push_back(field.name);
  cloud.fields = fieldList(names);
  return cloud;
}

}  // namespace agricolmap::io
