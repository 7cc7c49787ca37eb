#include "common.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/report/pictures/pictures.hpp"

namespace agricolmap {

Progress::Progress(const Globals& globals)
    : active_(!globals.quiet && globals.verbose == 0 && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (active_) std::fputs("\r\033[K", stderr);
}

void Progress::step(std::string_view what) {
  since_step_ = Stopwatch();
  if (active_) {
    std::fprintf(stderr, "\r\033[K%.*s ...", static_cast<int>(what.size()), what.data());
    std::fflush(stderr);
  }
  spdlog::debug("{}", what);
}

void Progress::share(std::string_view what, std::uint64_t done, std::uint64_t points) {
  if (!active_ || done == 0 || points == 0) return;
  const double rate = static_cast<double>(done) / std::max(since_step_.seconds(), 1e-3);
  const double left = static_cast<double>(points - std::min(points, done)) / rate;
  fmt::print(stderr, "\r\033[K{}: {:.0f} %, {:.1f} million points/s, {:.0f} s left", what,
             100.0 * static_cast<double>(done) / static_cast<double>(points), 1e-6 * rate, left);
  std::fflush(stderr);
}

std::string flagsFor(Remedy remedy) {
  switch (remedy) {
    case Remedy::kHeightsAlone:
      return " (--geometry-only)";
    case Remedy::kInitialGuess:
      return " (--prior, or offset.xyz beside the cloud)";
    case Remedy::kNarrowerGuess:
      return " (--prior-sigma with a translation and no --scale-unknown, or --association "
             "correlation)";
    case Remedy::kOverwrite:
      return " (--overwrite)";
    case Remedy::kPixelSize:
      return " (--gsd)";
    case Remedy::kSurfaceModel:
      return " (--dsm)";
    case Remedy::kRowHeading:
      return " (--row-heading, --window, --seed)";
    case Remedy::kWindow:
      return " (--window)";
    case Remedy::kNone:
      break;
  }
  return {};
}

void requirePictures(bool no_pictures) {
  if (no_pictures || report::canDraw()) return;
  throw UsageError("this program was built without Cairo, which pictures need; say --no-pictures");
}

void printWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

Eigen::Affine3d initialGuess(const std::filesystem::path& fixed,
                             const std::filesystem::path& moving, const std::string& prior_file,
                             std::string& source) {
  if (!prior_file.empty()) {
    source = prior_file;
    return io::readMatrix(prior_file);
  }
  const auto world_from_fixed = io::readOffsetBeside(fixed);
  const auto world_from_moving = io::readOffsetBeside(moving);
  for (const std::filesystem::path& cloud : {fixed, moving}) {
    for (const std::string& file : io::offsetsPassedBy(cloud)) {
      spdlog::warn("{} is passed by: were it the offset of {}, it would be called {}.offset.xyz",
                   file, cloud.string(), cloud.stem().string());
    }
  }
  if (!world_from_fixed && !world_from_moving) {
    source = "coordinates as they stand";
    return Eigen::Affine3d::Identity();
  }
  source = "offset.xyz";
  const Eigen::Affine3d identity = Eigen::Affine3d::Identity();
  if (!world_from_fixed || !world_from_moving) {
    spdlog::warn("only {} has an offset.xyz; {} is taken to be in world coordinates already",
                 (world_from_fixed ? fixed : moving).string(),
                 (world_from_fixed ? moving : fixed).string());
    source = "offset.xyz of one cloud";
  }
  return world_from_fixed.value_or(identity).inverse(Eigen::Isometry) *
         world_from_moving.value_or(identity);
}

}  // namespace agricolmap
