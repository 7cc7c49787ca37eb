// What is told of a batch when it is done: a table for programs of any kind.
#pragma once

#include <span>
#include <string>

#include "agricolmap/batch/record.hpp"

namespace agricolmap::batch {

/// How many strips ended how.
struct Counts {
  std::size_t accepted = 0;
  std::size_t rejected = 0;
  std::size_t ambiguous = 0;
  std::size_t failed = 0;

  void add(const Record& record);
  std::size_t all() const { return accepted + rejected + ambiguous + failed; }
};
Counts countsOf(std::span<const Record> records);
/// "97 accepted, 2 rejected, 1 failed": what there is none of is left out.
std::string toText(const Counts& counts);

/// A line for people: id, status, probability, errors, seconds, the message where not accepted.
std::string lineOf(const Record& record, std::size_t id_width);

/// summary.csv: a header and a line for each strip (RFC 4180).
std::string csvOf(std::span<const Record> records);
/// What summary.json has.
nlohmann::ordered_json summaryJson(std::span<const Record> records, const Manifest& manifest,
                                   double seconds);
/// summary.json.
std::string jsonOf(std::span<const Record> records, const Manifest& manifest, double seconds);

}  // namespace agricolmap::batch
