# Writes ${HEADER} with a constant ${NAME}: the newest commit of the sources below ${WATCHED}, tests left out,
# with a plus and a digest where they differ from it; ${OTHERWISE} where that is not to be had. Called at
# every build by what agricolmap_revision() makes; touches the header only when it changes.
set(revision "${OTHERWISE}")
string(REPLACE "," ";" watched "${WATCHED}")
list(APPEND watched ":(exclude)*_test.cpp")
find_package(Git QUIET)
if(Git_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} log -1 --format=%h -- ${watched}
                  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  execute_process(COMMAND ${GIT_EXECUTABLE} diff HEAD -- ${watched}
                  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE changes ERROR_QUIET)
  if(commit)
    set(revision ${commit})
    if(changes)
      string(SHA1 changes "${changes}")
      string(SUBSTRING ${changes} 0 8 changes)
      string(APPEND revision "+${changes}")
    endif()
  endif()
endif()
set(text "#pragma once\n\ninline constexpr const char* ${NAME} = \"${revision}\";\n")
if(EXISTS ${HEADER})
  file(READ ${HEADER} before)
endif()
if(NOT text STREQUAL "${before}")
  file(WRITE ${HEADER} "${text}")
endif()
