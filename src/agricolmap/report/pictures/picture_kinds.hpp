// The pictures, one function each. All are drawn independently of one another.
#pragma once

#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/report/pictures/scene.hpp"

namespace agricolmap::report {

void writeMapsPicture(const io::OutputPath& path, const Scene& scene);
void writeFlowPicture(const io::OutputPath& path, const Scene& scene);
/// `after` shows the moving map where the registration puts it, else where the guess does.
void writeOverlayPicture(const io::OutputPath& path, const Scene& scene, bool after);
/// Of a registration that follows a deformation.
void writeDeformationPicture(const io::OutputPath& path, const Scene& scene);
void writeBlocksPicture(const io::OutputPath& path, const Scene& scene);

}  // namespace agricolmap::report
