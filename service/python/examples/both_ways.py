#!/usr/bin/env python3
"""Measures a rig both ways round, draws the uniformity map and fetches the table.

    eyebox serve --listen unix:eyebox.sock --data data &
    python3 both_ways.py --address unix:eyebox.sock --rig sim:rift-s-like --out result

Written from README.md alone; `show` below stands for whatever presents stimuli in the lab.
"""

import argparse
import sys
from pathlib import Path

import eyebox


def show(stimulus: eyebox.Stimulus) -> None:
    """Here a lab draws the patch and waits for the frame to be on the display."""
    print(stimulus.instruction or stimulus, file=sys.stderr)


def told_what_to_show(client: eyebox.Client, rig: str, levels: int) -> eyebox.Job:
    """The server carries out the plan and says what comes next."""
    return client.run_plan(show, recording="told", rig=rig, plan=client.plan(levels=levels))


def deciding_what_to_show(client: eyebox.Client, rig: str, levels: int) -> eyebox.Job:
    """This script goes through the plan and asks for each capture."""
    plan = client.plan(levels=levels)
    session = client.session("decided", rig, plan=plan)
    for spec in plan.captures:
        show(eyebox.Stimulus.of(spec))
        captured = session.capture(spec)
        print(f"capture {captured.number}: {captured.mean_dn:.1f} +- {captured.sigma_dn:.2f} DN")
    return session.finish()


def draw(uniformity: eyebox.Map, path: Path) -> None:
    """A grey image of g, white where it is largest; portable graymap, which needs no library."""
    import numpy
    g = numpy.nan_to_num(uniformity.value, nan=0.0)
    grey = (255 * g / g.max()).astype(numpy.uint8)
    path.write_bytes(b"P5 %d %d 255\n" % (grey.shape[1], grey.shape[0]) + grey.tobytes())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--address", default="unix:eyebox.sock")
    parser.add_argument("--rig", default="sim:rift-s-like")
    parser.add_argument("--levels", type=int, default=17)
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args()
    with eyebox.connect(options.address) as client:
        for capture in (told_what_to_show, deciding_what_to_show):
            captured = capture(client, options.rig, options.levels)
            run = client.run(recording=captured.recording)
            run.watch_with_bar()
            out = options.out / capture.__name__
            run.download_all(out)
            for parameter in run.result().parameters:
                print(parameter.name, parameter.value, "+-", parameter.sigma, parameter.unit)
            draw(run.map("g"), out.with_suffix(".pgm"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
