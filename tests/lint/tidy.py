#!/usr/bin/env python3
"""Runs clang-tidy over the sources of a configured build folder, two at a time or as cores allow.

    tests/lint/tidy.py BUILD [FOLDER ...]

FOLDER is a top-level folder of the project; capture, optics and fit unless given. A source that
passed is read again only after it, a header of ours that it includes, or .clang-tidy has changed:
what passed is noted below $XDG_CACHE_HOME/eyebox/tidy (or ~/.cache) for every checkout.
Prints the findings and exits 1 if there is any.
"""

import hashlib
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cpp

ROOT = Path(__file__).resolve().parents[2]
PASSED = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "eyebox" / "tidy"
GCC_ONLY = re.compile(r" -f(?:vect-cost-model=\S+|no-tree-\S+|tree-\S+)"
                      r"| -Winvalid-pch| -include \S+cmake_pch\.hxx")


def sources_of(build, folders):
    """Writes the compile commands without what clang does not know; yields the chosen sources."""
    commands = json.loads((build / "compile_commands.json").read_text())
    for command in commands:
        command["command"] = GCC_ONLY.sub("", command["command"])
    (build / "tidy").mkdir(exist_ok=True)
    (build / "tidy" / "compile_commands.json").write_text(json.dumps(commands))
    files = sorted({Path(command["file"]) for command in commands})
    return [file for file in files if file.is_relative_to(ROOT)
            and file.relative_to(ROOT).parts[0] in folders]


def closure_of(file, seen):
    """`file` and every header of ours that it includes, itself or through another."""
    if file not in seen and file.is_file():
        seen.add(file)
        for _, include in cpp.includes_of(file.read_text()):
            closure_of(ROOT / include, seen)
    return seen


def digest_of(file):
    inputs = sorted(closure_of(file, set())) + [ROOT / ".clang-tidy"]
    named = (path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes()
             for path in inputs)
    return hashlib.sha256(b"\0".join(named)).hexdigest()


def tidy(build, file):
    """Returns clang-tidy's output, empty if `file` is clean."""
    passed = PASSED / digest_of(file)
    if passed.is_file():
        return ""
    run = subprocess.run(["clang-tidy", "--quiet", "-p", build / "tidy", file],
                         capture_output=True, text=True, check=False)
    if run.returncode:
        return run.stdout + run.stderr
    PASSED.mkdir(parents=True, exist_ok=True)
    passed.write_text(file.relative_to(ROOT).as_posix() + "\n")
    return ""


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    build = Path(sys.argv[1]).resolve()
    files = sources_of(build, sys.argv[2:] or ["capture", "optics", "fit"])
    if not files:
        sys.exit(f"tidy: {build} compiles no source of these folders")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        outputs = [output for output in pool.map(lambda file: tidy(build, file), files) if output]
    print("\n".join(outputs), end="")
    print(f"tidy: {len(files)} sources, {len(outputs)} with findings")
    sys.exit(1 if outputs else 0)


if __name__ == "__main__":
    main()
