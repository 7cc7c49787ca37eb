#include "agricolmap/io/cloud/pcd_reader.hpp"

#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/ascii_source.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kMaxHeaderBytes = 1U << 20;
constexpr std::uint64_t kMaxValues = 1U << 20;
/// LZF repeats at most 264 bytes from 3.
constexpr std::uint64_t kMaxExpansion = 88;

struct Field {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  std::uint64_t count = 1;
  std::size_t bytes() const { return count * sizeOf(type); }
};

enum class Encoding { kAscii, kBinary, kCompressed };

struct Header {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  Encoding encoding = Encoding::kAscii;
  std::size_t bytes = 0;  ///< length of the header: the data begin here

  std::size_t pointBytes() const {
    std::size_t sum = 0;
    for (const Field& field : fields) sum += field.bytes();
    return sum;
  }
};

/// Parses line by line; keeps the place for messages.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name)
      : text_(text), rest_(text.substr(0, kMaxHeaderBytes)), name_(name) {}

  Header parse() {
    while (!done_) {
      if (rest_.empty()) fail("the header has no DATA line");
      ++line_;
      const std::vector<std::string_view> words = splitWords(takeLine(rest_));
      if (!words.empty() && !words[0].starts_with('#')) parseLine(words);
    }
    header_.bytes = static_cast<std::size_t>(rest_.data() - text_.data());
    makeFields();
    checkCounts();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", name_, line_, what));
  }

  std::uint64_t countOf(std::string_view word) const {
    const auto value = parseInteger(word);
    if (!value || *value < 0) fail(fmt::format("'{}' is no count", word));
    return static_cast<std::uint64_t>(*value);
  }

  void parseLine(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    const auto one = [&] {
      if (values.size() != 1) fail(fmt::format("{} needs one value", key));
      return values[0];
    };
    if (key == "VERSION") {
      if (one() != "0.7" && one() != ".7") fail(fmt::format("unknown PCD version '{}'", one()));
    } else if (key == "FIELDS" || key == "COLUMNS") {
      names_ = values;
    } else if (key == "SIZE") {
      sizes_ = values;
    } else if (key == "TYPE") {
      types_ = values;
    } else if (key == "COUNT") {
      counts_ = values;
    } else if (key == "WIDTH") {
      width_ = countOf(one());
    } else if (key == "HEIGHT") {
      height_ = countOf(one());
    } else if (key == "POINTS") {
      points_ = countOf(one());
    } else if (key == "DATA") {
      parseEncoding(one());
    } else if (key != "VIEWPOINT") {
      fail(fmt::format("unknown entry '{}'", key));
    }
  }

  void parseEncoding(std::string_view word) {
    if (word == "ascii") {
      header_.encoding = Encoding::kAscii;
    } else if (word == "binary") {
      header_.encoding = Encoding::kBinary;
    } else if (word == "binary_compressed") {
      header_.encoding = Encoding::kCompressed;
    } else {
      fail(fmt::format("unknown encoding '{}'", word));
    }
    done_ = true;
  }

  ScalarType typeOf(std::string_view kind, std::string_view size) const {
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 10> kTypes{{
        {"I1", ScalarType::kInt8},
        {"U1", ScalarType::kUint8},
        {"I2", ScalarType::kInt16},
        {"U2", ScalarType::kUint16},
        {"I4", ScalarType::kInt32},
        {"U4", ScalarType::kUint32},
        {"I8", ScalarType::kInt64},
        {"U8", ScalarType::kUint64},
        {"F4", ScalarType::kFloat32},
        {"F8", ScalarType::kFloat64},
    }};
    const std::string word = std::string(kind) + std::string(size);
    for (const auto& [type_name, type] : kTypes) {
      if (type_name == word) return type;
    }
    fail(fmt::format("unknown TYPE {} of SIZE {}", kind, size));
  }

  void makeFields() {
    const std::size_t n = names_.size();
    if (n == 0) fail("the header has no FIELDS");
    if (sizes_.size() != n || types_.size() != n || (!counts_.empty() && counts_.size() != n)) {
      fail("FIELDS, SIZE, TYPE and COUNT have different numbers of entries");
    }
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < n; ++i) {
      Field field;
      field.name = names_[i];
      field.type = typeOf(types_[i], sizes_[i]);
      if (!counts_.empty()) field.count = countOf(counts_[i]);
      total += field.count;
      if (field.count > kMaxValues || total > kMaxValues) {
        fail(fmt::format("more than {} values a point", kMaxValues));
      }
      const auto same = [&](const Field& f) { return f.name == field.name; };
      if (field.name != "_" && std::any_of(header_.fields.begin(), header_.fields.end(), same)) {
        fail(fmt::format("field '{}' is there twice", field.name));
      }
      header_.fields.push_back(std::move(field));
    }
  }

  void checkCounts() {
    if (width_ && height_) {
      if (*height_ != 0 && *width_ > std::numeric_limits<std::uint64_t>::max() / *height_) {
        fail(fmt::format("absurd size {} x {}", *width_, *height_));
      }
      const std::uint64_t area = *width_ * *height_;
      if (points_ && *points_ != area) {
        fail(fmt::format("POINTS is {}, but WIDTH x HEIGHT is {} x {}", *points_, *width_,
                         *height_));
      }
      points_ = area;
    }
    if (!points_) fail("the header has neither POINTS nor WIDTH and HEIGHT");
    if (*points_ == 0) throw InputError(fmt::format("{}: empty cloud: 0 points", name_));
    header_.points = *points_;
  }

  std::string_view text_;
  std::string_view rest_;
  const std::string& name_;
  std::size_t line_ = 0;
  bool done_ = false;
  Header header_;
  std::vector<std::string_view> names_;
  std::vector<std::string_view> sizes_;
  std::vector<std::string_view> types_;
  std::vector<std::string_view> counts_;
  std::optional<std::uint64_t> width_;
  std::optional<std::uint64_t> height_;
  std::optional<std::uint64_t> points_;
};

