#include "agricolmap/prescribe/task_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/xml_text.hpp"

namespace agricolmap::prescribe {
namespace {

/// The zone that a grid of values takes its product and unit from.
int templateZone(const Plan& plan) { return static_cast<int>(plan.classes.size()) + 1; }

std::string nameOf(const std::string& text, const char* what) {
  const auto letters = static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
  if (letters > kLongestName) {
    throw UsageError(fmt::format("'{}' is too long: a task file has {} characters for the {}", text,
                                 kLongestName, what));
  }
  return xmlText(text);
}

std::string zoneXml(const Plan& plan, int code, const std::string& name, int colour, int value) {
  return fmt::format(
      "    <TZN A=\"{}\" B=\"{}\" C=\"{}\">\n"
      "      <PDV A=\"{:04X}\" B=\"{}\" C=\"PDT1\" E=\"VPN1\"/>\n"
      "    </TZN>\n",
      code, name, colour, plan.unit.ddi, value);
}

std::string zonesXml(const Plan& plan, const TaskNames& names, GridKind kind) {
  constexpr int kWhite = 1;  // of the palette
  std::string xml = zoneXml(plan, 0, "nothing", kWhite, 0);
  if (kind == GridKind::kValues) return xml + zoneXml(plan, templateZone(plan), "grid", kWhite, 0);
  for (std::size_t i = 0; i < plan.classes.size(); ++i) {
    const ClassShare& share = plan.classes[i];
    const std::string name =
        fmt::format("{}: {:.6g} {}", i + 1, taskRate(share.task_value, plan.unit), plan.unit.name);
    const int colour = i < names.zone_colours.size() ? names.zone_colours[i] : kWhite;
    xml += zoneXml(plan, static_cast<int>(i + 1), name, colour, share.task_value);
  }
  return xml;
}

std::vector<std::uint8_t> cellsOf(const Plan& plan, const TaskGrid& grid, GridKind kind) {
  if (kind == GridKind::kZones) return {grid.code.begin(), grid.code.end()};
  std::vector<std::uint8_t> cells;
  cells.reserve(4 * grid.code.size());
  for (const std::uint8_t code : grid.code) {
    const auto value =
        code == 0 ? 0U : static_cast<std::uint32_t>(plan.classes[code - 1U].task_value);
    for (const unsigned shift : {0U, 8U, 16U, 24U}) {
      cells.push_back(static_cast<std::uint8_t>((value >> shift) & 255U));
    }
  }
  return cells;
}

std::string gridXml(const Plan& plan, const TaskGrid& grid, GridKind kind, std::size_t bytes) {
  const Lattice& lattice = grid.lattice;
  const std::string zone =
      kind == GridKind::kValues ? fmt::format(" J=\"{}\"", templateZone(plan)) : "";
  return fmt::format(
      "    <GRD A=\"{:.9f}\" B=\"{:.9f}\" C=\"{:.9f}\" D=\"{:.9f}\" E=\"{}\" F=\"{}\" G=\"{}\" "
      "H=\"{}\" I=\"{}\"{}/>\n",
      lattice.corner.y(), lattice.corner.x(), lattice.axes(1, 1), lattice.axes(0, 0), lattice.cols,
      lattice.rows, kGridName, bytes, kind == GridKind::kValues ? 2 : 1, zone);
}

}  // namespace

int paletteIndex(std::uint32_t rgb) {
  constexpr int kFirst = 16;
  const auto level = [rgb](unsigned shift) {
    return static_cast<int>(std::lround(((rgb >> shift) & 255U) / 51.0));
  };
  return kFirst + 36 * level(16) + 6 * level(8) + level(0);
}

TaskData taskDataOf(const Plan& plan, const TaskGrid& grid, const TaskNames& names, GridKind kind) {
  TaskData data;
  data.cells = cellsOf(plan, grid, kind);
  // Steps of the dictionary in the user's unit; nine decimals are what the schema has.
  const double scale = 1.0 / plan.unit.steps;
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(scale))), 0, 2);
  data.xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<ISO11783_TaskData VersionMajor=\"3\" VersionMinor=\"3\" "
      "ManagementSoftwareManufacturer=\"AgriColMap\" ManagementSoftwareVersion=\"{}\" "
      "DataTransferOrigin=\"1\">\n"
      "  <VPN A=\"VPN1\" B=\"0\" C=\"{:.9f}\" D=\"{}\" E=\"{}\"/>\n"
      "  <PDT A=\"PDT1\" B=\"{}\"/>\n"
      "  <PFD A=\"PFD1\" C=\"{}\" D=\"{:.0f}\"/>\n"
      "  <TSK A=\"TSK1\" B=\"{}\" E=\"PFD1\" G=\"1\" H=\"0\" I=\"0\" J=\"0\">\n",
      nameOf(names.version, "version"), scale, decimals, plan.unit.name,
      nameOf(names.product, "product"), nameOf(names.field, "field"), plan.area,
      nameOf(names.task, "task"));
  data.xml += zonesXml(plan, names, kind);
  data.xml += gridXml(plan, grid, kind, data.cells.size());
  data.xml += "  </TSK>\n</ISO11783_TaskData>\n";
  return data;
}

}  // namespace agricolmap::prescribe
