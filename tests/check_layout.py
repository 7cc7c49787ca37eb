#!/usr/bin/python3
"""tests/check_layout.py COMPILER INCLUDE LAYOUT.txt [FLAG...]: have the types of the public headers kept their shape?

A program that was built with 1.0 runs with any later 1.x only while every type that it was compiled with has the
size and its members the places that they had. Compiles all headers in INCLUDE/agricolmap, reads what the debugger
is told of namespace agricolmap, and compares it with LAYOUT.txt, a line for each type, member and enumerator.
Types and enumerators may join; a line that is gone or differs breaks the promise. `--update` in place of FLAG writes
LAYOUT.txt anew. Exit code: 0 the same, 1 not, 2 usage, 77 on a processor other than the one of LAYOUT.txt.
"""
import difflib
import platform
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROCESSOR = "x86_64"
ENTRY = re.compile(r"^ <(\w+)><\w+>: Abbrev Number: (\d+)(?: \((\w+)\))?")
VALUE = re.compile(r"^\s+<\w+>\s+(DW_AT_\w+)\s*: (?:\([^)]*\):? ?)*(.*)$")  # without the form in brackets
TYPES = ("DW_TAG_structure_type", "DW_TAG_class_type", "DW_TAG_enumeration_type")


def described(compiler, include, flags):
    """What the debugger is told of all public headers, in lines."""
    with tempfile.TemporaryDirectory() as folder:
        source, built = Path(folder) / "all.cpp", Path(folder) / "all.o"
        headers = sorted(path.name for path in (include / "agricolmap").glob("*.hpp"))
        source.write_text("".join(f"#include <agricolmap/{name}>\n" for name in headers))
        subprocess.run([compiler, "-std=c++20", "-g", "-fno-eliminate-unused-debug-types", f"-I{include}", *flags,
                        "-c", source, "-o", built], check=True)
        command = ["readelf", "--debug-dump=info", "--wide", built]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, errors="replace") as reading:
            yield from reading.stdout


def entries(lines):
    """(depth, tag, values) of each; only the values that tell a layout."""
    current = None
    for line in lines:
        if begin := ENTRY.match(line):
            if current:
                yield current
            current = (int(begin[1], 16), begin[3] or "", {})
        elif current and (value := VALUE.match(line)):
            current[2][value[1]] = value[2].strip()
    if current:
        yield current


def layout(lines):
    """Lines of the types of namespace agricolmap, members after their type, in order of names."""
    scopes, found = [], {}
    for depth, tag, values in entries(lines):
        name = values.get("DW_AT_name", "")
        del scopes[depth - 1:]
        inside = scopes[:1] == ["agricolmap"]
        scopes += [""] * (depth - 1 - len(scopes))
        scopes.append(name if tag == "DW_TAG_namespace" or tag in TYPES else "")
        if not inside or "" in scopes[:-1]:
            continue
        scope = "::".join(scopes[:-1])
        if tag in TYPES and name and "DW_AT_byte_size" in values:
            found.setdefault(f"{scope}::{name}", [f"{values['DW_AT_byte_size']} bytes"])
        elif tag == "DW_TAG_member" and "DW_AT_data_member_location" in values:
            found[scope].append(f".{name} at {values['DW_AT_data_member_location']}")
        elif tag == "DW_TAG_inheritance":
            found[scope].append(f"base at {values['DW_AT_data_member_location']}")
        elif tag == "DW_TAG_enumerator":
            found[scope].append(f"{name} = {values['DW_AT_const_value']}")
    return [f"{name} {line}" for name in sorted(found) for line in found[name]]


def main():
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    compiler, include, kept, flags = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4:]
    if platform.machine() != PROCESSOR:
        print(f"{kept} is of {PROCESSOR}, this is {platform.machine()}")
        return 77
    update = "--update" in flags
    now = layout(described(compiler, include, [flag for flag in flags if flag != "--update"]))
    if not now:
        print("the compiler's debug information shows no type of namespace agricolmap", file=sys.stderr)
        return 1
    if update:
        kept.write_text("\n".join(now) + "\n")
        return 0
    changed = [line for line in difflib.ndiff(kept.read_text().splitlines(), now) if line[0] in "+-"]
    gone = [line for line in changed if line[0] == "-"]
    types = {line.split(" ")[0] for line in kept.read_text().splitlines()}
    # Another enumerator moves nothing; another member does.
    grown = [line for line in changed
             if line[0] == "+" and line[2:].split(" ")[0] in types and " = " not in line]
    if gone or grown:
        print("\n".join(gone + grown))
        print(f"programs that were built before do not run with this library: undo it, or with a new SOVERSION "
              f"--update {kept.name}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
