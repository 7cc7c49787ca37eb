#include "map_folder.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "agricolmap/core/error.hpp"

namespace agricolmap {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFormat = "agricolmap-map";
constexpr int kVersion = 1;
constexpr int kFixedCode = 1;

}  // namespace

std::optional<fs::path> MapFolder::layer(const std::string& name) const {
  fs::path path = folder / "layers" / (name + ".tif");
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return path;
}

nlohmann::json MapFolder::fixedSource() const {
  const auto sources = description.find("sources");
  if (sources == description.end() || !sources->is_array()) return nullptr;
  for (const nlohmann::json& source : *sources) {
    if (source.is_object() && source.value("code", nlohmann::json()) == kFixedCode) return source;
  }
  return nullptr;
}

MapFolder openMapFolder(const fs::path& folder) {
  const fs::path path = folder / "map.json";
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(fmt::format(
        "{}: has no map.json that can be read, so it is no shared map; agricolmap fuse makes one",
        folder.string()));
  }
  MapFolder map{folder, nlohmann::json::parse(file, nullptr, false)};
  const auto damaged = [&](const char* what) {
    return InputError(
        fmt::format("{}: {}; make the map anew with agricolmap fuse", path.string(), what));
  };
  if (map.description.is_discarded()) throw damaged("is damaged: no JSON");
  if (!map.description.is_object()) throw damaged("is damaged: no JSON object");
  if (map.description.value("format", nlohmann::json()) != kFormat) {
    throw damaged("does not say that it is an agricolmap-map");
  }
  const nlohmann::json version = map.description.value("format_version", nlohmann::json());
  if (!version.is_number_integer() || version < 1) throw damaged("has no version of its format");
  if (version > kVersion) {
    throw InputError(
        fmt::format("{}: is of version {}, and this program reads maps up to {}; update it",
                    path.string(), version.dump(), kVersion));
  }
  return map;
}

}  // namespace agricolmap
