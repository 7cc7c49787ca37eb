// The clouds of a shared map: those that it has, those that come, those that go.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/output/swapped_folder.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"

namespace agricolmap {

/// What the command line says of them.
struct FuseFiles {
  std::string fixed;
  std::vector<std::string> runs;
  std::string fixed_crs;
  std::string fixed_date;
  std::vector<std::string> dates;   ///< "ID=YYYY-MM-DD"
  std::vector<std::string> remove;  ///< ids
  bool force = false;
  bool anew = false;  ///< what the folder holds already does not count

  void addTo(CLI::App& command);
};

/// A strip that will be in the map.
struct MapStrip {
  report::MapSource source;
  std::filesystem::path cloud;  ///< aligned, to be brought into the map; empty: is there already
};

/// What the map is to be made of, before anything is read but reports.
struct MapPlan {
  report::MapSource fixed;
  std::vector<MapStrip> strips;
  Crs crs;  ///< of the registrations; empty where they do not say
  std::vector<std::string> warnings;
};

/// Throws InputError and UsageError that say what to do: a registration that is not accepted and
/// not forced is left out with a warning, but one strip must remain.
MapPlan planMap(const FuseFiles& files, const std::filesystem::path& map, bool overwrite);

/// The clouds themselves, the strips' ones brought into the folder that is being made.
struct MapClouds {
  Crs crs;
  std::unique_ptr<PointStream> fixed;
  std::vector<std::unique_ptr<PointStream>> strips;  ///< in the order of the plan
};
MapClouds openClouds(const FuseFiles& files, MapPlan& plan, const io::SwappedFolder& folder);

/// What strips are stored as, and clouds written as unless something else is asked for: as small as
/// this build can.
io::CloudFormat storedFormat();

/// "2026-05-14" or "20260514" as 20260514. Throws UsageError, naming `flag`.
std::int32_t dateNamed(const std::string& flag, const std::string& text);

}  // namespace agricolmap
