// The formats of point clouds, told apart.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace agricolmap::io {

enum class CloudFormat {
  kPly,
  kPcd,
  kLas,
  kLaz,
  kCopc,
  kXyz,  ///< lines of text; read, never written
};

/// Whether a format is LAS: LAZ and COPC are, too.
bool isLas(CloudFormat format);
/// "ply", "copc.laz"
std::string endingOf(CloudFormat format);
/// Of those that are written, by the ending of a file's name, capitals or not; nothing where it is
/// another.
std::optional<CloudFormat> formatByEnding(const std::filesystem::path& path);
/// By the bytes of a file; nothing where it is no cloud. COPC is LAZ.
std::optional<CloudFormat> formatByContent(std::string_view bytes);

}  // namespace agricolmap::io
