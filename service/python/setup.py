"""Generates the message modules into the package that is being built; see eyebox/_stubs.py."""

import importlib.util
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = Path(__file__).resolve().parent


def _stubs():
    """eyebox/_stubs.py by itself: the package cannot be imported before its stubs are there."""
    spec = importlib.util.spec_from_file_location("_stubs", HERE / "eyebox" / "_stubs.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class BuildWithStubs(build_py):
    def run(self):
        super().run()
        stubs = _stubs()
        stubs.generate(stubs.PROTO_FOLDER, Path(self.build_lib))


setup(cmdclass={"build_py": BuildWithStubs})
