// One hash for random streams by name and to tell options apart.
#pragma once

#include <cstdint>
#include <string_view>

namespace agricolmap::experiments {

/// FNV-1a.
constexpr std::uint64_t hashText(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001B3ULL;
  return hash;
}

}  // namespace agricolmap::experiments
