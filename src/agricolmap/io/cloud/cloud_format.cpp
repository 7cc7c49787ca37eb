#include "agricolmap/io/cloud/cloud_format.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// What ends like another's ending before that.
constexpr std::array kFormats{CloudFormat::kPly, CloudFormat::kPcd, CloudFormat::kLas,
                              CloudFormat::kCopc, CloudFormat::kLaz};

bool looksLikePly(std::string_view text) {
  return text.starts_with("ply\n") || text.starts_with("ply\r\n");
}

/// The first line that is no comment tells.
bool looksLikePcd(std::string_view text) {
  constexpr std::size_t kMaxLines = 100;
  for (std::size_t line = 0; line < kMaxLines && !text.empty(); ++line) {
    std::string_view rest = takeLine(text);
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

std::string endingOf(CloudFormat format) {
  switch (format) {
    case CloudFormat::kPcd:
      return "pcd";
    case CloudFormat::kLas:
      return "las";
    case CloudFormat::kLaz:
      return "laz";
    case CloudFormat::kCopc:
      return "copc.laz";
    case CloudFormat::kPly:
      break;
  }
  return "ply";
}

std::optional<CloudFormat> formatByEnding(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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
  if (looksLikePly(bytes)) return CloudFormat::kPly;
  if (looksLikePcd(bytes.substr(0, 1U << 16))) return CloudFormat::kPcd;
  if (looksLikeLas(bytes)) return isCompressedLas(bytes) ? CloudFormat::kLaz : CloudFormat::kLas;
  return std::nullopt;
}

}  // namespace agricolmap::io
