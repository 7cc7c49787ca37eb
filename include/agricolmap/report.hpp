// A registration for people and programs to read, as the command line writes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "agricolmap/export.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

/// Writes registration.json into an existing folder: verdict, transformation, evidence, times, all
/// options. `pictures`: names of the pictures beside it. Throws OutputError.
AGRICOLMAP_EXPORT void writeReport(const std::filesystem::path& folder,
                                   const Registration& registration,
                                   const std::vector<std::string>& pictures = {});

/// What writeReport writes, as text.
AGRICOLMAP_EXPORT std::string reportText(const Registration& registration,
                                         const std::vector<std::string>& pictures = {});

/// Component pictures. Draws what was compared, what was found and how well it fits as PNG files
/// into an existing folder and returns their names. Throws OutputError.
AGRICOLMAP_EXPORT std::vector<std::string> writePictures(const std::filesystem::path& folder,
                                                         const Registration& registration);

}  // namespace agricolmap
