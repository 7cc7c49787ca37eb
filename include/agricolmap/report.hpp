// A registration for people and programs to read, as the command line writes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "agricolmap/cloud.hpp"
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

/// Component pictures. Writes report.html into an existing folder: the registration as a page for
/// the one who must decide whether to trust it, of words and numbers only. `pictures`: as
/// writeReport. Throws OutputError.
AGRICOLMAP_EXPORT void writePage(const std::filesystem::path& folder,
                                 const Registration& registration,
                                 const std::vector<std::string>& pictures = {});

/// The same with maps and points, which it looks up in the clouds that were registered. Throws
/// UsageError when these are others.
AGRICOLMAP_EXPORT void writePage(const std::filesystem::path& folder,
                                 const Registration& registration,
                                 const std::vector<std::string>& pictures, const Cloud& fixed,
                                 const Cloud& moving);

}  // namespace agricolmap
