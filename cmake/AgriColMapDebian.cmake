# Debian packages by CPack: agricolmap (the program), libagricolmap<version>, libagricolmap-dev and, where
# it is built, python3-agricolmap.
# scripts/package builds and makes them. What they depend on is read from what was linked, so that
# they fit the Debian that they were made on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME agricolmap)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "AgriColMap")
set(CPACK_PACKAGE_CONTACT "AgriColMap maintainers <agricolmap@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program library development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Who links to the library depends on its package, and ldconfig hears of it.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
# Also for a library that is packaged beside the program that uses it.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src/agricolmap/api)

set(so_version ${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME agricolmap)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Registers coloured point clouds of one field, from the air and from the ground, to the centimetre, \
says how far the result can be trusted, and makes one shared map of them with plants counted.")
# Letters in pictures.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS fonts-dejavu-core)
# LAZ and COPC are read and written where it is there.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS liblaszip8)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libagricolmap${so_version})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS liblaszip8)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "The registration as a C++ library.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libagricolmap-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libagricolmap${so_version} (= ${PROJECT_VERSION}), agricolmap (= ${PROJECT_VERSION}), libeigen3-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers of the C++ library, and the CMake package agricolmap.")

set(packages program agricolmap library libagricolmap${so_version} development libagricolmap-dev)
if(TARGET python_core)
  list(APPEND CPACK_COMPONENTS_ALL python)
  list(APPEND packages python python3-agricolmap)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-agricolmap)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  # Extension modules are for the one version that they were built for.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "libagricolmap${so_version} (= ${PROJECT_VERSION}), python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), \
python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The registration, maps and crop facts from Python, with NumPy arrays.")
endif()

# Each has its licence and its history where Debian looks for them; the program what changed, too.
find_program(GZIP gzip REQUIRED)
set(changelog ${PROJECT_BINARY_DIR}/debian/changelog)
configure_file(${PROJECT_SOURCE_DIR}/cmake/debian-changelog ${changelog} COPYONLY)
# Without name and time, so that it is the same bytes every time.
execute_process(COMMAND ${GZIP} -9nkf ${changelog} COMMAND_ERROR_IS_FATAL ANY)
while(packages)
  list(POP_FRONT packages component package)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian-copyright RENAME copyright
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
  install(FILES ${changelog}.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endwhile()
install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/agricolmap COMPONENT program)
include(CPack)
