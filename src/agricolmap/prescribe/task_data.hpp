// A prescription as ISO 11783-10 has it: TASKDATA.XML and its grid, version 3.3, which terminals of
// version 4 read, too. Elements and their limits as in the schema ISO11783_TaskFile_V3-3.xsd of
// isobus.net; the order of a grid's cells: west to east, southernmost row first.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/prescribe/plan.hpp"

namespace agricolmap::prescribe {

/// Which of its two kinds of grid a task file has.
enum class GridKind {
  kZones,   ///< type 1: a byte for each cell, the code of a treatment zone
  kValues,  ///< type 2: four bytes for each cell, the setpoint itself
};

/// What people call things; at most kLongestName characters each.
struct TaskNames {
  std::string task;
  std::string product;
  std::string field;
  std::string version;            ///< of this program
  std::vector<int> zone_colours;  ///< one for each class: index into the palette of ISO 11783-6
};

inline constexpr std::size_t kLongestName = 32;
inline constexpr const char* kGridName = "GRD00001";

struct TaskData {
  std::string xml;                  ///< TASKDATA.XML
  std::vector<std::uint8_t> cells;  ///< GRD00001.bin
};

/// Zone 0 is where nothing is known, outside and where the position is lost: it gets nothing.
/// Throws UsageError for names that are too long.
TaskData taskDataOf(const Plan& plan, const TaskGrid& grid, const TaskNames& names, GridKind kind);

/// The nearest of the palette's cube of 6 × 6 × 6 colours to 0xRRGGBB.
int paletteIndex(std::uint32_t rgb);

}  // namespace agricolmap::prescribe
