#include "agricolmap/report/pictures/pictures.hpp"

#include <array>
#include <functional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/pictures/picture_kinds.hpp"
#include "agricolmap/report/pictures/scene.hpp"

namespace agricolmap::report {
namespace {

enum class Needs { kNothing, kTransform, kDeformation };

struct Kind {
  const char* name;
  Needs needs;
  void (*write)(const io::OutputPath& path, const Scene& scene);
};

/// Those that take longest first, so that the last to finish is a quick one.
constexpr std::array<Kind, 6> kKinds = {{
    {"overlay_before.png", Needs::kTransform,
     [](const auto& p, const Scene& s) { writeOverlayPicture(p, s, false); }},
    {"overlay_after.png", Needs::kTransform,
     [](const auto& p, const Scene& s) { writeOverlayPicture(p, s, true); }},
    {"exg_maps.png", Needs::kNothing, writeMapsPicture},
    {"flow.png", Needs::kNothing, writeFlowPicture},
    {"blocks.png", Needs::kTransform, writeBlocksPicture},
    {"deformation.png", Needs::kDeformation, writeDeformationPicture},
}};

bool has(const pipeline::Registration& registration, Needs needs) {
  if (needs == Needs::kNothing) return true;
  if (!registration.transform.has_value()) return false;
  return needs == Needs::kTransform || registration.placed->followed.has_value();
}

}  // namespace

bool canDraw() { return true; }

std::vector<std::string> pictureNames() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

std::vector<std::string> writePictures(const io::OutputPath& dir,
                                       const pipeline::Registration& registration,
                                       const PictureInfo& info) {
  const Scene scene(registration, info);
  std::vector<const Kind*> chosen;
  for (const Kind& kind : kKinds) {
    if (has(registration, kind.needs)) chosen.push_back(&kind);
  }
  parallelFor(chosen.size(),
              [&](std::size_t i) { chosen[i]->write(dir / chosen[i]->name, scene); });
  std::vector<std::string> names;
  for (const Kind* kind : chosen) names.emplace_back(kind->name);
  return names;
}

}  // namespace agricolmap::report
