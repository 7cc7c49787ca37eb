// PLY moved into PLY: all elements and properties stay.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/cloud/move_file.hpp"
#include "agricolmap/io/cloud/ply_header.hpp"
#include "agricolmap/io/cloud/record_move.hpp"
#include "agricolmap/io/cloud/text_move.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// The header with the coordinates' types changed to double, all else as it stands.
std::string withDoubles(std::string_view header, const std::array<std::string, 3>& names) {
  std::string out;
  bool in_vertices = false;
  while (!header.empty()) {
    const std::size_t end = std::min(header.find_first_of("\r\n"), header.size());
    const std::string_view line = header.substr(0, end);
    const std::vector<std::string_view> words = splitWords(line);
    if (words.size() >= 2 && words[0] == "element") in_vertices = isVertex(words[1]);
    const bool coordinate = in_vertices && words.size() == 3 && words[0] == "property" &&
                            std::find(names.begin(), names.end(), words[2]) != names.end();
    out += coordinate ? fmt::format("property double {}", words[2]) : std::string(line);
    const std::size_t ends = std::min(header.find_first_not_of("\r\n", end), header.size());
    out += header.substr(end, ends - end);
    header.remove_prefix(ends);
  }
  return out;
}

class PlyMove {
 public:
  PlyMove(const std::filesystem::path& from, const CloudMove& move)
      : name_(from.string()), file_(from), move_(move) {
    const std::string_view text = withoutMark(file_.text());
    header_ = parsePlyHeader(text, name_);
    head_ = text.substr(0, header_.bytes);
    body_ = text.substr(header_.bytes);
    const PlyElement& vertex = vertexOf(header_, name_);
    vertices_ = static_cast<std::size_t>(&vertex - header_.elements.data());
    for (const PlyProperty& p : vertex.properties) fields_.push_back({p.type, sizeOf(p.type)});
    points_ = {coordinatesOf(vertex, name_), findNormal(vertex.valueNames(), name_)};
  }

  /// Whether lists stand before the end of the vertices, of which only reading all tells how long
  /// they are.
  bool hidden() const {
    if (header_.format == PlyFormat::kAscii) return false;
    const auto end = header_.elements.begin() + static_cast<std::ptrdiff_t>(vertices_) + 1;
    return std::any_of(header_.elements.begin(), end,
                       [](const PlyElement& e) { return e.hasLists() && e.count > 0; });
  }

  CopiedCloud write(const OutputPath& to, const CopyProgress& progress) {
    copied_.points = vertices().count;
    noteOthers();
    FileSink sink(to);
    const MoveTally tally = header_.format == PlyFormat::kAscii ? writeText(sink, progress)
                                                                : writeBinary(sink, progress);
    sink.close();
    noteTally(tally, name_, copied_);
    return std::move(copied_);
  }

 private:
  const PlyElement& vertices() const { return header_.elements[vertices_]; }

  /// What stays as it is although it may be about places, too.
  void noteOthers() {
    for (const PlyElement& element : header_.elements) {
      const std::string name = lowerCase(element.name);
      if (element.count == 0 || name == "vertex" || name == "face" || name == "edge") continue;
      copied_.warnings.push_back(
          fmt::format("{}: its element '{}' is kept as it stands; places in it are not moved",
                      name_, element.name));
    }
    if (!points_.normal) return;
    const bool floating = std::all_of(points_.normal->begin(), points_.normal->end(),
                                      [&](std::size_t i) { return isFloating(fields_[i].type); });
    if (floating) return;
    points_.normal.reset();
    copied_.warnings.push_back(
        fmt::format("{}: its normals are integers, which are not turned", name_));
  }

  void writeHead(const PointMover& mover, FileSink& sink) {
    as_double_ = becomesDouble(fields_, points_, mover);
    if (as_double_) noteDouble(mover, name_, copied_);
    const auto& properties = vertices().properties;
    const auto nameOf = [&](std::size_t axis) { return properties[points_.xyz[axis]].name; };
    sink.write(as_double_ ? withDoubles(head_, {nameOf(0), nameOf(1), nameOf(2)})
                          : std::string(head_));
  }

  void writeRest(std::string_view rest, FileSink& sink) const {
    constexpr std::size_t kAtOnce = std::size_t{1} << 22;
    for (; !rest.empty(); rest.remove_prefix(std::min(kAtOnce, rest.size()))) {
      throwIfInterrupted();
      sink.write(rest.substr(0, kAtOnce));
      file_.release();
    }
  }

  static TextItem itemOf(const PlyElement& element) {
    TextItem item{element.name, {}};
    for (const PlyProperty& p : element.properties) item.lists.push_back(p.list_count.has_value());
    return item;
  }

  MoveTally writeText(FileSink& sink, const CopyProgress& progress) {
    std::string_view rest = body_;
    for (std::size_t e = 0; e < vertices_; ++e) {
      const PlyElement& element = header_.elements[e];
      takeItems(rest, itemOf(element), element.count, name_);
    }
    const TextItem item = itemOf(vertices());
    const std::size_t count = vertices().count;
    const PointMover mover(move_, samplesOf(rest, item, points_, count, name_));
    writeHead(mover, sink);
    sink.write(body_.substr(0, body_.size() - rest.size()));
    const MoveTally tally = writeMoved(rest, item, points_, count, mover, name_, sink, progress);
    writeRest(rest, sink);
    return tally;
  }

  MoveTally writeBinary(FileSink& sink, const CopyProgress& progress) {
    const bool swap = header_.format == PlyFormat::kBigEndian;
    std::size_t before = 0;
    for (std::size_t e = 0; e <= vertices_; ++e) {
      const PlyElement& element = header_.elements[e];
      const std::size_t each = std::max<std::size_t>(element.fixedBytes(), 1);
      if (element.count > (body_.size() - before) / each) {
        throw InputError(fmt::format(
            "{}: truncated: the header announces {} of element '{}' of {} bytes, but only {} bytes "
            "follow",
            name_, element.count, element.name, each, body_.size() - before));
      }
      if (e < vertices_) before += element.count * each;
    }
    const auto* const first = reinterpret_cast<const std::byte*>(body_.data()) + before;
    const std::size_t count = vertices().count;
    const RecordLayout same(fields_, points_, false, swap);
    const PointMover mover(move_, samplesOf(same, first, count));
    file_.release();
    writeHead(mover, sink);
    sink.write(body_.substr(0, before));
    const RecordLayout layout(fields_, points_, as_double_, swap);
    const MoveTally tally =
        writeMoved(layout, mover, first, count, sink, progress, [&] { file_.release(); });
    writeRest(body_.substr(before + count * layout.lengthBefore()), sink);
    return tally;
  }

  std::string name_;
  MappedFile file_;
  const CloudMove& move_;
  PlyHeader header_;
  std::string_view head_;
  std::string_view body_;
  std::size_t vertices_ = 0;  ///< which element they are
  std::vector<RecordField> fields_;
  PointFields points_;
  bool as_double_ = false;
  CopiedCloud copied_;
};

}  // namespace

std::optional<CopiedCloud> movePly(const std::filesystem::path& from, const OutputPath& to,
                                   const CloudMove& move, const CopyProgress& progress) {
  PlyMove ply(from, move);
  if (ply.hidden()) return std::nullopt;
  return ply.write(to, progress);
}

}  // namespace agricolmap::io
