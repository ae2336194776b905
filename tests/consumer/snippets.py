#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""snippets.py ROOT: every C++ block of README.md and docs/*.md stands, word for word, in a program of docs/examples, which
the other tests of this folder compile and run. "// ..." in a block stands for lines left out. And every test that docs/gltf.md
names is there: titles in quotes (their beginnings), functions and scenes in the last column of its tables."""
import pathlib
import re
import sys


def lines_of(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


def stands_in(parts, program):
    at = 0
    for part in parts:
        while at + len(part) <= len(program) and program[at:at + len(part)] != part:
            at += 1
        if at + len(part) > len(program):
            return False
        at += len(part)
    return True


root = pathlib.Path(sys.argv[1])
programs = [lines_of(path.read_text()) for path in sorted((root / "docs/examples").glob("*.cpp"))]
pages = [root / "README.md", *sorted((root / "docs").glob("*.md"))]
found = wrong = 0
for page in pages:
    for block in re.finditer(r"^```(?:cpp|c\+\+)\n(.*?)^```", page.read_text(), re.M | re.S):
        found += 1
        parts = [part for part in (lines_of(p) for p in re.split(r"^\s*// \.\.\.\s*$", block.group(1), flags=re.M)) if part]
        if not any(stands_in(parts, program) for program in programs):
            wrong += 1
            line = page.read_text()[:block.start()].count("\n") + 1
            print(f"{page.relative_to(root)}:{line}: this block is in no program of docs/examples")
if not found or not programs:
    sys.exit("no C++ block, or no program, was found")
titles = [t for path in (root / "tests/unit").glob("*.cpp") for t in re.findall(r'TEST_CASE\(\s*"([^"]+)"', path.read_text())]
python = "".join(path.read_text() for path in (root / "tests/cli").glob("*.py"))
named = 0
for row in re.findall(r"^\| (?!---|feature)(.*) \|$", (root / "docs/gltf.md").read_text(), re.M):
    last = row.split(" | ")[-1]
    for title in re.findall(r'"([^"]+)"', last):
        named += 1
        if not any(t.startswith(title) for t in titles):
            wrong += 1
            print(f'docs/gltf.md names the test "{title}", which is not there')
    for name in re.findall(r"`(\w+)`", last):
        if not name.startswith("test_") and "all scenes" not in last and "with `" not in last:
            continue
        named += 1
        if f"def {name}(" not in python and f"'{name}." not in python:
            wrong += 1
            print(f"docs/gltf.md names {name}, which is not there")
if not named:
    sys.exit("docs/gltf.md names no test")
print(f"{found} blocks, {len(programs)} programs, {named} tests named")
sys.exit(1 if wrong else 0)
