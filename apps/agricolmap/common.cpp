#include "common.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "agricolmap/report/pictures/pictures.hpp"

namespace agricolmap {

Progress::Progress(const Globals& globals)
    : active_(!globals.quiet && globals.verbose == 0 && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (active_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::string_view text) const {
  if (!active_) return;
  std::fprintf(stderr, "\r\033[K%.*s", static_cast<int>(text.size()), text.data());
  std::fflush(stderr);
}

void Progress::step(std::string_view what) {
  step_ = what;
  seen_ = 0;
  pass_ = {};
  shown_ = 0.0;
  show(fmt::format("{} ...", step_));
  spdlog::debug("{}", what);
}

void Progress::points(std::size_t seen, std::size_t of) {
  constexpr double kBetween = 0.25;  // [s]
  if (seen < seen_) {                // the next pass
    pass_ = {};
    shown_ = 0.0;
  }
  seen_ = seen;
  const double seconds = pass_.seconds();
  if (seen == 0 || seconds < shown_ + kBetween) return;
  shown_ = seconds;
  show(fmt::format("{}: {}", step_, passText(seen, of, seconds)));
}

std::string passText(std::size_t seen, std::size_t of, double seconds) {
  constexpr double kMillion = 1e6;
  const double rate = static_cast<double>(seen) / seconds;
  return fmt::format("{:.1f} of {:.1f} million points, {:.1f} million/s, {:.0f} s left",
                     static_cast<double>(seen) / kMillion, static_cast<double>(of) / kMillion,
                     rate / kMillion, static_cast<double>(of - std::min(seen, of)) / rate);
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
    case Remedy::kResumeOrOverwrite:
      return " (--resume, --overwrite)";
    case Remedy::kNone:
      break;
  }
  return {};
}

void requirePictures(bool no_pictures) {
  if (no_pictures || report::canDraw()) return;
  throw UsageError("this program was built without Cairo, which pictures need; say --no-pictures");
}

std::string wayTo(const std::filesystem::path& page, const std::filesystem::path& folder) {
  std::error_code error;
  if (page.empty() || !std::filesystem::exists(page, error)) return "";
  const std::filesystem::path way = std::filesystem::relative(page, folder, error);
  return error ? "" : way.generic_string();
}

void printWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

void warnOfLostCrs(const std::string& file, io::CloudFormat format, const Crs& crs) {
  if (io::isLas(format) || crs.wkt.empty()) return;
  spdlog::warn("{}: {} has no place for the coordinate system, {}; say it where the file is used",
               file, io::endingOf(format), crs.name);
}

}  // namespace agricolmap
