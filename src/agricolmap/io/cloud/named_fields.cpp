#include "agricolmap/io/cloud/named_fields.hpp"

#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {

std::optional<std::size_t> findField(const std::vector<std::string_view>& names,
                                     std::string_view wanted, const std::string& file) {
  std::optional<std::size_t> found;
  for (const bool capitals : {false, true}) {
    if (found) break;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if ((capitals ? lowerCase(names[i]) : names[i]) != wanted) continue;
      if (found) throw InputError(fmt::format("{}: field '{}' is there twice", file, wanted));
      found = i;
    }
  }
  return found;
}

std::optional<ThreeFields> findFields(const std::vector<std::string_view>& names,
                                      const std::array<std::string_view, 3>& wanted,
                                      const std::string& file) {
  ThreeFields fields{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto field = findField(names, wanted[i], file);
    if (!field) return std::nullopt;
    fields[i] = *field;
  }
  return fields;
}

}  // namespace agricolmap::io
