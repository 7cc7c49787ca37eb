// The pictures, one function each. All are drawn independently of one another.
#pragma once

#include "agricolmap/io/output_path.hpp"
#include "agricolmap/report/scene.hpp"

namespace agricolmap {

void writeMapsPicture(const OutputPath& path, const Scene& scene);
void writeFlowPicture(const OutputPath& path, const Scene& scene);
/// `after` shows the moving map where the registration puts it, else where the guess does.
void writeOverlayPicture(const OutputPath& path, const Scene& scene, bool after);
void writeBlocksPicture(const OutputPath& path, const Scene& scene);

}  // namespace agricolmap
