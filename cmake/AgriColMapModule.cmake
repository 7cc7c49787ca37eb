# Compile flags shared by every target of this project, kept off what we import.
add_library(agricolmap_flags INTERFACE)
target_include_directories(agricolmap_flags INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(agricolmap_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Wold-style-cast -Wcast-align -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion
  $<$<BOOL:${AGRICOLMAP_WERROR}>:-Werror>
  $<$<BOOL:${AGRICOLMAP_ARCH}>:-march=${AGRICOLMAP_ARCH}>)
if(AGRICOLMAP_SANITIZE)
  add_compile_options(-fsanitize=${AGRICOLMAP_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${AGRICOLMAP_SANITIZE})
endif()

# agricolmap_module(<name> SOURCES ... [DEPS ...] [TESTS ...])
# A static library agricolmap_<name> from one folder and, from the *_test.cpp beside its sources,
# a test program <name>_test whose cases ctest lists one by one.
function(agricolmap_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;TESTS" ${ARGN})
  add_library(agricolmap_${name} STATIC ${ARG_SOURCES})
  add_library(agricolmap::${name} ALIAS agricolmap_${name})
  target_link_libraries(agricolmap_${name} PUBLIC agricolmap_flags ${ARG_DEPS})
  if(AGRICOLMAP_BUILD_TESTS AND ARG_TESTS)
    add_executable(${name}_test ${ARG_TESTS})
    target_link_libraries(${name}_test PRIVATE agricolmap_${name} GTest::gmock GTest::gtest_main)
    gtest_discover_tests(${name}_test TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS unit TIMEOUT 300)
  endif()
endfunction()
