# Compile flags shared by every target of this project, kept off what we import and off those who
# link the installed library.
add_library(agricolmap_flags INTERFACE)
target_include_directories(agricolmap_flags INTERFACE
  ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
target_compile_options(agricolmap_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Wold-style-cast -Wcast-align -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion
  $<$<BOOL:${AGRICOLMAP_WERROR}>:-Werror>
  -fno-math-errno -fno-trapping-math
  $<$<BOOL:${AGRICOLMAP_ARCH}>:-march=${AGRICOLMAP_ARCH}>)
if(AGRICOLMAP_SANITIZE)
  add_compile_options(-fsanitize=${AGRICOLMAP_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${AGRICOLMAP_SANITIZE})
endif()

# agricolmap_module(<name> SOURCES ... [DEPS ...] [TESTS ...])
# A static library agricolmap_<name> from one folder and, from the *_test.cpp beside its sources,
# a test program <name>_test whose cases ctest lists one by one.
#
# Internal: the libraries hand their flags, -march above all, to all that is made of them, since
# Eigen's types differ with it. They can become part of a shared library, and show nothing there.
function(agricolmap_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;TESTS" ${ARGN})
  add_library(agricolmap_${name} STATIC ${ARG_SOURCES})
  add_library(agricolmap::${name} ALIAS agricolmap_${name})
  target_link_libraries(agricolmap_${name} PUBLIC agricolmap_flags ${ARG_DEPS})
  set_target_properties(agricolmap_${name} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  if(AGRICOLMAP_BUILD_TESTS AND ARG_TESTS)
    add_executable(${name}_test ${ARG_TESTS})
    target_link_libraries(${name}_test PRIVATE agricolmap_${name} GTest::gmock GTest::gtest_main)
    gtest_discover_tests(${name}_test TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS unit TIMEOUT 300)
  endif()
endfunction()

# agricolmap_require_found(<package> <debian package> <option> <purpose>) ends with a remedy unless
# the package was found.
function(agricolmap_require_found package debian option purpose)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "${package} is missing, which ${purpose} needs: install ${debian}, or build "
                        "without: -D${option}=OFF")
  endif()
endfunction()

# agricolmap_require(...): looks for it first.
macro(agricolmap_require package debian option purpose)
  find_package(${package})
  agricolmap_require_found(${package} ${debian} ${option} ${purpose})
endmacro()
