#!/usr/bin/env bash
# check_sizes.sh FOLDER...: fails when a source below the folders has more than 400 lines, or a C++
# function there more than 60 between its braces. Folders that do not exist are passed over.
#
# Functions are told by their shape, which clang-format fixes: the closing brace stands alone, as far
# to the right as the head; classes, enums and namespaces end in other ways.
set -euo pipefail

folders=()
for folder in "$@"; do
  [[ ! -d $folder ]] || folders+=("$folder")
done
[[ ${#folders[@]} -gt 0 ]] || { echo "check_sizes: none of these folders exists: $*" >&2; exit 1; }

find "${folders[@]}" -type f \( -name '*.[ch]pp' -o -name '*.py' -o -name '*.cmake' \) -print0 | sort -z |
  xargs -0 awk '
    function check(file, line, what, length_, limit) {
      if (length_ <= limit) return
      printf "%s:%d: %s has %d lines; at most %d are allowed\n", file, line, what, length_, limit
      failures++
    }
    function nextFile() {
      if (files > 0) check(file, 1, "the file", lines, 400)
      file = FILENAME
      files++
      waiting = -1
      split("", opened)
    }
    FNR == 1 { nextFile() }
    { lines = FNR }
    file !~ /[.][ch]pp$/ || /^ *(#|\/\/|$)/ || /^ *(public|protected|private):$/ { next }
    {
      sub(/ *\/\/.*$/, "")
      match($0, /^ */)
      depth = RLENGTH
    }
    # The rest of a head that takes several lines.
    waiting >= 0 && depth > waiting {
      if (/[{]$/) opened[waiting] = FNR
      if (/[{};]$/) waiting = -1
      next
    }
    /^ *}$/ && depth in opened {
      functions++
      check(file, opened[depth], "the function of this head", FNR - opened[depth] - 1, 60)
    }
    {
      delete opened[depth]
      if (/[{]$/) opened[depth] = FNR
      waiting = /[{};]$/ ? -1 : depth
    }
    END {
      nextFile()
      if (functions == 0) print "check_sizes: no function found"
      printf "%d files, %d blocks in braces, %d too long\n", files - 1, functions, failures
      exit failures > 0 || functions == 0
    }
  '
