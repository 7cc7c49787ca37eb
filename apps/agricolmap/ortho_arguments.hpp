// What `agricolmap simulate` needs to know about an orthomosaic, and the pair made from it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "agricolmap/simulate/ortho/ortho_file.hpp"
#include "agricolmap/simulate/simulate.hpp"
#include "option_flags.hpp"

namespace agricolmap {

class OrthoArguments {
 public:
  void addTo(CLI::App& command);
  /// Whether the pair is to be made from an orthomosaic. Throws UsageError for flags that only make
  /// sense with one, or that make none with one; `flags` are those of the simulator.
  bool given(const OptionFlags& flags) const;
  /// Reads the mosaic and flies over it. Puts what was found or decided into `options`.
  std::unique_ptr<simulate::SimulatedOrtho> fly(simulate::SimulationOptions& options);
  /// The mosaic's, without its folder.
  std::string fileName() const { return std::filesystem::path(ortho_).filename(); }
  /// Comment lines that say what the pair was made from; after simulate().
  std::string provenance() const;

 private:
  io::PixelWindow windowFor(const simulate::SimulationOptions& options) const;

  std::string ortho_;
  std::string dsm_;
  std::string dtm_;
  std::vector<int> window_;
  std::vector<double> row_heading_;
  OptionFlags flags_;
  simulate::OrthoFileOptions file_options_;
};

}  // namespace agricolmap
