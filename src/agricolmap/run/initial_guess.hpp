// Where a registration of two files begins.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace agricolmap::run {

/// Hears what the user should know, as it is found.
using Say = std::function<void(const std::vector<std::string>&)>;

/// Moving file → fixed file coordinates: `prior_file` if given; else from the offset.xyz beside
/// each cloud (one that has none stands in world coordinates); else identity. Says which in
/// `source`.
Eigen::Affine3d initialGuess(const std::filesystem::path& fixed,
                             const std::filesystem::path& moving, const std::string& prior_file,
                             std::string& source, const Say& say);

}  // namespace agricolmap::run
