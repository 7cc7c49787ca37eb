// The manifest of a batch: many strips, the maps that they are to be laid into, and how. What it
// may say is in docs/batch.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "agricolmap/batch/settings.hpp"

namespace agricolmap::batch {

/// A wide map.
struct MapEntry {
  std::string id;
  std::string file;  ///< as io::mapFilesOf understands it
  std::string crs;   ///< as the manifest says; empty: as the file does
};

/// One registration, and the folder of its results by the name `id`.
struct Strip {
  std::string id;
  std::size_t map = 0;  ///< index among the maps
  std::string file;
  std::string crs;
  std::string prior;  ///< file with the initial guess; empty: as `register` finds one
  std::string path;   ///< file with the robot's path; empty: none
  int date = 0;       ///< YYYYMMDD, 0: nobody said
  Settings settings;
  pipeline::RegistrationOptions options;  ///< in force
  int line = 0;                           ///< of its entry
};

struct Manifest {
  std::filesystem::path file;
  std::vector<MapEntry> maps;
  std::vector<Strip> strips;  ///< in the order of the manifest; of a pattern, by name
};

/// Throws InputError when the file cannot be read, UsageError with all that is wrong in it, a line
/// for each fault: `MANIFEST:12: ...`.
Manifest readManifest(const std::filesystem::path& file);
/// The same of its text; `file`: what it is called, and what its files lie beside.
Manifest manifestOf(const std::string& text, const std::filesystem::path& file);

}  // namespace agricolmap::batch
