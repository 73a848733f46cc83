"""The rules. Each takes the tree and yields findings; the tables decide what is allowed."""

import ast
import re
import shutil
import subprocess
from pathlib import PurePosixPath

import cpp
import tables
from tree import Finding, matches

_OURS = {folder.split("/")[0] for folder in tables.MAY_INCLUDE}


def _folder_of(path):
    """The longest folder of the layer table that holds `path`, or None."""
    parents = [parent.as_posix() for parent in PurePosixPath(path).parents]
    return next((parent for parent in parents if parent in tables.MAY_INCLUDE), None)


def _is_ours(include):
    return include.split("/")[0] in _OURS


def layers(tree):
    """A folder includes only from the folders that the layer table allows it."""
    for path in tree.cpp_paths:
        folder = _folder_of(path)
        if folder is None:
            yield Finding(path, 0, "C++ in a folder that tables.MAY_INCLUDE does not know")
            continue
        allowed = tables.MAY_INCLUDE[folder]
        for line, include in cpp.includes_of(tree.texts[path]):
            generated = include.startswith("eyebox/v1/")
            target = "proto/" if generated else include
            if (generated or _is_ours(include)) and \
                    not any(target.startswith(f"{a}/") for a in allowed):
                yield Finding(path, line, f"{folder} may not include {include}; "
                              f"it may include from: {', '.join(allowed)}")


def third_party(tree):
    """A library's headers are included only in its place."""
    for path in tree.cpp_paths:
        for line, include in cpp.includes_of(tree.texts[path]):
            if _is_ours(include):
                continue
            rows = [row for row in tables.THIRD_PARTY if re.fullmatch(row.headers, include)]
            if not rows and not include.startswith("eyebox/v1/"):
                yield Finding(path, line, f"{include} is in no row of tables.THIRD_PARTY; include "
                              "ours from the root of the project, or add the library's row")
            elif not path.startswith("tests/") and \
                    not all(matches(path, row.places) for row in rows):
                row = next(row for row in rows if not matches(path, row.places))
                yield Finding(path, line, f"{row.name} ({include}) belongs in "
                              f"{', '.join(row.places) or 'tests alone'}")


def _banned(bans, path, lines):
    for ban in bans:
        if matches(path, (ban.files,)) and not matches(path, ban.places):
            for number, line in enumerate(lines, 1):
                if ban.pattern.search(line):
                    yield Finding(path, number, f"{ban.what}: {ban.instead}")


def banned_code(tree):
    """What the code may not say: printing below service, exceptions, using namespace in headers."""
    for path in tree.cpp_paths:
        yield from _banned(tables.CODE_BANS, path, cpp.code_of(tree.texts[path]).splitlines())


def banned_text(tree):
    """What no text file may say: paths of one machine, globbed sources."""
    for path, text in tree.texts.items():
        yield from _banned(tables.TEXT_BANS, path, text.splitlines())


def file_length(tree):
    """A file stays within tables.MAX_FILE_LINES."""
    for path in tree.cpp_paths + tree.paths("*.py", "*.sh", "*.proto", "*CMakeLists.txt",
                                            "*.cmake", "check", "demo"):
        lines = tree.texts[path].count("\n")
        if lines > tables.MAX_FILE_LINES:
            yield Finding(path, 0, f"{lines} lines; split it, {tables.MAX_FILE_LINES} is the end")


def _python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield cpp.Function(node.name, node.lineno, node.end_lineno - node.lineno + 1)


def function_length(tree):
    """A function stays within tables.MAX_FUNCTION_LINES."""
    for path in tree.cpp_paths + tree.paths("*.py"):
        functions = _python_functions if path.endswith(".py") else cpp.functions_of
        for function in functions(tree.texts[path]):
            if function.lines > tables.MAX_FUNCTION_LINES:
                yield Finding(path, function.line, f"{function.name} has {function.lines} lines; "
                              f"split it, {tables.MAX_FUNCTION_LINES} is the end")


def include_guards(tree):
    """capture/base/status.h is guarded by EYEBOX_CAPTURE_BASE_STATUS_H_."""
    for path in tree.paths("*.h"):
        guard = "EYEBOX_" + re.sub(r"[^A-Z0-9]", "_", path.upper()) + "_"
        text = cpp.code_of(tree.texts[path])
        opening = re.match(rf"\s*#ifndef {guard}\n#define {guard}\n", text)
        if not opening or not re.search(r"#endif[ \t]*\s*\Z", text):
            yield Finding(path, 1, f"is not guarded by {guard}")


def whitespace(tree):
    """No space at the end of a line, one newline at the end of a file."""
    for path, text in tree.texts.items():
        if path.startswith(("fixtures/", "tests/fuzz/corpus/")):
            continue
        for number, line in enumerate(text.split("\n"), 1):
            if line != line.rstrip():
                yield Finding(path, number, "space at the end of the line")
        if text and (not text.endswith("\n") or text.endswith("\n\n")):
            yield Finding(path, 0, "does not end with exactly one newline")


def links(tree):
    """A relative link in a .md file names something that exists."""
    for path in tree.paths("*.md"):
        for number, line in enumerate(tree.texts[path].splitlines(), 1):
            for target in re.findall(r"\]\(([^)\s]+)[^)]*\)", line):
                file = target.split("#")[0]
                if file and not re.match(r"[a-z]+:", file) and \
                        not tree.exists(PurePosixPath(path).parent / file):
                    yield Finding(path, number, f"links to {target}, which does not exist")


def formatted(tree):
    """Every C++ file is as clang-format with .clang-format writes it."""
    if not shutil.which("clang-format"):
        yield Finding("tests/lint", 0, "clang-format is missing; run scripts/bootstrap.sh check")
        return
    if not tree.cpp_paths:
        return
    run = subprocess.run(["clang-format", "--dry-run", "--ferror-limit=1", *tree.cpp_paths],
                         cwd=tree.root, capture_output=True, text=True, check=False)
    for path, line in re.findall(r"^(.+?):(\d+):\d+: ", run.stderr, re.MULTILINE):
        yield Finding(path, int(line), "is not formatted; run clang-format -i on it")
    if run.returncode:
        yield Finding("tests/lint", 0, f"clang-format failed: {run.stderr.strip()}")


ALL = (layers, third_party, banned_code, banned_text, file_length, function_length,
       include_guards, whitespace, links, formatted)
