// LASzip, loaded where the first compressed file is met: on systems without it all but LAZ works.
#pragma once

#include <laszip/laszip_api.h>

#include <optional>

namespace agricolmap::io {

/// The functions of LASzip's C interface that are used here, by their names without `laszip_`.
struct LaszipLibrary {
  decltype(&::laszip_create) create = nullptr;
  decltype(&::laszip_destroy) destroy = nullptr;
  decltype(&::laszip_get_error) get_error = nullptr;
  decltype(&::laszip_get_point_pointer) get_point_pointer = nullptr;
  decltype(&::laszip_decompress_selective) decompress_selective = nullptr;
  decltype(&::laszip_open_reader_stream) open_reader_stream = nullptr;
  decltype(&::laszip_read_point) read_point = nullptr;
  decltype(&::laszip_close_reader) close_reader = nullptr;
  decltype(&::laszip_set_point_type_and_size) set_point_type_and_size = nullptr;
  decltype(&::laszip_request_native_extension) request_native_extension = nullptr;
  decltype(&::laszip_create_laszip_vlr) create_laszip_vlr = nullptr;
  decltype(&::laszip_set_chunk_size) set_chunk_size = nullptr;
  decltype(&::laszip_open_writer_stream) open_writer_stream = nullptr;
  decltype(&::laszip_write_point) write_point = nullptr;
  decltype(&::laszip_close_writer) close_writer = nullptr;
};

/// The library of that file name, where there is one that has all these functions.
std::optional<LaszipLibrary> loadLaszip(const char* file);

/// The one that this was built with, looked for once; null where the system has none.
const LaszipLibrary* laszip();

/// What to do where there is none.
inline constexpr const char* kNoLaszip =
    "this system has no LASzip; install liblaszip8 (Debian 13 has it, and what Debian 13 has works "
    "on Debian 12), or ";

}  // namespace agricolmap::io
