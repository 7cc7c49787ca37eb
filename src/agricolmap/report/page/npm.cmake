# agricolmap_fetch_npm(<source> <folder> <fetched>): what <source>/package-lock.json pins, into
# <folder>/node_modules, unless it is there already. <fetched> says whether it is: without npm, and
# without a network, the build goes on without it. Nothing of the packages is run to install them.
function(agricolmap_fetch_npm source folder fetched)
  set(${fetched} FALSE PARENT_SCOPE)
  find_program(AGRICOLMAP_NPM npm)
  find_program(AGRICOLMAP_NODE node)
  if(NOT AGRICOLMAP_NPM OR NOT AGRICOLMAP_NODE)
    message(STATUS "No 3-D view in report.html: npm is missing; install the packages nodejs and npm")
    return()
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${source}/package.json ${source}/package-lock.json)
  file(SHA256 ${source}/package-lock.json lock)
  set(stamp ${folder}/fetched)
  set(there "")
  if(EXISTS ${stamp})
    file(READ ${stamp} there)
  endif()
  if(NOT there STREQUAL lock)
    file(COPY ${source}/package.json ${source}/package-lock.json DESTINATION ${folder})
    message(STATUS "Fetching the packages of the 3-D view (npm ci)")
    execute_process(
      COMMAND ${AGRICOLMAP_NPM} ci --ignore-scripts --no-audit --no-fund --fetch-retries=1
      WORKING_DIRECTORY ${folder} TIMEOUT 300
      RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
      message(STATUS "No 3-D view in report.html: npm could not fetch its packages:\n${output}")
      return()
    endif()
    file(WRITE ${stamp} ${lock})
  endif()
  set(${fetched} TRUE PARENT_SCOPE)
endfunction()
