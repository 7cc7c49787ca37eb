# cmake -DEXAMPLE=examples/01_register.cpp -DREADME=README.md -P check_readme_example.cmake
# Fails when the README does not show the example as it is built and run.
cmake_minimum_required(VERSION 3.25)
file(READ ${EXAMPLE} example)
file(READ ${README} readme)
string(FIND "${readme}" "```cpp\n${example}```" place)
if(place EQUAL -1)
  message(FATAL_ERROR "${README} does not show ${EXAMPLE} word for word")
endif()
