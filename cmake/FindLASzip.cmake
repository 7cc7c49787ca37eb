# LASzip 3 as Debian 13 packages it (liblaszip-dev): the target LASzip::LASzip; LASzip_NAME, by which a
# running program asks the system for it.
find_path(LASzip_INCLUDE_DIR laszip/laszip_api.h)
find_library(LASzip_LIBRARY laszip)
mark_as_advanced(LASzip_INCLUDE_DIR LASzip_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LASzip REQUIRED_VARS LASzip_LIBRARY LASzip_INCLUDE_DIR)
if(LASzip_FOUND)
  if(IS_SYMLINK ${LASzip_LIBRARY})
    file(READ_SYMLINK ${LASzip_LIBRARY} LASzip_NAME)
    cmake_path(GET LASzip_NAME FILENAME LASzip_NAME)
  else()
    cmake_path(GET LASzip_LIBRARY FILENAME LASzip_NAME)
  endif()
endif()
if(LASzip_FOUND AND NOT TARGET LASzip::LASzip)
  add_library(LASzip::LASzip UNKNOWN IMPORTED)
  set_target_properties(LASzip::LASzip PROPERTIES
    IMPORTED_LOCATION ${LASzip_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${LASzip_INCLUDE_DIR})
endif()
