#include "agricolmap/io/cloud/cloud_format.hpp"

#include <array>

#include "agricolmap/io/cloud/xyz_columns.hpp"
#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/text/foreign_file.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kFirstLines = 1U << 16;
/// Those that are written; what ends like another's ending before that.
constexpr std::array kFormats{CloudFormat::kPly, CloudFormat::kPcd, CloudFormat::kLas,
                              CloudFormat::kCopc, CloudFormat::kLaz};

bool looksLikePly(std::string_view text) {
  std::string_view line = takeLine(text, lineEndOf(text));
  return takeWord(line) == "ply" && takeWord(line).empty();
}

/// The first line that is no comment tells.
bool looksLikePcd(std::string_view text) {
  constexpr std::size_t kMaxLines = 100;
  const char line_end = lineEndOf(text);
  for (std::size_t line = 0; line < kMaxLines && !text.empty(); ++line) {
    std::string_view rest = takeLine(text, line_end);
    const std::string_view word = takeWord(rest);
    if (word.empty() || word.starts_with('#')) continue;
    return word == "VERSION" || word == "FIELDS" || word == "COLUMNS";
  }
  return false;
}

bool isCompressedLas(std::string_view bytes) {
  constexpr std::size_t kFormat = 104;
  constexpr int kCompressed = 0xC0;
  return bytes.size() > kFormat && (static_cast<int>(bytes[kFormat]) & kCompressed) != 0;
}

}  // namespace

bool isLas(CloudFormat format) {
  return format == CloudFormat::kLas || format == CloudFormat::kLaz || format == CloudFormat::kCopc;
}

std::string endingOf(CloudFormat format) {
  switch (format) {
    case CloudFormat::kPcd:
      return "pcd";
    case CloudFormat::kLas:
      return "las";
    case CloudFormat::kLaz:
      return "laz";
    case CloudFormat::kXyz:
      return "xyz";
    case CloudFormat::kCopc:
      return "copc.laz";
    case CloudFormat::kPly:
      break;
  }
  return "ply";
}

std::optional<CloudFormat> formatByEnding(const std::filesystem::path& path) {
  const std::string name = lowerCase(path.filename().string());
  for (const CloudFormat format : kFormats) {
    const std::string ending = endingOf(format);
    if (name.size() > ending.size() && name.ends_with(ending) &&
        name[name.size() - ending.size() - 1] == '.') {
      return format;
    }
  }
  return std::nullopt;
}

std::optional<CloudFormat> formatByContent(std::string_view bytes) {
  const std::string_view text = withoutMark(bytes).substr(0, kFirstLines);
  if (looksLikePly(text)) return CloudFormat::kPly;
  if (looksLikePcd(text)) return CloudFormat::kPcd;
  if (looksLikeLas(bytes)) return isCompressedLas(bytes) ? CloudFormat::kLaz : CloudFormat::kLas;
  // Others have lines of numbers, too.
  if (looksLikeXyz(text) && describeForeign(text).empty() && !looksLikeMatrix(bytes)) {
    return CloudFormat::kXyz;
  }
  return std::nullopt;
}

}  // namespace agricolmap::io
