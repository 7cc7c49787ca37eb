# What `cmake --install` puts where, and the package that find_package(agricolmap) finds.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(AGRICOLMAP_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/agricolmap)

# agricolmap_install(<component> <target>): the target, and its name for consumers, as a component of
# the package: agricolmap::<EXPORT_NAME of the target>. Debian packages are made of CMake's components
# `program`, `library` and `development`.
function(agricolmap_install component target)
  if(NOT AGRICOLMAP_INSTALL)
    return()
  endif()
  set(headers)
  get_target_property(header_sets ${target} INTERFACE_HEADER_SETS)
  if(header_sets)
    set(headers FILE_SET HEADERS)
  endif()
  if(headers)
    list(APPEND headers COMPONENT development)
  endif()
  install(TARGETS ${target} EXPORT agricolmap-${component}
    RUNTIME COMPONENT program
    LIBRARY COMPONENT library NAMELINK_COMPONENT development
    ${headers})
  install(EXPORT agricolmap-${component} NAMESPACE agricolmap:: DESTINATION ${AGRICOLMAP_PACKAGE_DIR}
    COMPONENT development)
endfunction()

if(AGRICOLMAP_INSTALL)
  configure_package_config_file(
    ${CMAKE_CURRENT_LIST_DIR}/agricolmap-config.cmake.in
    ${PROJECT_BINARY_DIR}/agricolmap-config.cmake
    INSTALL_DESTINATION ${AGRICOLMAP_PACKAGE_DIR}
    NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file(
    ${PROJECT_BINARY_DIR}/agricolmap-config-version.cmake COMPATIBILITY SameMajorVersion)
  install(FILES
    ${PROJECT_BINARY_DIR}/agricolmap-config.cmake
    ${PROJECT_BINARY_DIR}/agricolmap-config-version.cmake
    DESTINATION ${AGRICOLMAP_PACKAGE_DIR}
    COMPONENT development)
endif()
