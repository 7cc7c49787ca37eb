#include "agricolmap/io/text/foreign_file.hpp"

#include <algorithm>
#include <fstream>
#include <ios>

#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kLooked = 4096;

struct Signature {
  std::string_view begin;
  std::string_view what;
};

// NUL bytes are parts of signatures, hence literals with lengths.
using std::string_view_literals::operator""sv;

constexpr std::string_view kCloud = "write it as LAS, LAZ, PLY or PCD";

/// Told by the first bytes alone. Ends with a remedy, or with ": " where kCloud is one.
constexpr Signature kSignatures[] = {
    {"version https://git-lfs"sv,
     "it is a pointer of Git LFS, not the file itself; fetch it with git lfs pull"},
    {"\x1f\x8b"sv, "it is compressed by gzip; unpack a copy with gunzip -k"},
    {"BZh"sv, "it is compressed by bzip2; unpack a copy with bunzip2 -k"},
    {"\xFD"
     "7zXZ"sv,
     "it is compressed by xz; unpack a copy with unxz -k"},
    {"\x28\xB5\x2F\xFD"sv, "it is compressed by zstd; unpack a copy with unzstd"},
    {"PK\x03\x04"sv,
     "it is a zip archive (KMZ and LCC are, too); unpack it and take what is in it"},
    {"7z\xBC\xAF\x27\x1C"sv, "it is a 7z archive; unpack it and take what is in it"},
    {"Rar!"sv, "it is a rar archive; unpack it and take what is in it"},
    {"ASTM-E57"sv, "it is E57: "},
    {"#ROSBAG"sv, "it is a ROS bag: write the map that was made from it as PCD or PLY"},
    {"\x89MCAP0"sv, "it is an MCAP recording: write the map that was made from it as PCD or PLY"},
    {"SQLite format 3"sv,
     "it is an SQLite database (ROS 2 bags and GeoPackages are): write the map as LAS, PLY or PCD"},
    {"\x89HDF\r\n"sv, "it is HDF5: "},
    {"solid "sv, "it is an STL surface, which has no colours: "},
    {"# vtk DataFile"sv, "it is VTK: "},
    {"glTF"sv, "it is glTF: "},
    {"Kaydara FBX"sv, "it is FBX: "},
    {"pnts"sv, "it is a tile of 3D Tiles: "},
    {"b3dm"sv, "it is a tile of 3D Tiles: "},
    {"DRACO"sv, "it is compressed by Draco: "},
    {"II*\0"sv, "it is a TIFF raster; an orthomosaic is taken as ORTHO.tif,DSM.tif"},
    {"MM\0*"sv, "it is a TIFF raster; an orthomosaic is taken as ORTHO.tif,DSM.tif"},
    {"II+\0"sv, "it is a TIFF raster; an orthomosaic is taken as ORTHO.tif,DSM.tif"},
    {"MM\0+"sv, "it is a TIFF raster; an orthomosaic is taken as ORTHO.tif,DSM.tif"},
    {"\x89PNG"sv, "it is a PNG picture, which does not say where it lies"},
    {"\xFF\xD8\xFF"sv, "it is a JPEG picture, which does not say where it lies"},
    {"%PDF"sv, "it is a PDF document"},
    {"\xFF\xFE"sv, "it is text in UTF-16; write it as UTF-8 (iconv -f UTF-16 -t UTF-8)"},
    {"\xFE\xFF"sv, "it is text in UTF-16; write it as UTF-8 (iconv -f UTF-16 -t UTF-8)"},
    {"\x7F"
     "ELF"sv,
     "it is a program"},
};

bool isWebPage(std::string_view text) {
  const std::string begin = lowerCase(text.substr(0, 256));
  const std::size_t at = begin.find_first_not_of(" \t\r\n");
  if (at == std::string::npos) return false;
  const std::string_view rest = std::string_view(begin).substr(at);
  return rest.starts_with("<!doctype html") || rest.starts_with("<html") ||
         rest.starts_with("<head");
}

/// Vertices or the library of materials, after comments.
bool isObj(std::string_view text) {
  constexpr int kMostLines = 50;
  for (int line = 0; line < kMostLines && !text.empty(); ++line) {
    std::string_view rest = takeLine(text, lineEndOf(text));
    const std::string_view word = takeWord(rest);
    if (word.empty() || word.starts_with('#') || word == "o" || word == "g") continue;
    return word == "v" || word == "vn" || word == "mtllib";
  }
  return false;
}

std::string_view lookInside(std::string_view text) {
  if (isWebPage(text)) {
    return "it is a web page, as servers send in place of a file; download the file itself again";
  }
  if (text.starts_with("<?xml")) {
    if (text.find("<Error>") != std::string_view::npos) {
      return "it is a server's error message in XML; download the file itself again";
    }
    if (text.find("<VRTDataset") != std::string_view::npos) return "it is a virtual raster of GDAL";
    return "it is XML";
  }
  if (text.starts_with("<VRTDataset")) return "it is a virtual raster of GDAL";
  if (isObj(text)) return "it is a surface in OBJ: ";
  if (text.find_first_not_of('\0') == std::string_view::npos) {
    return "there is nothing but zeros in it, as an interrupted copy leaves; copy it again";
  }
  return {};
}

}  // namespace

std::string describeForeign(std::string_view bytes) {
  bytes = bytes.substr(0, kLooked);
  std::string_view what;
  for (const Signature& signature : kSignatures) {
    if (what.empty() && bytes.starts_with(signature.begin)) what = signature.what;
  }
  if (what.empty()) what = lookInside(bytes);
  std::string text(what);
  if (text.ends_with(": ")) text += kCloud;
  return text;
}

std::string describeForeignFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kLooked, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes.empty() ? "" : describeForeign(bytes);
}

}  // namespace agricolmap::io
