# Writes ${HEADER} with the state of the sources that rows depend on, so that no campaign mixes rows
# of different code. Called at every build; touches the header only when it changes.
set(revision unknown)
set(watched src experiments/pairs experiments/methods experiments/runner ":(exclude)*_test.cpp")
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
set(text "#pragma once\n\ninline constexpr const char* kRevision = \"${revision}\";\n")
if(EXISTS ${HEADER})
  file(READ ${HEADER} before)
endif()
if(NOT text STREQUAL "${before}")
  file(WRITE ${HEADER} "${text}")
endif()
