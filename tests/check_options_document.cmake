# cmake -DAGRICOLMAP=... -DDOCUMENT=docs/options.md -P check_options_document.cmake
# Fails when the document is not what the program prints.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${AGRICOLMAP} document-options OUTPUT_VARIABLE expected
                COMMAND_ERROR_IS_FATAL ANY)
file(READ ${DOCUMENT} actual)
if(NOT actual STREQUAL expected)
  message(FATAL_ERROR "${DOCUMENT} is out of date; run: agricolmap document-options > docs/options.md")
endif()
