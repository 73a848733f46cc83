#!/usr/bin/env python3
"""The script that a laboratory would write for a recording: darks taken off, exposures averaged
where they do not saturate, divided by the flat; gamma fitted at the image centre and in every
place of the field; the uniformity map. NumPy, SciPy and h5py alone. A yardstick for
compare_with_lab.py, not a part of Eyebox: it states no uncertainty of what it gives.

    tests/bench/lab_script.py RECORDING [EVERY]     EVERY: fit each so-manieth place per axis
"""
import json
import pathlib
import re
import sys
import time

import h5py
import numpy as np
from scipy.optimize import curve_fit

SATURATED_DN = 4000
CENTRE_RADIUS = 0.02  # of the smaller side, as Eyebox takes it


def read(recording):
    """Mean frames: darks and flats by exposure, lights by drive and exposure; flat's cd/m2."""
    darks, flats, lights, luminance = {}, {}, {}, None
    for file in sorted(pathlib.Path(recording, "captures").glob("*.h5")):
        with h5py.File(file) as capture:
            meta = capture["meta/capture"][()].decode()
            frames = capture["frames"][()].astype(np.float64).mean(axis=0)
        exposure = float(re.search(r"exposure_s: (\S+)", meta)[1])
        if "FRAME_KIND_DARK" in meta:
            darks[exposure] = frames
        elif "FRAME_KIND_FLAT" in meta:
            flats[exposure] = frames
            luminance = float(re.search(r"luminance_cd_m2: (\S+)", meta)[1])
        else:
            drive = re.search(r"red: (\S+)", meta)
            lights.setdefault(float(drive[1]) if drive else 0.0, {})[exposure] = frames
    return darks, flats, lights, luminance


def rate(frames, darks):
    """DN/s: the longest exposure of each pixel that does not saturate."""
    result = None
    for exposure in sorted(frames):
        here = (frames[exposure] - darks[exposure]) / exposure
        if result is None:
            result = here
        else:
            result = np.where(frames[exposure] < SATURATED_DN, here, result)
    return result


def model(v, black, span, cutoff, gamma):
    return black + span * np.clip((v - cutoff) / (1 - cutoff), 0, None) ** gamma


def fit(drives, values):
    start = (max(values[0], 1e-3), values[-1] - values[0], 0.0, 2.2)
    bounds = ([0, 0, 0, 0.5], [np.inf, np.inf, 0.5, 5])
    return curve_fit(model, drives, values, p0=start, bounds=bounds,
                     sigma=np.maximum(values, 1e-2 * values[-1]))[0]


def measure(recording, every=8):
    began = time.perf_counter()
    darks, flats, lights, luminance = read(recording)
    read_s = time.perf_counter() - began
    flat = rate(flats, darks)
    drives = np.array(sorted(lights))
    stack = np.array([rate(lights[v], darks) / flat * luminance for v in drives])
    reduced_s = time.perf_counter() - began - read_s
    height, width = flat.shape
    y, x = np.mgrid[:height, :width]
    radius = CENTRE_RADIUS * min(width, height)
    disk = np.hypot(x - (width - 1) / 2, y - (height - 1) / 2) <= radius
    centre = np.array([np.median(level[disk]) for level in stack])
    black, span, cutoff, gamma = fit(drives, centre)
    uniformity = stack[-1] / centre[-1]
    fit_began = time.perf_counter()
    places = [fit(drives, stack[:, j, i])[3]
              for j in range(0, height, every) for i in range(0, width, every)]
    fits_s = time.perf_counter() - fit_began
    return {
        "gamma": gamma, "cutoff_drive": cutoff, "minimum_luminance": black,
        "luminance_range": span, "uniformity": uniformity, "read_s": read_s,
        "reduce_s": reduced_s, "fits": len(places), "fit_s_per_place": fits_s / len(places),
        "gamma_of_places": float(np.median(places)), "pixels": width * height,
    }


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    result = measure(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 8)
    result.pop("uniformity")
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
