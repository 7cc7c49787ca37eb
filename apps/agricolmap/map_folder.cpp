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

/// What map.json says of the drone's map that all hangs on; null where it says nothing. How many of
/// its points the fused cloud took differs with the strips.
nlohmann::json fixedSource(const nlohmann::json& description) {
  const auto sources = description.find("sources");
  if (sources == description.end() || !sources->is_array()) return nullptr;
  for (const nlohmann::json& source : *sources) {
    if (!source.is_object() || source.value("code", nlohmann::json()) != kFixedCode) continue;
    nlohmann::json named;
    for (const char* key : {"file", "date", "points"}) {
      named[key] = source.value(key, nlohmann::json());
    }
    return named;
  }
  return nullptr;
}

}  // namespace

std::optional<fs::path> MapFolder::layer(const std::string& name) const {
  fs::path path = folder / "layers" / (name + ".tif");
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return path;
}

bool MapFolder::hasFixedOf(const MapFolder& other) const {
  const nlohmann::json own = fixedSource(description);
  return !own.is_null() && own == fixedSource(other.description);
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
