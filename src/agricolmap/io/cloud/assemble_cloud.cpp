#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/point_taking.hpp"

namespace agricolmap::io {
namespace {

/// Chunks that are decoded before the file's memory is released.
constexpr std::size_t kChunksHeld = 256;

/// Large arrays are touched for the first time here; huge pages save most of the page faults.
template <typename T>
void resizeInHugePages(std::vector<T>& values, std::size_t size) {
  constexpr std::size_t kHuge = 1U << 21;
  values.reserve(size);
  auto* const first = reinterpret_cast<std::byte*>(values.data());
  const std::size_t skip = (kHuge - reinterpret_cast<std::uintptr_t>(first) % kHuge) % kHuge;
  const std::size_t bytes = size * sizeof(T);
  if (bytes > skip + kHuge) ::madvise(first + skip, (bytes - skip) / kHuge * kHuge, MADV_HUGEPAGE);
  values.resize(size);
}

/// Closes the gaps that dropped points left at the ends of chunks.
void compact(const PointSource& source, const std::vector<Tally>& tallies, Cloud& cloud) {
  std::size_t next = 0;
  for (std::size_t chunk = 0; chunk < tallies.size(); ++chunk) {
    const std::size_t kept = tallies[chunk].kept;
    if (next == source.firstPoint(chunk)) {
      next += kept;
      continue;
    }
    const auto from = static_cast<std::ptrdiff_t>(source.firstPoint(chunk));
    const auto count = static_cast<std::ptrdiff_t>(kept);
    const auto to = static_cast<std::ptrdiff_t>(next);
    std::copy_n(cloud.xyz.begin() + from, count, cloud.xyz.begin() + to);
    if (cloud.hasColour()) std::copy_n(cloud.rgb.begin() + from, count, cloud.rgb.begin() + to);
    next += kept;
  }
  cloud.dropped_points = cloud.xyz.size() - next;
  cloud.xyz.resize(next);
  if (cloud.hasColour()) cloud.rgb.resize(next);
}

/// Decodes all chunks, each to where its points belong when none before them is dropped.
std::vector<Tally> decodeAll(const PointFile& file, const Taking& taking, Cloud& cloud) {
  const PointSource& source = *file.source;
  std::vector<Tally> tallies(source.chunks());
  for (std::size_t begin = 0; begin < tallies.size(); begin += kChunksHeld) {
    parallelFor(std::min(kChunksHeld, tallies.size() - begin), [&](std::size_t i) {
      std::size_t next = source.firstPoint(begin + i);
      tallies[begin + i] = takeChunk(source, begin + i, taking, [&](const TakenPoints& taken) {
        std::copy_n(taken.xyz.begin(), taken.count, cloud.xyz.data() + next);
        if (cloud.hasColour()) {
          std::copy_n(taken.rgb.begin(), taken.count, cloud.rgb.data() + next);
        }
        next += taken.count;
      });
    });
    if (file.file != nullptr) file.file->release();
  }
  return tallies;
}

}  // namespace

Cloud assembleCloud(const PointFile& file) {
  const PointSource& source = *file.source;
  const FirstLook first = firstLook(source);
  Cloud cloud;
  cloud.name = file.name;
  cloud.fields = file.fields;
  cloud.origin = first.taking.origin;
  resizeInHugePages(cloud.xyz, source.points());
  if (source.colourKind() != ColourKind::kNone) resizeInHugePages(cloud.rgb, source.points());
  std::vector<Tally> tallies = decodeAll(file, first.taking, cloud);
  Tally sum = sumOf(tallies);
  const Taking taking = finalTaking(file, first, sum);
  if (!(taking == first.taking)) {
    tallies = decodeAll(file, taking, cloud);
    sum = sumOf(tallies);
  }
  compact(source, tallies, cloud);
  cloud.warnings = warningsOf(file, taking, sum);
  if (!isColoured(file, sum)) cloud.rgb.clear();
  return cloud;
}

}  // namespace agricolmap::io
