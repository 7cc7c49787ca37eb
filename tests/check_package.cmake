# cmake -DNM=nm -DLIBRARY=libagricolmap.so -DSYMBOLS=library_symbols.txt -DPACKAGE=<prefix>
#       -P check_package.cmake
# Fails when the library shows symbols that no public header declares, when one of those that programs
# were linked to is gone, or when its package hands the project's compile flags or private dependencies
# to consumers. New symbols are added to the list by
#   nm -D --defined-only libagricolmap.so | awk '$2 == "T" {print $3}' | LC_ALL=C sort
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${NM} -DC --defined-only ${LIBRARY}
                OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE ";" "," symbols "${symbols}")
string(REPLACE "\n" ";" symbols "${symbols}")
# Of rooms, each a namespace, and of what stands in core beside them.
set(inside ${symbols})
list(FILTER inside INCLUDE REGEX " agricolmap::([a-z_]+::|OptionTable|Random|parallel)")
foreach(symbol IN LISTS inside)
  message(SEND_ERROR "${LIBRARY} shows ${symbol}")
endforeach()
list(FILTER symbols INCLUDE REGEX " agricolmap::registerClouds")
if(NOT symbols)
  message(SEND_ERROR "${LIBRARY} does not show registerClouds")
endif()

execute_process(COMMAND ${NM} -D --defined-only ${LIBRARY}
                OUTPUT_VARIABLE shown COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${SYMBOLS} promised)
foreach(symbol IN LISTS promised)
  if(NOT shown MATCHES " T ${symbol}\n")
    message(SEND_ERROR "${LIBRARY} has no ${symbol} any more: programs that were linked to it will not start. "
                       "Bring it back; or, with a new version of the library, take it off ${SYMBOLS}")
  endif()
endforeach()

file(GLOB_RECURSE package ${PACKAGE}/*/agricolmap-*.cmake)
if(NOT package)
  message(SEND_ERROR "no package in ${PACKAGE}")
endif()
foreach(file IN LISTS package)
  file(STRINGS ${file} foreign REGEX "[ ;\"]-[mWf][a-z]|TBB|fmt|spdlog|yaml|liblzf|GDAL|CAIRO|PNG")
  foreach(line IN LISTS foreign)
    message(SEND_ERROR "${file} hands on: ${line}")
  endforeach()
endforeach()
