"""The files of the project and what a rule says about them."""

import fnmatch
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

SKIPPED_FOLDERS = {"build", "out", "node_modules", "third_party", "__pycache__", ".git", ".cache"}


@dataclass(frozen=True)
class Finding:
    path: str
    line: int  # 1-based; 0 for the file as a whole
    message: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.message}" if self.line else f"{self.path}: {self.message}"


def matches(path, globs):
    return any(fnmatch.fnmatchcase(path, glob) for glob in globs)


class Tree:
    """All text files below `root`, by their path relative to it."""

    def __init__(self, root):
        self.root = Path(root)

    @cached_property
    def texts(self):
        found = {}
        for folder, folders, names in os.walk(self.root):
            folders[:] = sorted(f for f in folders
                                if f not in SKIPPED_FOLDERS and not f.endswith(".egg-info"))
            for name in sorted(names):
                file = Path(folder, name)
                data = file.read_bytes() if file.is_file() else b"\0"
                if b"\0" not in data:
                    path = file.relative_to(self.root).as_posix()
                    found[path] = data.decode("utf-8", errors="replace")
        return found

    def paths(self, *globs):
        return [path for path in self.texts if matches(path, globs)]

    @property
    def cpp_paths(self):
        return self.paths("*.cc", "*.h", "*.cpp", "*.hpp")

    def exists(self, path):
        return (self.root / path).exists()
