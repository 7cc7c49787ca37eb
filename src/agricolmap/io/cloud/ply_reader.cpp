#include "agricolmap/io/cloud/ply_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/cloud/ascii_source.hpp"
#include "agricolmap/io/cloud/ply_header.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr std::array<std::array<std::string_view, 3>, 3> kColourNames{
    {{"red", "green", "blue"}, {"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}}};

/// The vertex element and what its properties mean.
struct VertexLayout {
  const PlyElement* vertex = nullptr;
  ThreeFields xyz{};
  std::optional<ThreeFields> colour;
  bool partly_coloured = false;  ///< red or green, but not all three

  std::array<ScalarType, 3> types(const ThreeFields& indices) const {
    const auto& p = vertex->properties;
    return {p[indices[0]].type, p[indices[1]].type, p[indices[2]].type};
  }
  ColourKind colourKind() const {
    return colour ? colourKindOf(types(*colour)) : ColourKind::kNone;
  }
};

VertexLayout vertexLayout(const PlyHeader& header, const std::string& name,
                          const ReadOptions& options) {
  const PlyElement& vertex = vertexOf(header, name);
  VertexLayout layout;
  layout.vertex = &vertex;
  layout.xyz = coordinatesOf(vertex, name);
  if (vertex.count == 0) throw InputError(fmt::format("{}: empty cloud: 0 vertices", name));
  if (!options.colours) return layout;
  const std::vector<std::string_view> names = vertex.valueNames();
  for (const auto& colour : kColourNames) {
    if (!layout.colour) layout.colour = findFields(names, colour, name);
  }
  const auto is_red = [](const PlyProperty& p) {
    return lowerCase(p.name) == "red" || lowerCase(p.name) == "green";
  };
  layout.partly_coloured =
      !layout.colour && std::any_of(vertex.properties.begin(), vertex.properties.end(), is_red);
  return layout;
}

/// Walks over binary items whose lists make their sizes differ.
class Walker {
 public:
  Walker(const PlyElement& element, const std::byte* end, bool swap, const std::string& name)
      : element_(element), end_(end), swap_(swap), name_(name) {}

  /// End of the item at `from`. With `at`, also where each of its properties begins.
  const std::byte* next(const std::byte* from, std::uint64_t index,
                        std::vector<const std::byte*>* at = nullptr) const {
    for (std::size_t p = 0; p < element_.properties.size(); ++p) {
      const PlyProperty& property = element_.properties[p];
      if (at != nullptr) (*at)[p] = from;
      from = take(from, 1, sizeOf(property.list_count.value_or(property.type)), index);
      if (!property.list_count) continue;
      const double length =
          loadScalar(from - sizeOf(*property.list_count), *property.list_count, swap_);
      if (length < 0.0) {
        throw InputError(fmt::format("{}: {} {}: list '{}' has length {}", name_, element_.name,
                                     index + 1, property.name, length));
      }
      from = take(from, static_cast<std::uint64_t>(length), sizeOf(property.type), index);
    }
    return from;
  }

 private:
  const std::byte* take(const std::byte* from, std::uint64_t count, std::size_t size,
                        std::uint64_t index) const {
    if (count > static_cast<std::size_t>(end_ - from) / size) {
      throw InputError(
          fmt::format("{}: truncated: the header announces {} of element '{}', the "
                      "file ends inside number {}",
                      name_, element_.count, element_.name, index + 1));
    }
    return from + count * size;
  }

  const PlyElement& element_;
  const std::byte* end_;
  bool swap_;
  const std::string& name_;
};

/// Binary vertices with lists among their properties.
class ListedSource : public PointSource {
 public:
  /// `layout` points into `header`, which is kept.
  ListedSource(std::shared_ptr<const PlyHeader> header, const VertexLayout& layout,
               std::span<const std::byte> data, bool swap, const std::string& name)
      : header_(std::move(header)),
        name_(name),
        layout_(layout),
        swap_(swap),
        walker_(*layout.vertex, data.data() + data.size(), swap, name_) {
    const std::byte* from = data.data();
    for (std::uint64_t i = 0; i < layout.vertex->count; ++i) {
      if (i % kChunk == 0) {
        throwIfInterrupted();
        starts_.push_back(from);
      }
      from = walker_.next(from, i);
    }
    end_ = from;
  }
  std::size_t points() const override { return layout_.vertex->count; }
  std::size_t chunks() const override { return starts_.size(); }
  std::size_t firstPoint(std::size_t chunk) const override { return chunk * kChunk; }
  ColourKind colourKind() const override { return layout_.colourKind(); }
  bool floatCoordinates() const override {
    return layout_.vertex->properties[layout_.xyz[0]].type == ScalarType::kFloat32;
  }
  /// End of the last vertex.
  const std::byte* end() const { return end_; }

  void decode(std::size_t chunk, const Sink& sink) const override {
    const auto& properties = layout_.vertex->properties;
    std::vector<const std::byte*> at(properties.size());
    const auto value = [&](std::size_t p) { return loadScalar(at[p], properties[p].type, swap_); };
    const ColourKind kind = colourKind();
    const std::byte* from = starts_[chunk];
    const std::size_t end = std::min(points(), (chunk + 1) * kChunk);
    PointBlock block;
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      from = walker_.next(from, i, &at);
      const std::size_t k = block.count++;
      for (std::size_t axis = 0; axis < 3; ++axis) block.xyz[axis][k] = value(layout_.xyz[axis]);
      if (kind == ColourKind::kByte) {
        const auto byte = [&](std::size_t c) {
          return std::to_integer<std::uint8_t>(*at[(*layout_.colour)[c]]);
        };
        block.rgb[k] = {byte(0), byte(1), byte(2)};
      } else if (kind != ColourKind::kNone) {
        for (std::size_t c = 0; c < 3; ++c) {
          block.wide[c][k] = static_cast<float>(value((*layout_.colour)[c]));
        }
      }
      if (block.count == PointBlock::kCapacity || i + 1 == end) {
        sink(block);
        block.count = 0;
      }
    }
  }

 private:
  static constexpr std::size_t kChunk = 1U << 12;
  std::shared_ptr<const PlyHeader> header_;
  std::string name_;
  VertexLayout layout_;
  bool swap_;
  Walker walker_;
  std::vector<const std::byte*> starts_;
  const std::byte* end_ = nullptr;
};

/// Whether nothing is announced behind the vertices.
bool isLast(const PlyHeader& header, const PlyElement& vertex) {
  return std::all_of(header.elements.begin() + (&vertex - header.elements.data()) + 1,
                     header.elements.end(), [](const PlyElement& e) { return e.count == 0; });
}

BinaryColumns columnsOf(const VertexLayout& layout, const std::byte* data, bool swap) {
  BinaryColumns columns;
  columns.points = layout.vertex->count;
  const auto column = [&](std::size_t index) {
    std::size_t offset = 0;
    for (std::size_t p = 0; p < index; ++p) offset += sizeOf(layout.vertex->properties[p].type);
    return Column{data + offset, layout.vertex->fixedBytes(), layout.vertex->properties[index].type,
                  swap};
  };
  for (std::size_t axis = 0; axis < 3; ++axis) columns.xyz[axis] = column(layout.xyz[axis]);
  if (layout.colour) {
    const ThreeFields& c = *layout.colour;
    columns.colour = {column(c[0]), column(c[1]), column(c[2])};
  }
  return columns;
}

/// The data behind the elements that come before the vertices.
std::span<const std::byte> skipTo(const PlyHeader& header, const PlyElement& vertex,
                                  std::span<const std::byte> data, bool swap,
                                  const std::string& name) {
  for (const PlyElement* e = header.elements.data(); e != &vertex; ++e) {
    const std::size_t each = e->fixedBytes();
    if (each == 0 || e->count == 0) continue;
    if (e->count > data.size() / each) {
      throw InputError(fmt::format(
          "{}: truncated: the header announces {} of element '{}', only {} bytes follow", name,
          e->count, e->name, data.size()));
    }
    if (!e->hasLists()) {
      data = data.subspan(e->count * each);
      continue;
    }
    const Walker walker(*e, data.data() + data.size(), swap, name);
    const std::byte* from = data.data();
    for (std::uint64_t i = 0; i < e->count; ++i) from = walker.next(from, i);
    data = data.subspan(static_cast<std::size_t>(from - data.data()));
  }
  return data;
}

void openBinary(const std::shared_ptr<const PlyHeader>& header, const VertexLayout& layout,
                std::span<const std::byte> data, PointFile& file) {
  const std::string& name = file.name;
  const bool swap = header->format == PlyFormat::kBigEndian;
  data = skipTo(*header, *layout.vertex, data, swap, name);
  const PlyElement& vertex = *layout.vertex;
  const std::size_t each = vertex.fixedBytes();
  if (vertex.count > data.size() / each) {
    throw InputError(fmt::format(
        "{}: truncated: the header announces {} points of {}{} bytes, but only {} bytes follow "
        "({} points)",
        name, vertex.count, vertex.hasLists() ? "at least " : "", each, data.size(),
        data.size() / each));
  }
  if (vertex.hasLists()) {
    auto source = std::make_unique<ListedSource>(header, layout, data, swap, name);
    const auto rest = static_cast<std::size_t>(data.data() + data.size() - source->end());
    if (isLast(*header, vertex)) warnOfRest(rest, "bytes", file);
    file.source = std::move(source);
    return;
  }
  file.source = std::make_unique<BinarySource>(columnsOf(layout, data.data(), swap));
  if (isLast(*header, vertex)) warnOfRest(data.size() - vertex.count * each, "bytes", file);
}

std::vector<AsciiColumn> asciiColumns(const VertexLayout& layout) {
  using Use = AsciiColumn::Use;
  std::vector<AsciiColumn> columns;
  for (const PlyProperty& p : layout.vertex->properties) {
    columns.push_back({p.list_count ? Use::kList : Use::kSkip});
  }
  constexpr std::array kAxes{Use::kX, Use::kY, Use::kZ};
  constexpr std::array kChannels{Use::kRed, Use::kGreen, Use::kBlue};
  for (std::size_t c = 0; c < 3; ++c) {
    columns[layout.xyz[c]].use = kAxes[c];
    if (layout.colour) columns[(*layout.colour)[c]].use = kChannels[c];
  }
  return columns;
}

void openAscii(const PlyHeader& header, const VertexLayout& layout, std::string_view text,
               PointFile& file) {
  for (const PlyElement* e = header.elements.data(); e != layout.vertex; ++e) {
    for (std::uint64_t i = 0; i < e->count && !e->properties.empty(); ++i) {
      while (!text.empty() && splitWords(takeLine(text, header.line_end)).empty()) {
      }
      if (text.empty()) break;  // counted with the vertices' lines
    }
  }
  const bool last = isLast(header, *layout.vertex);
  AsciiLayout ascii{
      file.name,       text, layout.vertex->count, asciiColumns(layout), layout.colourKind(),
      header.line_end, last};
  ascii.file = file.file;
  auto source = std::make_unique<AsciiSource>(std::move(ascii));
  if (last) warnOfRest(source->extraLines(), "lines", file);
  file.source = std::move(source);
}

}  // namespace

PointFile openPly(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  const std::string_view text = withoutMark(file.text());
  const auto header = std::make_shared<const PlyHeader>(parsePlyHeader(text, name));
  const VertexLayout layout = vertexLayout(*header, name, options);
  const std::string_view body = text.substr(header->bytes);
  PointFile opened;
  opened.name = name;
  opened.file = &file;
  opened.fields = fieldsOf(*layout.vertex);
  if (header->format == PlyFormat::kAscii) {
    openAscii(*header, layout, body, opened);
  } else {
    openBinary(header, layout, std::as_bytes(std::span(body)), opened);
  }
  if (layout.partly_coloured) {
    opened.notes.push_back(fmt::format(
        "{}: its colours are incomplete (red, green and blue are needed); ignored", name));
  }
  if (!layout.colour && findField(layout.vertex->valueNames(), "f_dc_0", name)) {
    opened.notes.push_back(fmt::format(
        "{}: its points are Gaussian splats: their centres are not measured, and their colours "
        "(f_dc_0 ...) are not read; take the coloured point cloud made from the same pictures",
        name));
  }
  return opened;
}

}  // namespace agricolmap::io
