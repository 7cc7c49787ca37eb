// The pictures, one function each. All are drawn independently of one another.
#pragma once

#include <filesystem>

#include "agricolmap/report/scene.hpp"

namespace agricolmap {

void writeMapsPicture(const std::filesystem::path& path, const Scene& scene);
void writeFlowPicture(const std::filesystem::path& path, const Scene& scene);
/// `after` shows the moving map where the registration puts it, else where the guess does.
void writeOverlayPicture(const std::filesystem::path& path, const Scene& scene, bool after);
void writeBlocksPicture(const std::filesystem::path& path, const Scene& scene);

}  // namespace agricolmap
