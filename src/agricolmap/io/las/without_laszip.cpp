// Stands for laz_points.cpp and laz_writer.cpp where LASzip is not built in.
#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/las/las_points.hpp"
#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {

bool hasLaz() { return false; }

std::unique_ptr<LasPoints> lazPoints(std::span<const std::byte> /*bytes*/,
                                     const LasHeader& /*header*/, const std::string& name) {
  throw InputError(fmt::format(
      "{}: is compressed (LAZ), and this build has no LASzip; build it with liblaszip-dev "
      "(scripts/install-dependencies), or give uncompressed LAS",
      name));
}

std::vector<std::byte> lazRecord(const LasLayout& /*layout*/, bool /*variable*/) {
  throw UsageError(
      "writing LAZ and COPC needs LASzip, and this build has none; build it with liblaszip-dev "
      "(scripts/install-dependencies), or write LAS");
}

std::vector<std::byte> lazChunk(const std::byte* /*records*/, std::size_t /*count*/,
                                const LasLayout& layout) {
  return lazRecord(layout, false);
}

std::vector<std::byte> lazChunkTable(std::span<const LazChunkSize> /*chunks*/, bool variable) {
  return lazRecord({}, variable);
}

}  // namespace agricolmap::io
