#include "agricolmap/io/las/las_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

using Bytes = std::span<const std::byte>;

/// Sizes of the header by version, and of what precedes the data of a record.
constexpr std::size_t kHeader = 227;
constexpr std::size_t kHeader14 = 375;
constexpr std::size_t kRecordHeader = 54;
constexpr std::size_t kExtendedRecordHeader = 60;

/// Text of fixed size that ends at its first zero; what is not printable becomes '?'.
std::string textAt(const std::byte* from, std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i < size && from[i] != std::byte{0}; ++i) {
    const auto c = std::to_integer<char>(from[i]);
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  return text;
}

class Parser {
 public:
  Parser(Bytes bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  LasHeader parse() {
    readVersion();
    readFormat();
    readCounts();
    readTransform();
    readRecords();
    if (header_.minor >= 4) readExtendedRecords();
    if (!header_.compressed) checkPoints();
    return std::move(header_);
  }

 private:
  template <typename T>
  T at(std::size_t offset) const {
    return loadLe<T>(bytes_.data() + offset);
  }
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(name_ + ": " + fmt::format(format, std::forward<Args>(args)...));
  }
  template <typename... Args>
  void warn(fmt::format_string<Args...> format, Args&&... args) {
    header_.warnings.push_back(name_ + ": " + fmt::format(format, std::forward<Args>(args)...));
  }

  void readVersion() {
    if (bytes_.size() < kHeader) {
      fail("truncated: the header of LAS takes at least {} bytes, the file has {}", kHeader,
           bytes_.size());
    }
    const int major = at<std::uint8_t>(24);
    header_.minor = at<std::uint8_t>(25);
    if (major != 1 || header_.minor > 5) {
      fail("is LAS of version {}.{}; known are 1.0 to 1.5", major, header_.minor);
    }
    header_.flags = header_.minor >= 2 ? at<std::uint16_t>(6) : std::uint16_t{0};
    header_.size = at<std::uint16_t>(94);
    const std::size_t least = header_.minor >= 4 ? kHeader14 : kHeader;
    if (header_.size < least) {
      fail("its header says that it takes {} bytes; LAS 1.{} has at least {}", header_.size,
           header_.minor, least);
    }
    header_.points_begin = at<std::uint32_t>(96);
    if (header_.points_begin < header_.size) {
      fail("its points begin at byte {}, within the header of {} bytes", header_.points_begin,
           header_.size);
    }
    if (header_.points_begin > bytes_.size()) {
      fail("truncated: its points begin at byte {}, the file has {}", header_.points_begin,
           bytes_.size());
    }
  }

  void readFormat() {
    const unsigned format = at<std::uint8_t>(104);
    constexpr unsigned kCompressed = 0xC0;  // one of the two highest bits
    header_.compressed = (format & kCompressed) != 0;
    const int number = static_cast<int>(format & ~kCompressed);
    if (number >= kLasFormats) {
      fail("its points have the format {}; known are 0 to {}", number, kLasFormats - 1);
    }
    header_.layout = lasLayout(number);
    const std::size_t length = at<std::uint16_t>(105);
    if (length < header_.layout.base) {
      fail("its points take {} bytes each; points of format {} have at least {}", length, number,
           header_.layout.base);
    }
    header_.layout.length = length;
  }

  void readCounts() {
    const std::uint64_t legacy = at<std::uint32_t>(107);
    header_.points = legacy;
    if (header_.minor >= 4) {
      const auto count = at<std::uint64_t>(247);
      if (count != 0) header_.points = count;
      if (count != legacy && legacy != 0) {
        warn("its header announces {} points and {} points; taken are {}", legacy, count,
             header_.points);
      }
    }
    if (header_.points == 0) fail("empty cloud: its header announces 0 points");
  }

  void readTransform() {
    constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto scale = at<double>(131 + 8 * axis);
      const auto offset = at<double>(155 + 8 * axis);
      if (!std::isfinite(scale) || scale == 0.0 || !std::isfinite(offset)) {
        fail("{} has the scale {} and the offset {}, which make no coordinate", kAxes[axis], scale,
             offset);
      }
      header_.scale[static_cast<Eigen::Index>(axis)] = scale;
      header_.offset[static_cast<Eigen::Index>(axis)] = offset;
    }
  }

  void readRecords() {
    const auto announced = at<std::uint32_t>(100);
    std::size_t from = header_.size;
    for (std::uint32_t i = 0; i < announced; ++i) {
      const std::size_t room = header_.points_begin - from;
      const std::size_t size = room < kRecordHeader ? 0 : at<std::uint16_t>(from + 20);
      if (room < kRecordHeader || size > room - kRecordHeader) {
        warn("its header announces {} variable length records, only {} lie before the points",
             announced, i);
        return;
      }
      header_.records.push_back({textAt(&bytes_[from + 2], 16), at<std::uint16_t>(from + 18),
                                 textAt(&bytes_[from + 22], 32),
                                 bytes_.subspan(from + kRecordHeader, size), false});
      from += kRecordHeader + size;
    }
  }

  void readExtendedRecords() {
    const auto announced = at<std::uint32_t>(243);
    auto from = at<std::uint64_t>(235);
    for (std::uint32_t i = 0; i < announced; ++i) {
      const bool fits =
          from >= header_.points_begin && from <= bytes_.size() &&
          bytes_.size() - from >= kExtendedRecordHeader &&
          at<std::uint64_t>(from + 20) <= bytes_.size() - from - kExtendedRecordHeader;
      if (!fits) {
        warn(
            "its header announces {} extended variable length records, only {} lie within the "
            "file",
            announced, i);
        return;
      }
      const auto size = static_cast<std::size_t>(at<std::uint64_t>(from + 20));
      header_.records.push_back({textAt(&bytes_[from + 2], 16), at<std::uint16_t>(from + 18),
                                 textAt(&bytes_[from + 28], 32),
                                 bytes_.subspan(from + kExtendedRecordHeader, size), true});
      from += kExtendedRecordHeader + size;
    }
  }

  void checkPoints() const {
    const std::size_t rest = bytes_.size() - header_.points_begin;
    if (header_.points > rest / header_.layout.length) {
      fail(
          "truncated: the header announces {} points of {} bytes, but only {} bytes follow ({} "
          "points)",
          header_.points, header_.layout.length, rest, rest / header_.layout.length);
    }
  }

  Bytes bytes_;
  const std::string& name_;
  LasHeader header_;
};

}  // namespace

const LasRecord* LasHeader::find(std::string_view user, std::uint16_t id) const {
  const auto it = std::find_if(records.begin(), records.end(), [&](const LasRecord& record) {
    return record.id == id && record.user == user;
  });
  return it == records.end() ? nullptr : &*it;
}

bool looksLikeLas(std::string_view text) { return text.starts_with("LASF"); }

LasHeader parseLasHeader(std::span<const std::byte> bytes, const std::string& name) {
  return Parser(bytes, name).parse();
}

}  // namespace agricolmap::io
