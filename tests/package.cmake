# The library from outside: its tests see the public headers and the shared libraries alone, and the
# examples are a project that finds what `cmake --install` put down.
add_executable(library_test library_change_test.cpp library_field_test.cpp library_maps_test.cpp library_ros_test.cpp
  library_stages_test.cpp library_test.cpp)
target_compile_definitions(library_test PRIVATE
  AGRICOLMAP_PAIRS="${PAIRS}" AGRICOLMAP_EXPECTED_VERSION="${PROJECT_VERSION}")
target_link_libraries(library_test PRIVATE
  agricolmap::agricolmap agricolmap::agricolmap_batch agricolmap::agricolmap_pictures
  nlohmann_json::nlohmann_json
  GTest::gtest_main)
gtest_discover_tests(library_test TEST_PREFIX "library." DISCOVERY_TIMEOUT 60
  PROPERTIES LABELS library FIXTURES_REQUIRED cli_pairs TIMEOUT 300)

set(INSTALLED ${CMAKE_CURRENT_BINARY_DIR}/installed)
set(EXAMPLES ${CMAKE_CURRENT_BINARY_DIR}/examples)
add_test(NAME library.install
  COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${INSTALLED})
set_tests_properties(library.install PROPERTIES FIXTURES_SETUP library_installed)
set(sanitize)
if(AGRICOLMAP_SANITIZE)
  set(sanitize "-DCMAKE_CXX_FLAGS=-fsanitize=${AGRICOLMAP_SANITIZE}")
endif()
add_test(NAME library.build_examples
  COMMAND ${CMAKE_CTEST_COMMAND}
    --build-and-test ${PROJECT_SOURCE_DIR}/examples ${EXAMPLES}
    --build-generator ${CMAKE_GENERATOR}
    --build-options -DCMAKE_PREFIX_PATH=${INSTALLED} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
                    ${sanitize})
set_tests_properties(library.build_examples PROPERTIES
  FIXTURES_REQUIRED library_installed FIXTURES_SETUP library_examples TIMEOUT 600)

# agricolmap_example(<name> <pair> [ARGUMENTS ...])
function(agricolmap_example name pair)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/ran/${name})
  file(MAKE_DIRECTORY ${folder})
  add_test(NAME library.${name}
    COMMAND ${EXAMPLES}/${name} ${PAIRS}/${pair}/uav/point_cloud.ply
            ${PAIRS}/${pair}/ugv/point_cloud.ply ${ARGN}
    WORKING_DIRECTORY ${folder})
  set_tests_properties(library.${name} PROPERTIES FIXTURES_REQUIRED "library_examples;cli_pairs")
endfunction()
agricolmap_example(01_register georeferenced)
agricolmap_example(02_options_and_verdict same_field ${PAIRS}/same_field/prior.txt)
agricolmap_example(03_own_points same_field ${PAIRS}/same_field/prior.txt)
agricolmap_example(04_progress_and_stop georeferenced)
agricolmap_example(05_report_and_pictures georeferenced results)

# Nothing of what the library is made of may show: neither in its symbols nor in its package.
add_test(NAME library.shows_only_its_own
  COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} -DLIBRARY=$<TARGET_FILE:agricolmap_library>
          -DSYMBOLS=${CMAKE_CURRENT_SOURCE_DIR}/library_symbols.txt
          -DPACKAGE=${INSTALLED} -P ${CMAKE_CURRENT_SOURCE_DIR}/check_package.cmake)
set_tests_properties(library.shows_only_its_own PROPERTIES FIXTURES_REQUIRED library_installed)
set_property(TEST library.install library.build_examples library.01_register
  library.02_options_and_verdict library.03_own_points library.04_progress_and_stop
  library.05_report_and_pictures library.shows_only_its_own PROPERTY LABELS library)
