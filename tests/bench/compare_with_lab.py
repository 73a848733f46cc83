#!/usr/bin/env python3
"""Eyebox and a laboratory's own script (lab_script.py) on one simulated recording, in one run: what
each gives, how far each is from the truth that made the frames, and how long each takes.

    tests/bench/compare_with_lab.py EYEBOX [RIG]

Exit 1 where Eyebox is further than 4 of its sigmas from the truth, or where the two disagree beyond
what noise explains; 77 without SciPy or h5py.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np

    import lab_script
except ImportError as missing:
    print(f"skipped: {missing}; apt-get install python3-numpy python3-scipy python3-h5py")
    sys.exit(77)

LARGEST_SIGMAS = 4
LARGEST_DIFFERENCE = 0.02  # of gamma and white, between the two


def run(*command):
    began = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - began


def eyebox_result(eyebox, recording, out):
    seconds = run(eyebox, "run", str(recording), "--out", str(out))
    result = json.loads((out / "activation.json").read_text())
    return seconds, {p["name"]: (p["value"], p.get("sigma", 0)) for p in result["parameters"]}


def worst_map(one, other):
    valid = np.isfinite(one) & np.isfinite(other)
    return float(np.sqrt(np.mean((one[valid] / other[valid] - 1) ** 2)))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    eyebox, rig = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "sim:rift-s-like"
    with tempfile.TemporaryDirectory() as folder:
        recording, out = pathlib.Path(folder, "rec"), pathlib.Path(folder, "out")
        run(eyebox, "simulate", rig, "--out", str(recording))
        eyebox_s, ours = eyebox_result(eyebox, recording, out)
        began = time.perf_counter()
        lab = lab_script.measure(recording)
        lab_s = time.perf_counter() - began
        truth = json.loads((recording / "truth.json").read_text())
        true_g = np.load(recording / "truth_g.npy")
        our_g = np.load(out / "uniformity_g.npy")
    print(f"{'':20} {'truth':>10} {'Eyebox':>20} {'script':>10}")
    failed = False
    known_as = {"gamma": "gamma", "minimum_luminance": "minimum_luminance_cd_m2",
                "luminance_range": "luminance_range_cd_m2"}
    for name, key in known_as.items():
        value, sigma = ours[name]
        known = truth[key]
        print(f"{name:20} {known:10.4f} {value:10.4f} +- {sigma:6.4f} {lab[name]:10.4f}")
        if abs(value - known) > LARGEST_SIGMAS * sigma:
            print(f"  {name}: Eyebox is {abs(value - known) / sigma:.1f} sigma from the truth")
            failed = True
        if name != "minimum_luminance" and abs(lab[name] / value - 1) > LARGEST_DIFFERENCE:
            print(f"  {name}: the two differ by {100 * abs(lab[name] / value - 1):.1f} %")
            failed = True
    print(f"{'g, rms off the truth':20} {'':10} {100 * worst_map(our_g, true_g):18.3f} % "
          f"{100 * worst_map(lab['uniformity'], true_g):8.3f} %")
    every_place_s = lab["fit_s_per_place"] * lab["pixels"]
    print(f"{'time':20} {'':10} {eyebox_s:18.2f} s {lab_s:8.2f} s")
    print(f"Eyebox: the whole run, with the field fitted at {lab['pixels']} places, tables, "
          f"certificates and report.\nScript: {lab['read_s']:.2f} s to read, {lab['reduce_s']:.2f} "
          f"s to reduce, {lab['fits']} places fitted at {1e6 * lab['fit_s_per_place']:.0f} us; all "
          f"of them would take {every_place_s:.1f} s.")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
