# cmake -DWEB=web -DSCRIPTS=a.js,b.js -DBUNDLE=view3d.js -DOUTPUT=page_assets.cpp -P embed.cmake
# Writes the page's sources into C++ as text. SCRIPTS, in the order of what they use, become one: they
# are modules, whose one-line imports and whose word `export` fall away, so that the page needs no
# bundler. BUNDLE: the 3-D view as the bundler made it; empty where there is none.
cmake_minimum_required(VERSION 3.25)

set(closing ")page\"")
function(append_text name text)
  # What would end the string, or the element of the page that it is put into.
  foreach(end IN ITEMS "${closing}" "</script" "</style")
    string(FIND "${text}" "${end}" at)
    if(NOT at EQUAL -1 AND NOT name STREQUAL "pageTemplate")
      message(FATAL_ERROR "${name}: the page cannot hold '${end}'")
    endif()
  endforeach()
  file(APPEND ${OUTPUT} "\nstd::string_view ${name}() {\n  return R\"page(${text})page\";\n}\n")
endfunction()

file(WRITE ${OUTPUT} "// Made by embed.cmake.\n"
  "#include \"agricolmap/report/page/page_assets.hpp\"\n\nnamespace agricolmap::report {\n")
file(READ ${WEB}/page.html template)
append_text(pageTemplate "${template}")
file(READ ${WEB}/page.css style)
append_text(pageStyle "${style}")

set(script "(() => {\n\"use strict\";\n")
string(REPLACE "," ";" names "${SCRIPTS}")
set(known)
foreach(name IN LISTS names)
  file(READ ${WEB}/${name} text)
  # They share one scope, in which the last of two functions of a name would win without a word.
  string(REGEX MATCHALL "\n(export )?(async )?(function|const|let|class) [A-Za-z0-9_]+" heads "\n${text}")
  foreach(head IN LISTS heads)
    string(REGEX REPLACE ".* " "" head "${head}")
    if(head IN_LIST known)
      message(FATAL_ERROR "${name}: another script of the page defines '${head}', too")
    endif()
    list(APPEND known ${head})
  endforeach()
  string(REGEX REPLACE "\nimport [^\n]* from \"[^\n]*\";" "" text "\n${text}")
  string(REGEX REPLACE "\nexport " "\n" text "${text}")
  if(text MATCHES "\n(import|export) ?[^\n]*")
    message(FATAL_ERROR "${name}: an import must be of one line: ${CMAKE_MATCH_0}")
  endif()
  string(APPEND script "${text}")
endforeach()
string(APPEND script "})();\n")
append_text(pageScript "${script}")

set(bundle "")
if(BUNDLE)
  file(READ ${BUNDLE} bundle)
endif()
append_text(pageScript3d "${bundle}")
file(APPEND ${OUTPUT} "\n}  // namespace agricolmap::report\n")
