#include "agricolmap/report/json/json_reader.hpp"

#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::report {
namespace {

constexpr int kVersion = 1;

}  // namespace

nlohmann::json readDocument(const std::filesystem::path& path, const DocumentKind& kind) {
  const std::string name = path.string();
  const io::MappedFile file(path);
  nlohmann::json json = nlohmann::json::parse(file.text(), nullptr, false);
  if (json.is_discarded()) {
    throw InputError(
        fmt::format("{}: damaged: is no JSON, or ends too early; {}", name, kind.remedy));
  }
  const JsonReader reader(json, name);
  if (!reader.has("format") || json["format"] != kind.format) {
    throw InputError(fmt::format("{}: is no {} ({})", name, kind.words, kind.format));
  }
  if (const int version = reader.at("format_version").integer(); version != kVersion) {
    throw InputError(fmt::format(
        "{}: is of format version {}, and this program knows version {}; use the version of "
        "agricolmap that wrote it, or a newer one",
        name, version, kVersion));
  }
  return json;
}

}  // namespace agricolmap::report