/// Which fields hold what.
struct Roles {
  std::array<std::size_t, 3> xyz{};
  std::optional<std::array<std::size_t, 3>> colour;
  std::optional<std::size_t> packed;
};

std::optional<std::size_t> findField(const Header& header, std::string_view name) {
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    if (header.fields[i].name == name && header.fields[i].count == 1) return i;
  }
  return std::nullopt;
}

std::optional<std::array<std::size_t, 3>> findThree(const Header& header,
                                                    const std::array<std::string_view, 3>& names) {
  std::array<std::size_t, 3> indices{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto index = findField(header, names[c]);
    if (!index) return std::nullopt;
    indices[c] = *index;
  }
  return indices;
}

Roles findRoles(const Header& header, const std::string& name, const ReadOptions& options) {
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
BinaryColumns columnsOf(const Header& header, const Roles& roles, const std::byte* data,
                        bool interleaved) {
  const auto column = [&](std::size_t index) {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < index; ++i) offset += header.fields[i].bytes();
    const Field& field = header.fields[index];
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

std::uint64_t checkedBytes(const Header& header, std::uint64_t available, const std::string& name) {
  const std::size_t each = std::max<std::size_t>(header.pointBytes(), 1);  // x, y, z at least
  if (header.points > available / each) {
    throw InputError(fmt::format(
        "{}: truncated: the header announces {} points of {} bytes, but only {} bytes follow ({} "
        "points)",
        name, header.points, each, available, available / each));
  }
  return header.points * each;
}

/// `rest` gets the number of bytes that follow.
std::vector<std::byte> decompress(const Header& header, std::span<const std::byte> data,
                                  const std::string& name, std::size_t& rest) {
  std::array<std::uint32_t, 2> sizes{};
  if (data.size() < sizeof(sizes)) {
    throw InputError(fmt::format("{}: truncated: no compressed data follow the header", name));
  }
  std::memcpy(sizes.data(), data.data(), sizeof(sizes));
  data = data.subspan(sizeof(sizes));
  const auto [compressed, plain] = sizes;
  if (compressed > data.size()) {
    throw InputError(fmt::format("{}: truncated: {} bytes of compressed data announced, {} follow",
                                 name, compressed, data.size()));
  }
  // Checked before anything is allocated on the file's word.
  if (plain > kMaxExpansion * compressed) {
    throw InputError(
        fmt::format("{}: damaged: {} bytes cannot expand to {}", name, compressed, plain));
  }
  if (checkedBytes(header, plain, name) != plain) {
    throw InputError(fmt::format("{}: {} bytes of data for {} points of {} bytes", name, plain,
                                 header.points, header.pointBytes()));
  }
  rest = data.size() - compressed;
  std::vector<std::byte> out(plain);
  if (lzf_decompress(data.data(), compressed, out.data(), plain) != plain) {
    throw InputError(fmt::format("{}: the compressed data are damaged", name));
  }
  return out;
}

/// Points that were decompressed as a whole.
class DecompressedSource : public BinarySource {
 public:
  DecompressedSource(std::vector<std::byte> bytes, const BinaryColumns& columns)
      : BinarySource(columns), bytes_(std::move(bytes)) {}

 private:
  std::vector<std::byte> bytes_;  ///< what the columns look into
};

void openAscii(const Header& header, const Roles& roles, std::string_view text, PointFile& file) {
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
  layout.points = header.points;
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

void openData(const Header& header, const Roles& roles, const MappedFile& mapped, PointFile& file) {
  const std::span<const std::byte> data = mapped.bytes().subspan(header.bytes);
  switch (header.encoding) {
    case Encoding::kAscii:
      openAscii(header, roles, mapped.text().substr(header.bytes), file);
      return;
    case Encoding::kBinary: {
      const std::uint64_t used = checkedBytes(header, data.size(), file.name);
      file.source = std::make_unique<BinarySource>(columnsOf(header, roles, data.data(), true));
      warnOfRest(data.size() - used, "bytes", file);
      return;
    }
    case Encoding::kCompressed:
      break;
  }
  std::size_t rest = 0;
  std::vector<std::byte> plain = decompress(header, data, file.name, rest);
  const BinaryColumns columns = columnsOf(header, roles, plain.data(), false);
  file.source = std::make_unique<DecompressedSource>(std::move(plain), columns);
  warnOfRest(rest, "bytes", file);
}

}  // namespace

PointFile openPcd(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  const Header header = Parser(file.text(), name).parse();
  PointFile opened;
  opened.name = name;
  openData(header, findRoles(header, name, options), file, opened);
  std::vector<std::string> names;
  for (const Field& field : header.fields) names.push_back(field.name);
  opened.fields = fieldList(names);
  return opened;
}

}  // namespace agricolmap::io
