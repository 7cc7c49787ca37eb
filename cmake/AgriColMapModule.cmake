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

# What most sources include takes longer to read than they themselves: it is read once, for the
# libraries, and once more for the tests, whose flags differ. A compiler launcher does without, since
# ccache keeps nothing that is made with precompiled headers unless it is told to be sloppy about them;
# so do the strict presets, which find what a source uses without including it.
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
set(AGRICOLMAP_PRECOMPILED
  <algorithm> <array> <cmath> <filesystem> <functional> <limits> <memory> <numbers> <optional> <span>
  <string> <string_view> <utility> <vector>
  <Eigen/Dense> <fmt/format.h>)

# agricolmap_precompile(<target> <owner> [HEADER...]): the target reads what its owner has precompiled;
# its own owner precompiles.
function(agricolmap_precompile target owner)
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Beside precompiled ones g++ 12 warns of std::string's own copying (GCC bugs 105329, 105651).
    target_compile_options(${target} PRIVATE
      -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
  endif()
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${AGRICOLMAP_PRECOMPILED} ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# agricolmap_precompile_test(<target>): as above, with the headers of the test framework.
function(agricolmap_precompile_test target)
  agricolmap_precompile(${target} core_test <gmock/gmock.h> <gtest/gtest.h>)
endfunction()

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
  agricolmap_precompile(agricolmap_${name} agricolmap_core)
  if(AGRICOLMAP_BUILD_TESTS AND ARG_TESTS)
    add_executable(${name}_test ${ARG_TESTS})
    target_link_libraries(${name}_test PRIVATE agricolmap_${name} GTest::gmock GTest::gtest_main)
    agricolmap_precompile_test(${name}_test)
    gtest_discover_tests(${name}_test TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS unit TIMEOUT 300)
  endif()
endfunction()

# agricolmap_revision(<target> <header> <constant> <otherwise> <folder>...): a target that keeps
# generated/<header> at the state of the sources in these folders.
function(agricolmap_revision target header constant otherwise)
  set(file ${CMAKE_CURRENT_BINARY_DIR}/generated/${header})
  list(JOIN ARGN "," watched)
  add_custom_target(${target}
    COMMAND ${CMAKE_COMMAND} -DHEADER=${file} -DSOURCE=${PROJECT_SOURCE_DIR} -DNAME=${constant}
            -DOTHERWISE=${otherwise} -DWATCHED=${watched}
            -P ${PROJECT_SOURCE_DIR}/cmake/write_revision.cmake
    BYPRODUCTS ${file}
    VERBATIM)
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
