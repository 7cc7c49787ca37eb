// A table of rows that several runs of a program add to: whole lines only, one writer at a time,
// all rows of one program and one set of options.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace agricolmap::experiments {

/// What stands in the file: `# identity`, the header, then rows.
struct RowLines {
  std::string identity;
  std::vector<std::string> rows;
};

/// A last line that a crash cut off is left out. Throws InputError for a file that cannot be read
/// or has another header; `program` is who is said to have written it.
RowLines readRowFile(const std::filesystem::path& path, std::string_view header,
                     std::string_view program);
/// Where a row stands, for messages: `path:line`.
std::string rowPlace(const std::filesystem::path& path, std::size_t row);

class RowFile {
 public:
  /// Opens or makes the file and locks it. `identity` is one line that says what program and
  /// options the rows come from; throws InputError when the file has another, OutputError when it
  /// cannot be written or somebody else writes it. A last line that a crash cut off is removed.
  RowFile(std::filesystem::path path, std::string_view header, std::string_view program,
          std::string_view identity);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// The rows that were there when the file was opened.
  const std::vector<std::string>& rows() const { return rows_; }
  /// Adds a line, with its line end, and hands it to the system at once. Throws OutputError.
  void append(std::string_view line);

 private:
  std::filesystem::path path_;
  int fd_ = -1;
  std::vector<std::string> rows_;
};

}  // namespace agricolmap::experiments
