#!/usr/bin/env python3
"""add.py TREE COPY ADDITION...: the files that additions touch, as they would be in the tree.

An addition is a folder with files by their paths in the tree. NAME.lines holds lines for a file NAME that the tree has: those
under "@@ TEXT" go behind the first line that contains TEXT, those under "@= TEXT" take its place. Prints the paths, one a line.
"""
import pathlib
import sys


def with_lines(text, more, name):
    rows = text.splitlines(keepends=True)
    for hunk in more.removeprefix("@").split("\n@"):
        head, _, lines = hunk.partition("\n")
        kind, place = head[0], head[2:]
        at = next((i for i, row in enumerate(rows) if place in row), None)
        if at is None:
            sys.exit(f"add.py: {name}: no line contains {place}")
        rows[at + (kind == "@"):at + 1] = [lines if lines.endswith("\n") else lines + "\n"]
    return "".join(rows)


tree, copy = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
texts = {}
for addition in map(pathlib.Path, sys.argv[3:]):
    for path in sorted(addition.rglob("*")):
        if path.is_file():
            name = path.relative_to(addition)
            if path.suffix != ".lines":
                texts[name] = path.read_text()
                continue
            name = name.with_suffix("")
            text = texts.get(name) or (tree / name).read_text()
            texts[name] = with_lines(text, path.read_text(), name)
for name, text in texts.items():
    out = copy / name
    out.parent.mkdir(parents=True, exist_ok=True)
    if not out.exists() or out.read_text() != text:
        out.write_text(text)
    print(name)
