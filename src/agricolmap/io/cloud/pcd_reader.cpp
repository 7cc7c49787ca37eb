#include "agricolmap/io/cloud/pcd_reader.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <memory>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/ascii_source.hpp"
#include "agricolmap/io/cloud/pcd_data.hpp"
#include "agricolmap/io/cloud/pcd_header.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// Which fields hold what.
struct Roles {
  ThreeFields xyz{};
  std::optional<ThreeFields> colour;
  std::optional<std::size_t> packed;
};

Roles findRoles(const PcdHeader& header, const std::string& name, const ReadOptions& options) {
  Roles roles;
  roles.xyz = coordinatesOf(header, name);
  if (!options.colours) return roles;
  const std::vector<std::string_view> names = header.valueNames();
  roles.packed = findField(names, "rgb", name);
  if (!roles.packed) roles.packed = findField(names, "rgba", name);
  if (roles.packed && sizeOf(header.fields[*roles.packed].type) != 4) {
    throw InputError(fmt::format("{}: packed colours must have 4 bytes (float or uint32)", name));
  }
  if (roles.packed) return roles;
  roles.colour = findFields(names, {"r", "g", "b"}, name);
  if (!roles.colour) roles.colour = findFields(names, {"red", "green", "blue"}, name);
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

/// Points that were decompressed as a whole.
class DecompressedSource : public BinarySource {
 public:
  DecompressedSource(std::vector<std::byte> bytes, const BinaryColumns& columns)
      : BinarySource(columns), bytes_(std::move(bytes)) {}

 private:
  std::vector<std::byte> bytes_;  ///< what the columns look into
};

void openAscii(const PcdHeader& header, const Roles& roles, std::string_view text,
               PointFile& file) {
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
  layout.name = file.name;
  layout.text = text;
  layout.file = file.file;
  layout.points = header.points;
  layout.line_end = header.line_end;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    layout.columns.insert(layout.columns.end(), header.fields[i].count, {use_of(i)});
  }
  if (roles.packed) layout.colour = ColourKind::kByte;
  if (roles.colour) {
    const auto type = [&](std::size_t c) { return header.fields[(*roles.colour)[c]].type; };
    layout.colour = colourKindOf({type(0), type(1), type(2)});
  }
  auto source = std::make_unique<AsciiSource>(std::move(layout));
  warnOfRest(source->extraLines(), "lines", file);
  file.source = std::move(source);
}

void openData(const PcdHeader& header, const Roles& roles, std::string_view body, PointFile& file) {
  const std::span<const std::byte> data = std::as_bytes(std::span(body));
  switch (header.encoding) {
    case PcdEncoding::kAscii:
      openAscii(header, roles, body, file);
      return;
    case PcdEncoding::kBinary: {
      const std::uint64_t used = pcdBytes(header, data.size(), file.name);
      file.source = std::make_unique<BinarySource>(columnsOf(header, roles, data.data(), true));
      warnOfRest(data.size() - used, "bytes", file);
      return;
    }
    case PcdEncoding::kCompressed:
      break;
  }
  std::size_t rest = 0;
  std::vector<std::byte> plain = decompressPcd(header, data, file.name, rest);
  const BinaryColumns columns = columnsOf(header, roles, plain.data(), false);
  file.source = std::make_unique<DecompressedSource>(std::move(plain), columns);
  warnOfRest(rest, "bytes", file);
}

Eigen::Affine3d poseOf(const std::vector<double>& v) {
  Eigen::Quaterniond attitude(v[3], v[4], v[5], v[6]);
  if (!(attitude.norm() > 0.0)) attitude.setIdentity();
  return Eigen::Translation3d(v[0], v[1], v[2]) * attitude.normalized();
}

void warnOfViewpoint(const PcdHeader& header, PointFile& file) {
  constexpr std::size_t kNumbers = 7;
  const std::vector<double>& v = header.viewpoint;
  if (v.size() != kNumbers || !header.hasPose()) return;
  file.notes.push_back(fmt::format(
      "{}: its VIEWPOINT is not applied, as programs differ in what they mean by it: points are "
      "taken as stored. If they are as the sensor saw them, write this line into an offset.xyz "
      "beside it: {}",
      file.name, offsetLine(poseOf(v))));
}

}  // namespace

PointFile openPcd(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  const std::string_view text = withoutMark(file.text());
  const PcdHeader header = parsePcdHeader(text, name);
  PointFile opened;
  opened.name = name;
  opened.file = &file;
  opened.fields = fieldsOf(header);
  openData(header, findRoles(header, name, options), text.substr(header.bytes), opened);
  warnOfViewpoint(header, opened);
  return opened;
}

}  // namespace agricolmap::io
