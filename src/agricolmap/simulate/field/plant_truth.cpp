#include "agricolmap/simulate/field/plant_truth.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/simulate/field/leaf_painter.hpp"

namespace agricolmap::simulate {

namespace {

/// The plant alone, drawn as the views draw it: that is what they can know of it.
void measure(const Plant& plant, const Visit& visit, TruePlant& truth) {
  const double reach =
      0.03 + reachOf(plant.species) * static_cast<double>(plant.size) * visit.reach();
  const Eigen::Vector2d stem = plant.position.cast<double>();
  Canvas canvas;
  canvas.window = makeWindow(stem - Eigen::Vector2d::Constant(reach), 0.0, 2.0 * reach, 2.0 * reach,
                             kTruthCell);
  canvas.cells = Raster<Cell>(canvas.window.rows, canvas.window.cols);
  LeafPainter painter(canvas, {0, canvas.window.rows, 0, canvas.window.cols},
                      Eigen::Vector3f::UnitZ());
  painter.paint(plant, growFoliage(plant, visit), 0.0F);
  for (int r = 0; r < canvas.window.rows; ++r) {
    for (int c = 0; c < canvas.window.cols; ++c) {
      const auto z = static_cast<double>(canvas.cells(r, c).z);
      if (z <= 0.0) continue;
      truth.height = std::max(truth.height, z);
      const Eigen::Vector2d place = canvas.window.field(kTruthCell * Eigen::Vector2d(c, r));
      truth.radius = std::max(truth.radius, (place - stem).norm());
    }
  }
}

}  // namespace

std::vector<TruePlant> truePlants(const FieldModel& field, const Visit& visit,
                                  const Window& window) {
  std::vector<Plant> plants = field.plantsIn(window, visit.reach());
  std::erase_if(plants, [&](const Plant& plant) {
    const Eigen::Vector2d at = window.local(plant.position.cast<double>());
    const bool inside =
        at.x() >= 0.0 && at.y() >= 0.0 && at.x() <= window.width() && at.y() <= window.height();
    return !inside || !grows(plant.species) || goneFor(visit, plant);
  });
  std::vector<TruePlant> truth(plants.size());
  parallelFor(
      plants.size(),
      [&](std::size_t i) {
        const Eigen::Vector2d at = plants[i].position.cast<double>();
        truth[i].stem = {at.x(), at.y(), field.soilHeight(at)};
        truth[i].species = plants[i].species;
        if (!truth[i].weed()) truth[i].row = plants[i].row;
        measure(plants[i], visit, truth[i]);
      },
      64);
  return truth;
}

}  // namespace agricolmap::simulate
