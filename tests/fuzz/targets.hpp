// What is fuzzed: every reader of files that users bring.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace agricolmap::fuzz {

/// One reader. The folder of its seeds in corpus/ has its name.
struct Target {
  std::string_view name;
  void (*read)(const std::filesystem::path& file);
};

std::span<const Target> targets();

/// Null where there is none of that name.
const Target* targetOf(std::string_view name);

/// Reads these bytes as a file, and says whether it was read: else it was refused. All else gets
/// through, and a cloud with a point that is not finite ends the program.
bool runOn(const Target& target, std::span<const std::uint8_t> bytes);

}  // namespace agricolmap::fuzz
