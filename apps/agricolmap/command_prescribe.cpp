// agricolmap prescribe SOURCE -o DIR: a rate for each square of a field, as machines read it.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <span>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/prescribe/plan.hpp"
#include "agricolmap/prescribe/task_data.hpp"
#include "agricolmap/report/pictures/prescription_picture.hpp"
#include "agricolmap/report/prescription/prescription_words.hpp"
#include "common.hpp"
#include "option_flags.hpp"
#include "prescribe_input.hpp"

namespace agricolmap {
namespace {

constexpr const char* kPicture = "prescription.png";

struct PrescribeArguments {
  std::string source;
  std::string output;
  std::string layer;
  std::string crs;
  std::vector<double> breaks;
  std::vector<double> rates;
  std::string unit;
  std::string product = "product";
  std::string field = "field";
  std::string task;
  std::optional<double> heading_deg;
  int grid_type = 1;
  bool no_pictures = false;
  OptionFlags flags;
};

/// Both ways, with words for where there is none.
prescribe::Earth earthOf(const Crs& crs, const std::string& name) {
  const auto required = [crs, name](auto points) {
    if (points) return *std::move(points);
    throw InputError(fmt::format(
        "{}: its coordinate system ({}) lies nowhere on the Earth, or the map does not lie in it",
        name, crs.name));
  };
  return {[crs, required](const std::vector<Eigen::Vector2d>& points) {
            return required(io::geographic(crs, points));
          },
          [crs, required](const std::vector<Eigen::Vector2d>& points) {
            return required(io::fromGeographic(crs, points));
          }};
}

prescribe::Plan makePlan(const PrescribeArguments& arguments, const PrescribeInput& input,
                         const prescribe::SquareOptions& squares, const prescribe::Earth& earth) {
  prescribe::Lattice lattice =
      arguments.heading_deg
          ? prescribe::turnedLattice(input.frame, radians(*arguments.heading_deg), squares.width,
                                     squares.length)
          : prescribe::degreeLattice(input.frame, earth, squares.width, squares.length);
  Raster<float> means =
      prescribe::squareMeans(input.frame, input.values, lattice, earth, squares.least_seen);
  if (!prescribe::trim(lattice, means)) {
    throw InputError(
        fmt::format("{}: the layer {} knows no square of {:g} x {:g} m well enough; make them "
                    "smaller or ask for less: --width, --least-seen",
                    arguments.source, input.layer, squares.width, squares.length));
  }
  const std::vector<double> breaks =
      arguments.breaks.empty()
          ? prescribe::quantileBreaks(means, static_cast<int>(arguments.rates.size()))
          : arguments.breaks;
  return prescribe::planOf(std::move(lattice), std::move(means), breaks, arguments.rates,
                           prescribe::rateUnit(arguments.unit), earth);
}

prescribe::TaskNames namesOf(const PrescribeArguments& arguments, const PrescribeInput& input,
                             const prescribe::Plan& plan) {
  prescribe::TaskNames names;
  names.task = arguments.task.empty() ? fmt::format("{} by {}", arguments.product, input.layer)
                                            .substr(0, prescribe::kLongestName)
                                      : arguments.task;
  names.product = arguments.product;
  names.field = arguments.field;
  names.version = AGRICOLMAP_VERSION;
  for (std::size_t i = 0; i < plan.classes.size(); ++i) {
    names.zone_colours.push_back(prescribe::paletteIndex(report::classColour(plan, i)));
  }
  return names;
}

void writeTaskData(const io::StagedOutput& output, const prescribe::TaskData& data) {
  io::writeText(output.path("TASKDATA/TASKDATA.XML"), data.xml);
  io::FileSink cells(output.path(fmt::format("TASKDATA/{}.bin", prescribe::kGridName)));
  cells.write(std::as_bytes(std::span(data.cells)));
  cells.close();
}

ExitCode runPrescribe(const PrescribeArguments& arguments, const Globals& globals) {
  prescribe::SquareOptions squares;
  arguments.flags.apply(optionTable(squares));
  if (squares.length == 0.0) squares.length = squares.width;
  requirePictures(arguments.no_pictures);
  io::StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  progress.step("read");
  const PrescribeInput input =
      readPrescribeInput(arguments.source, arguments.layer, arguments.crs, squares.least_seen);
  const prescribe::Earth earth = earthOf(input.crs, arguments.source);
  progress.step("plan");
  const prescribe::Plan plan = makePlan(arguments, input, squares, earth);
  const prescribe::TaskGrid grid = prescribe::taskGridOf(plan, earth);
  const auto kind =
      arguments.grid_type == 2 ? prescribe::GridKind::kValues : prescribe::GridKind::kZones;
  const report::PlacedPlan placed{plan,
                                  grid,
                                  kind,
                                  arguments.source,
                                  input.layer,
                                  input.unit,
                                  arguments.product,
                                  input.crs,
                                  squares,
                                  arguments.heading_deg};
  progress.step("write");
  writeTaskData(output, prescribe::taskDataOf(plan, grid, namesOf(arguments, input, plan), kind));
  io::writeShapefile(output.folder(), report::prescriptionLayer(placed, earth.degrees_from_file),
                     io::geographicCrs());
  io::writeText(output.path("prescription.json"), report::prescriptionJson(placed).dump(2) + "\n");
  if (!arguments.no_pictures) {
    report::writePrescriptionPicture(
        output.path(kPicture),
        {placed, prescribe::placeFromFile(plan.lattice, earth), input.frame, input.values});
  }
  output.commit({kPicture});
  if (!globals.quiet) fmt::print("{}", report::prescriptionText(placed));
  return ExitCode::kOk;
}

void addSource(CLI::App& command, PrescribeArguments& arguments) {
  command
      .add_option("SOURCE", arguments.source,
                  "Folder of a map, or of its facts, or a raster with square cells")
      ->required();
  command.add_option("-o,--output", arguments.output, "Folder for the results")->required();
  command.add_option("--layer", arguments.layer,
                     "What rates follow: a layer of the map (plant_height, cover, exg, ...), a "
                     "field of the facts' squares (weed_share, ...), a band of the raster");
  command.add_option("--crs", arguments.crs,
                     "Coordinate system of a source that does not say its own: EPSG:32632, ...");
}

}  // namespace

CommandSlot addPrescribeCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<PrescribeArguments>();
  CLI::App* command = app.add_subcommand(
      "prescribe",
      "Make a prescription of a layer: a rate for each square, as ISOXML and shapefile");
  addSource(*command, *arguments);
  command
      ->add_option("--rates", arguments->rates,
                   "A rate for each class, that of the lowest values "
                   "first: 120,100,80")
      ->delimiter(',')
      ->required();
  command->add_option("--unit", arguments->unit, "Of the rates: " + prescribe::rateUnitNames())
      ->required();
  command
      ->add_option("--breaks", arguments->breaks,
                   "Where classes part, in the layer's unit: 0.1,0.2 [classes of as many squares "
                   "each]")
      ->delimiter(',');
  command
      ->add_option("--heading", arguments->heading_deg,
                   "Where the machine drives, degrees counter-clockwise from the map's east; "
                   "squares are turned to it [squares north up]")
      ->check(CLI::Range(-360.0, 360.0));
  command->add_option("--product", arguments->product, "What is applied [product]");
  command->add_option("--field", arguments->field, "The field's name on the terminal [field]");
  command->add_option("--task", arguments->task, "The task's name there [product by layer]");
  command
      ->add_option("--isoxml-grid", arguments->grid_type,
                   "1: cells say their zone; 2: cells say their rate [1]")
      ->check(CLI::IsMember({1, 2}));
  command->add_flag("--no-pictures", arguments->no_pictures, "Write no PNG picture");
  prescribe::SquareOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Squares");
  return {command, [arguments, &globals] { return runPrescribe(*arguments, globals); }};
}

}  // namespace agricolmap
