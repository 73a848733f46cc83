"""Message modules (eyebox.v1.*_pb2): part of the installed package, or generated when first used.

In a checkout they are generated from proto/ into a cache folder named after their content, or into
$EYEBOX_STUBS, and never into the source tree.
"""

import hashlib
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

PROTO_FOLDER = Path(__file__).resolve().parents[3] / "proto"
_NEWEST = "job_service_pb2_grpc.py"  # an older package has the others alone


def find(package_path):
    """Makes eyebox.v1 importable: extends the package's __path__ where it is not part of it."""
    if (Path(package_path[0]) / "v1" / _NEWEST).exists():
        return
    folder = Path(os.environ["EYEBOX_STUBS"]) if "EYEBOX_STUBS" in os.environ else _cache_folder()
    if not (folder / "eyebox" / "v1" / _NEWEST).exists():
        _generate_whole(folder)
    package_path.append(str(folder / "eyebox"))


def generate(protos, folder):
    """Runs protoc; the modules are folder/eyebox/v1/*_pb2.py and *_pb2_grpc.py."""
    folder.mkdir(parents=True, exist_ok=True)
    command = [*_compiler(), f"-I{protos}", f"--python_out={folder}", f"--grpc_python_out={folder}",
               *_protos(protos)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        raise RuntimeError(f"{' '.join(command)} failed: {run.stderr.strip()}")


def _protos(folder):
    return sorted(str(file.relative_to(folder)) for file in Path(folder).glob("eyebox/v1/*.proto"))


def _compiler():
    protoc, plugin = shutil.which("protoc"), shutil.which("grpc_python_plugin")
    if protoc and plugin:
        return [protoc, f"--plugin=protoc-gen-grpc_python={plugin}"]
    raise RuntimeError("protoc or grpc_python_plugin is missing; "
                       "apt-get install protobuf-compiler protobuf-compiler-grpc")


def _cache_folder():
    digest = hashlib.sha256()
    for proto in _protos(PROTO_FOLDER) or ["eyebox/v1/service.proto"]:
        try:
            digest.update((PROTO_FOLDER / proto).read_bytes())
        except OSError as error:
            raise RuntimeError(f"{error.filename} cannot be read; use the package from a checkout "
                               "of the project or install it with pip") from error
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return cache / "eyebox" / f"stubs-{digest.hexdigest()[:16]}"


def _generate_whole(folder):
    """Generates beside and renames: two scripts that start at once do not read half a module."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as partial:
        generate(PROTO_FOLDER, Path(partial) / "stubs")
        try:
            os.rename(Path(partial) / "stubs", folder)
        except OSError:  # another script was first
            if not (folder / "eyebox" / "v1" / _NEWEST).exists():
                raise
