// The stages one by one.
#include <pybind11/stl.h>

#include <agricolmap/stages.hpp>
#include <memory>
#include <utility>

#include "bindings.hpp"
#include "waiting.hpp"

namespace agricolmap::python {
namespace {

/// A transformation and its score.
using Scored = std::pair<Matrix, double>;

std::vector<Place> placesOf(const std::vector<Scored>& scored) {
  std::vector<Place> places;
  for (const auto& [matrix, score] : scored) places.push_back({transformOf(matrix), score});
  return places;
}

std::vector<Scored> scoredOf(const std::vector<Place>& places) {
  std::vector<Scored> scored;
  for (const Place& place : places)
    scored.emplace_back(arrayOf(place.fixed_from_moving), place.score);
  return scored;
}

std::shared_ptr<Pair> make(const std::shared_ptr<Cloud>& fixed,
                           const std::shared_ptr<Cloud>& moving, const Matrix& guess,
                           const Options& options, const py::object& stop, int threads) {
  const Transform fixed_from_moving = transformOf(guess);
  return waitFor({py::none(), stop}, threads, [&, chosen = options](const Control& control) {
    return std::make_shared<Pair>(fixed, moving, fixed_from_moving, chosen, control);
  });
}

}  // namespace

void bindStages(py::module_& module) {
  py::class_<Pair, std::shared_ptr<Pair>>(module, "Pair")
      .def("maps",
           [](const Pair& pair) {
             const ComparedMaps maps = [&] {
               const py::gil_scoped_release release;
               return pair.maps();
             }();
             return py::make_tuple(mapValuesOf(maps.fixed), mapValuesOf(maps.moving));
           })
      .def("locate",
           [](const std::shared_ptr<Pair>& pair, const py::object& stop, int threads) {
             return scoredOf(waitFor({py::none(), stop}, threads, [&](const Control& control) {
               return pair->locate(control);
             }));
           })
      .def("refine",
           [](const std::shared_ptr<Pair>& pair, const std::vector<Scored>& scored,
              const py::object& stop, int threads) {
             const std::vector<Place> places = placesOf(scored);
             return scoredOf(waitFor({py::none(), stop}, threads, [&](const Control& control) {
               return pair->refine(places, control);
             }));
           })
      .def("judge", [](const std::shared_ptr<Pair>& pair, const std::vector<Scored>& scored,
                       const py::object& stop, int threads) {
        const std::vector<Place> places = placesOf(scored);
        return waitFor({py::none(), stop}, threads, [&](const Control& control) {
          return std::make_shared<Registration>(pair->judge(places, control));
        });
      });
  module.def("make_pair", &make);
}

}  // namespace agricolmap::python
