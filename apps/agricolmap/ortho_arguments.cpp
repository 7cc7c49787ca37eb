#include "ortho_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/config/text.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/simulate/ortho/row_heading.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

constexpr const char* kGroup = "Instead of a simulated crop: a real orthomosaic";

/// What acts on the mosaic's plants and soil, beside the heights; the rest of `field.` does not.
constexpr const char* kFrame[] = {"field.width", "field.height", "field.random_row_heading",
                                  "field.row_heading_deg"};
/// Changes of simulated plants and soil only.
constexpr const char* kVisits[] = {"views.weeds_pulled",  "views.weeds_new",    "views.plants_lost",
                                   "views.growth_spread", "views.ripeness",     "views.ripening",
                                   "views.soil_kept",     "views.soil_contrast"};
/// The heights are the surface model's.
constexpr const char* kRelief[] = {"field.relief", "field.slope", "field.clods",
                                   "field.plant_size"};

}  // namespace

void OrthoArguments::addTo(CLI::App& command) {
  command.add_option("--ortho", ortho_, "Orthomosaic: GeoTIFF, PNG, ... whose plants are taken")
      ->group(kGroup);
  command.add_option("--dsm", dsm_, "Its surface model; without: heights are made up")
      ->group(kGroup);
  command.add_option("--dtm", dtm_, "Its terrain model; without: the lowest surface around")
      ->group(kGroup);
  command
      .add_option("--window", window_,
                  "COL ROW COLS ROWS: take these pixels, counted from the top left; without: "
                  "field.width x field.height m where --seed says")
      ->expected(4)
      ->group(kGroup);
  command
      .add_option("--row-heading", row_heading_,
                  "DEGREES counter-clockwise from east in which the rows run; without: measured")
      ->expected(1)
      ->check(CLI::Range(-360.0, 360.0))
      ->group(kGroup);
  simulate::OrthoFileOptions defaults;
  flags_.addTo(command, optionTable(defaults), kGroup);
}

bool OrthoArguments::given(const OptionFlags& flags) const {
  if (ortho_.empty()) {
    if (!dsm_.empty() || !dtm_.empty() || !window_.empty() || !row_heading_.empty() ||
        !flags_.given().empty()) {
      throw UsageError(
          "--dsm, --dtm, --window, --row-heading, --gsd, --bands and --black-is-nodata describe an "
          "orthomosaic; give it, too: --ortho FILE");
    }
    return false;
  }
  const auto refuse = [&](const std::string& path, const char* why) {
    if (flags.given(path)) {
      throw UsageError(fmt::format("{} does nothing with --ortho: {}", flagOf(path), why));
    }
  };
  const auto isOneOf = [](const auto& paths, const std::string& path) {
    return std::find(std::begin(paths), std::end(paths), path) != std::end(paths);
  };
  for (const std::string& path : flags.given()) {
    const bool layout =
        path.starts_with("field.") && !isOneOf(kFrame, path) && !isOneOf(kRelief, path);
    if (layout || isOneOf(kVisits, path)) refuse(path, "plants and soil are those of the mosaic");
  }
  if (!dsm_.empty()) {
    for (const char* path : kRelief) refuse(path, "the heights are those of the surface model");
  }
  return true;
}

io::PixelWindow OrthoArguments::windowFor(const simulate::SimulationOptions& options) const {
  if (!window_.empty()) return {window_[0], window_[1], window_[2], window_[3]};
  return simulate::chooseWindow(ortho_, file_options_, options.field.width, options.field.height,
                                static_cast<std::uint64_t>(options.seed));
}

std::unique_ptr<simulate::SimulatedOrtho> OrthoArguments::fly(
    simulate::SimulationOptions& options) {
  flags_.apply(optionTable(file_options_));
  const io::PixelWindow window = windowFor(options);
  window_ = {window.col, window.row, window.cols, window.rows};
  simulate::OrthoField field = simulate::readOrtho({ortho_, dsm_, dtm_}, file_options_, window);
  printWarnings(field.warnings);
  file_options_.gsd = field.gsd;
  spdlog::info("{}: {:.1f} x {:.1f} m with pixels of {:.5g} m: --window {}", ortho_,
               field.gsd * field.colour.cols(), field.gsd * field.colour.rows(), field.gsd,
               fmt::join(window_, " "));
  if (!row_heading_.empty()) {
    options.field.random_row_heading = false;
    options.field.row_heading_deg = row_heading_.front();
  } else if (options.field.random_row_heading) {
    options.field.random_row_heading = false;
    // To hundredths, as it is reported, so that the report makes the same pair.
    options.field.row_heading_deg =
        std::round(100.0 * degrees(simulate::findRowHeading(field))) / 100.0 + 0.0;
    spdlog::info("{}: the rows run at {:.2f} degrees", ortho_, options.field.row_heading_deg);
  }
  field.row_heading = radians(options.field.row_heading_deg);
  if (options.uav.gsd < field.gsd) {
    spdlog::info("uav.gsd is {:.5g} m instead of {:.5g} m: the mosaic is no finer", field.gsd,
                 options.uav.gsd);
    options.uav.gsd = field.gsd;
  }
  return std::make_unique<simulate::SimulatedOrtho>(std::move(field), options);
}

std::string OrthoArguments::provenance() const {
  std::string text = fmt::format("# Made from --ortho {}", ortho_);
  if (!dsm_.empty()) text += fmt::format(" --dsm {}", dsm_);
  if (!dtm_.empty()) text += fmt::format(" --dtm {}", dtm_);
  text += fmt::format(" --window {}", fmt::join(window_, " "));
  simulate::OrthoFileOptions shown = file_options_;
  const OptionTable table = optionTable(shown);
  for (const OptionField& field : table.fields()) {
    text += fmt::format(" {} {}", flagOf(field.path), config::optionText(field));
  }
  std::replace(text.begin(), text.end(), '\n', ' ');  // of a file's name: still a comment
  return text + "\n# with the options below; heights and plants are the mosaic's, not field.*\n";
}

}  // namespace agricolmap
