"""Measures through the service: creates a run, shows its progress, downloads every file of it.

    python3 -m eyebox.measure --recording left_eye --out result
    python3 -m eyebox.measure --rig sim:rift-s-like --out result
"""

import argparse
import sys
from typing import Optional, Sequence

import eyebox

_BAR_CELLS = 30


def _options(arguments: Optional[Sequence[str]]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--address", default="unix:eyebox.sock", help="of `eyebox serve`")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--recording", help="its path below the server's data folder")
    source.add_argument("--rig", help="sim:NAME, to capture with first")
    parser.add_argument("--out", required=True, help="folder for the files of the result")
    parser.add_argument("--request-id", help="the same one gives the same job (default: random)")
    return parser.parse_args(arguments)


def _show(update: eyebox.Update) -> None:
    text = f"{100 * update.progress:3.0f} %  {update.step}"
    if not sys.stderr.isatty():
        print(f"eyebox: {text}", file=sys.stderr)
        return
    bar = ("#" * int(_BAR_CELLS * update.progress)).ljust(_BAR_CELLS, ".")
    print(f"\r\033[K[{bar}] {text}", end="", file=sys.stderr, flush=True)


def _measure(options: argparse.Namespace) -> None:
    with eyebox.connect(options.address) as client:
        job = client.run(recording=options.recording, rig=options.rig,
                         request_id=options.request_id)
        for update in job.watch():
            _show(update)
        if sys.stderr.isatty():
            print(file=sys.stderr)
        for parameter in job.result().parameters:
            print(f"  {parameter.name:24} {parameter.value:12.6g} +- {parameter.sigma:<10.3g} "
                  f"{'' if parameter.unit == '1' else parameter.unit}")
        files = job.download_all(options.out)
        print(f"{job.name}: {len(files)} files in {options.out}")


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Exit status 0 done, 2 usage, 3 refused or failed, 4 no server."""
    options = _options(arguments)
    try:
        _measure(options)
    except eyebox.ServerUnavailable as error:
        print(f"measure: {error}", file=sys.stderr)
        return 4
    except (eyebox.EyeboxError, OSError) as error:
        print(f"measure: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
