// What a point has, found by name: the properties of PLY and the fields of PCD.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace agricolmap::io {

using ThreeFields = std::array<std::size_t, 3>;

/// Where the field of this name is, or, where there is none, the one of this name with capitals.
/// The names of fields that are no single values are empty. Throws InputError when there are two.
std::optional<std::size_t> findField(const std::vector<std::string_view>& names,
                                     std::string_view wanted, const std::string& file);
/// Three of them; nothing where one is missing.
std::optional<ThreeFields> findFields(const std::vector<std::string_view>& names,
                                      const std::array<std::string_view, 3>& wanted,
                                      const std::string& file);

}  // namespace agricolmap::io
