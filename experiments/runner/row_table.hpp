// rows.csv: a table that several runs of the program add to. Whole lines only, one writer at a
// time, all rows of one source.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/runner/row.hpp"

namespace agricolmap::experiments {

class RowTable {
 public:
  /// Opens or makes the file and locks it. A last line that a crash cut off is removed. Throws
  /// InputError when it is no table of this version or has rows of another source, OutputError when
  /// it cannot be written or somebody else writes it.
  RowTable(std::filesystem::path path, std::string_view source);
  ~RowTable();
  RowTable(const RowTable&) = delete;
  RowTable& operator=(const RowTable&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Row>& rows() const { return rows_; }
  /// The row of the same name (Row::key); nullptr when there is none yet.
  const Row* find(const std::string& key) const;
  /// Adds a row and hands it to the system at once. Throws OutputError.
  void append(const Row& row);

 private:
  void load(std::string_view source);
  void write(std::string_view text) const;

  std::filesystem::path path_;
  int fd_ = -1;
  std::vector<Row> rows_;
  std::map<std::string, std::size_t> places_;
};

}  // namespace agricolmap::experiments
