// The extension module of the component batch.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <agricolmap/batch.hpp>
#include <deque>
#include <memory>
#include <mutex>
#include <tuple>

#include "bindings.hpp"
#include "waiting.hpp"

namespace agricolmap::python {
namespace {

template <typename Value>
py::object orNone(const std::optional<Value>& value) {
  return value ? py::cast(*value) : py::none();
}

py::dict valuesOf(const BatchStrip& strip) {
  py::dict values;
  values["id"] = strip.id;
  values["map"] = strip.map;
  values["folder"] = strip.folder;
  values["status"] = strip.status ? py::cast(std::string(toString(*strip.status))) : py::none();
  values["plane_probability"] = strip.plane_probability;
  values["expected_rms_m"] = orNone(strip.expected_rms_m);
  values["heights_measured"] = strip.heights_measured;
  values["height_deviation_m"] = orNone(strip.height_deviation_m);
  values["seconds"] = strip.seconds;
  values["date"] = strip.date;
  values["message"] = strip.message;
  values["kept"] = strip.kept;
  py::array_t<double> outline(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(strip.outline.size()), 2});
  double* out = outline.mutable_data();
  for (const Eigen::Vector2d& corner : strip.outline) {
    *out++ = corner.x();
    *out++ = corner.y();
  }
  values["outline_m"] = outline;
  return values;
}

/// Strips that are done, from the threads that register to the one that holds the interpreter.
class Done {
 public:
  void add(const BatchStrip& strip, std::size_t done, std::size_t todo) {
    const std::scoped_lock lock(mutex_);
    strips_.emplace_back(strip, done, todo);
  }
  std::tuple<BatchStrip, std::size_t, std::size_t> take() {
    const std::scoped_lock lock(mutex_);
    auto strip = std::move(strips_.front());
    strips_.pop_front();
    return strip;
  }

 private:
  std::mutex mutex_;
  std::deque<std::tuple<BatchStrip, std::size_t, std::size_t>> strips_;
};

/// `part`: shard and shards, 0 for all.
py::list registerAll(const std::filesystem::path& manifest, const std::filesystem::path& output,
                     const std::optional<std::string>& text, const std::tuple<bool, bool>& existing,
                     const std::vector<std::string>& items, const std::tuple<int, int>& part,
                     const std::tuple<int, double, bool>& limits, const py::object& progress,
                     const py::object& stop, int threads) {
  BatchSettings settings;
  settings.text = text;
  std::tie(settings.resume, settings.overwrite) = existing;
  settings.items = items;
  std::tie(settings.shard, settings.shards) = part;
  std::tie(settings.jobs, settings.memory_bytes, settings.pictures) = limits;
  const auto done = std::make_shared<Done>();
  // What waits for the work hears of a stage for each strip, and takes it from where it lies.
  py::object told = py::none();
  if (!progress.is_none()) {
    told = py::cpp_function([done, progress](const std::string& /*stage*/) {
      const auto [strip, number, of] = done->take();
      progress(valuesOf(strip), number, of);
    });
  }
  const bool tells = !progress.is_none();
  const std::vector<BatchStrip> strips =
      waitFor({told, stop}, threads, [&](const Control& control) {
        return registerBatch(manifest, output, settings, control,
                             [&](const BatchStrip& strip, std::size_t number, std::size_t of) {
                               if (!tells) return;
                               done->add(strip, number, of);
                               control.on_stage(strip.id);
                             });
      });
  py::list values;
  for (const BatchStrip& strip : strips) values.append(valuesOf(strip));
  return values;
}

}  // namespace
}  // namespace agricolmap::python

PYBIND11_MODULE(_batch, module) {
  module.doc() = "Many strips in one go; a part of the package agricolmap.";
  pybind11::module_::import("agricolmap._core");
  module.def("register_all", &agricolmap::python::registerAll);
}
