#include "agricolmap/batch/run/shared_fixed.hpp"

#include <fmt/format.h>

#include "agricolmap/io/cloud/tiled_stream.hpp"

namespace agricolmap::batch {

std::shared_ptr<const run::LoadedFixed> SharedFixed::get(const io::MapFiles& files,
                                                         const io::CommonFrame& frame) {
  const std::string key = fmt::format(
      "{}\n{}\n{}\n{}\n{}", files.main.string(), files.model.value_or("").string(), frame.crs.wkt,
      frame.fixed_file ? frame.fixed_file->wkt : "", frame.fixed != nullptr);
  const std::scoped_lock lock(mutex_);
  const auto [found, is_new] = entries_.try_emplace(key);
  Entry& entry = found->second;
  if (is_new) {
    try {
      io::StreamOptions options;
      options.read.map = frame.fixed.get();
      options.on_pass = on_pass;
      options.crs = frame.crs;
      const auto stream = io::streamMap(files, options);
      entry.fixed =
          std::make_shared<const run::LoadedFixed>(std::make_unique<io::TiledStream>(*stream));
    } catch (...) {
      entry.error = std::current_exception();
    }
  }
  if (entry.error) std::rethrow_exception(entry.error);
  return entry.fixed;
}

}  // namespace agricolmap::batch
