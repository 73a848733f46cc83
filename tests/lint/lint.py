#!/usr/bin/env python3
"""Checks the project against the tables of tests/lint/tables.py.

    tests/lint/lint.py [ROOT]

Prints one line per finding and exits 1 if there is any.
"""

import sys
from pathlib import Path

import rules
from tree import Tree


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
    tree = Tree(root)
    if not tree.cpp_paths:
        sys.exit(f"lint: {root} holds no C++ file; name the root of the project")
    count = 0
    for rule in rules.ALL:
        for finding in rule(tree):
            print(f"{finding}  [{rule.__name__}]")
            count += 1
    print(f"lint: {len(tree.texts)} files, {len(rules.ALL)} rules, {count} findings")
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
