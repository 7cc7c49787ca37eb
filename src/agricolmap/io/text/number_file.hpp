// Small text files of numbers: matrices and offsets.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace agricolmap::io {

struct NumberFile {
  std::vector<double> numbers;
  std::vector<std::size_t> lines;  ///< line of each number, from 1
};

/// All numbers of a file, finite, separated by blanks, commas, semicolons or brackets; `#` begins a
/// comment. Beside semicolons a comma between digits is a decimal mark; where it may be that or a
/// separator, the line is refused. Throws InputError with file and line.
NumberFile readNumbers(const std::filesystem::path& path);

/// The same of a text; `name` stands for the file in messages.
NumberFile numbersIn(std::string_view text, const std::string& name);

/// With as many digits as it takes to read the same double again.
std::string exactText(double value);

}  // namespace agricolmap::io
