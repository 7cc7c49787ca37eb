#include "agricolmap/io/las/laszip_library.hpp"

#include <dlfcn.h>

#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {
namespace {

template <typename Function>
bool find(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(::dlsym(library, name));
  return function != nullptr;
}

bool findAll(void* from, LaszipLibrary& to) {
  // Three of them are exported by the names that a C++ compiler makes.
  return find(from, "laszip_create", to.create) && find(from, "laszip_destroy", to.destroy) &&
         find(from, "laszip_get_error", to.get_error) &&
         find(from, "laszip_get_point_pointer", to.get_point_pointer) &&
         find(from, "laszip_decompress_selective", to.decompress_selective) &&
         find(from, "_Z25laszip_open_reader_streamPvRSiPi", to.open_reader_stream) &&
         find(from, "laszip_read_point", to.read_point) &&
         find(from, "laszip_close_reader", to.close_reader) &&
         find(from, "laszip_set_point_type_and_size", to.set_point_type_and_size) &&
         find(from, "laszip_request_native_extension", to.request_native_extension) &&
         find(from, "_Z24laszip_create_laszip_vlrPvPPhPj", to.create_laszip_vlr) &&
         find(from, "laszip_set_chunk_size", to.set_chunk_size) &&
         find(from, "_Z25laszip_open_writer_streamPvRSoii", to.open_writer_stream) &&
         find(from, "laszip_write_point", to.write_point) &&
         find(from, "laszip_close_writer", to.close_writer);
}

}  // namespace

std::optional<LaszipLibrary> loadLaszip(const char* file) {
  void* const library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return std::nullopt;
  LaszipLibrary functions;
  if (!findAll(library, functions)) {
    ::dlclose(library);
    return std::nullopt;
  }
  return functions;  // the library stays, as one that is linked does
}

const LaszipLibrary* laszip() {
  static const std::optional<LaszipLibrary> library = [] {
    const std::optional<LaszipLibrary> found = loadLaszip(AGRICOLMAP_LASZIP_NAME);
    return found ? found : loadLaszip(AGRICOLMAP_LASZIP_FILE);
  }();
  return library ? &*library : nullptr;
}

bool hasLaz() { return laszip() != nullptr; }

}  // namespace agricolmap::io
