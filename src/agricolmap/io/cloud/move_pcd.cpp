// PCD moved into PCD: all fields stay.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/move_file.hpp"
#include "agricolmap/io/cloud/pcd_data.hpp"
#include "agricolmap/io/cloud/record_move.hpp"
#include "agricolmap/io/cloud/text_move.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

char letterOf(ScalarType type) {
  switch (type) {
    case ScalarType::kFloat32:
    case ScalarType::kFloat64:
      return 'F';
    case ScalarType::kInt8:
    case ScalarType::kInt16:
    case ScalarType::kInt32:
    case ScalarType::kInt64:
      return 'I';
    default:
      break;
  }
  return 'U';
}

class PcdMove {
 public:
  PcdMove(const std::filesystem::path& from, const CloudMove& move)
      : name_(from.string()), file_(from), move_(move) {
    const std::string_view text = withoutMark(file_.text());
    header_ = parsePcdHeader(text, name_);
    head_ = text.substr(0, header_.bytes);
    body_ = text.substr(header_.bytes);
    for (const PcdField& field : header_.fields) fields_.push_back({field.type, field.bytes()});
    points_ = {coordinatesOf(header_, name_), findNormal(header_.valueNames(), name_)};
  }

  CopiedCloud write(const OutputPath& to, const CopyProgress& progress) {
    copied_.points = header_.points;
    FileSink sink(to);
    const MoveTally tally = header_.encoding == PcdEncoding::kAscii ? writeText(sink, progress)
                                                                    : writeBinary(sink, progress);
    sink.close();
    noteTally(tally, name_, copied_);
    return std::move(copied_);
  }

 private:
  /// The header line by line, with the types that coordinates have now.
  std::string headOf(const PointMover& mover) {
    as_double_ = becomesDouble(fields_, points_, mover);
    if (as_double_) noteDouble(mover, name_, copied_);
    std::string out;
    for (std::string_view rest = head_; !rest.empty();) {
      const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
      const std::string_view line = rest.substr(0, end);
      const std::size_t behind = std::min(rest.find_first_not_of("\r\n", end), rest.size());
      rest.remove_prefix(behind);
      const std::vector<std::string_view> words = splitWords(line);
      const std::string_view key = words.empty() ? std::string_view() : words[0];
      if (key == "SIZE" || key == "TYPE") continue;
      if (key == "VIEWPOINT" && header_.hasPose()) {
        copied_.warnings.push_back(fmt::format(
            "{}: its VIEWPOINT is not taken along, as programs differ in what they mean by it",
            name_));
        out += "VIEWPOINT 0 0 0 1 0 0 0\n";
        continue;
      }
      if (key == "DATA" && header_.encoding == PcdEncoding::kCompressed) {
        out += "DATA binary\n";
        continue;
      }
      out += std::string(line) + "\n";
      if (key == "FIELDS" || key == "COLUMNS") out += typeLines();
    }
    return out;
  }

  std::string typeLines() const {
    std::string sizes = "SIZE";
    std::string types = "TYPE";
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const bool coordinate =
          std::find(points_.xyz.begin(), points_.xyz.end(), i) != points_.xyz.end();
      const ScalarType type =
          coordinate && as_double_ ? ScalarType::kFloat64 : header_.fields[i].type;
      sizes += fmt::format(" {}", sizeOf(type));
      types += fmt::format(" {}", letterOf(type));
    }
    return sizes + "\n" + types + "\n";
  }

  MoveTally writeText(FileSink& sink, const CopyProgress& progress) {
    std::string_view rest = body_;
    TextItem item{"point", {}};
    std::vector<std::size_t> word_of;  // the first word of a field
    for (const PcdField& field : header_.fields) {
      word_of.push_back(item.lists.size());
      item.lists.insert(item.lists.end(), field.count, false);
    }
    PointFields words = points_;
    for (std::size_t& index : words.xyz) index = word_of[index];
    if (words.normal) {
      for (std::size_t& index : *words.normal) index = word_of[index];
    }
    const PointMover mover(move_, samplesOf(rest, item, words, header_.points, name_));
    sink.write(headOf(mover));
    const MoveTally tally =
        writeMoved(rest, item, words, header_.points, mover, name_, sink, progress);
    sink.write(rest);
    return tally;
  }

  /// Point after point, of what binary_compressed keeps field after field.
  std::vector<std::byte> interleaved(const std::vector<std::byte>& plain) const {
    std::vector<std::byte> records(plain.size());
    const std::size_t length = header_.pointBytes();
    std::size_t offset = 0;
    for (const RecordField& field : fields_) {
      const std::byte* from = plain.data() + offset * header_.points;
      for (std::size_t i = 0; i < header_.points; ++i, from += field.bytes) {
        std::copy_n(from, field.bytes, &records[i * length + offset]);
      }
      offset += field.bytes;
    }
    return records;
  }

  MoveTally writeBinary(FileSink& sink, const CopyProgress& progress) {
    std::span<const std::byte> data = std::as_bytes(std::span(body_));
    std::vector<std::byte> records;
    if (header_.encoding == PcdEncoding::kCompressed) {
      std::size_t rest = 0;
      records = interleaved(decompressPcd(header_, data, name_, rest));
      data = records;
    }
    pcdBytes(header_, data.size(), name_);
    const RecordLayout same(fields_, points_, false, false);
    const PointMover mover(move_, samplesOf(same, data.data(), header_.points));
    file_.release();
    sink.write(headOf(mover));
    const RecordLayout layout(fields_, points_, as_double_, false);
    return writeMoved(layout, mover, data.data(), header_.points, sink, progress,
                      [&] { file_.release(); });
  }

  std::string name_;
  MappedFile file_;
  const CloudMove& move_;
  PcdHeader header_;
  std::string_view head_;
  std::string_view body_;
  std::vector<RecordField> fields_;
  PointFields points_;
  bool as_double_ = false;
  CopiedCloud copied_;
};

}  // namespace

CopiedCloud movePcd(const std::filesystem::path& from, const OutputPath& to, const CloudMove& move,
                    const CopyProgress& progress) {
  return PcdMove(from, move).write(to, progress);
}

}  // namespace agricolmap::io
