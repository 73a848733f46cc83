"""Reads captures with h5py alone and compares them with what they must hold.

A line on stdin is: RECORDING CAPTURE FRAMES. The first FRAMES rows of the capture, published or
not, must be bit-exact in pixels and id, and the samples beside them in counts.
Prints a line for each capture where they are not.
"""

import os
import sys

import h5py
import numpy as np

SAMPLES_PER_FRAME = 3


def expected(frame_id: int, shape: tuple[int, int]) -> np.ndarray:
    i = np.arange(shape[0] * shape[1], dtype=np.uint64)
    return ((frame_id * 2654435761 + i * np.uint64(40503)) & np.uint64(0xFFFF)).reshape(shape)


def complaint(recording: str, capture: int, frames: int) -> str | None:
    name = os.path.join(recording, "captures", f"{capture:06d}.h5")
    if not os.path.exists(name):
        name += ".partial"
    try:
        with h5py.File(name, "r") as file:
            for row in range(frames):
                frame_id = capture * 1000 + row
                pixels = file["frames"][row]
                if not np.array_equal(pixels, expected(frame_id, pixels.shape)):
                    return f"{name}: row {row} holds other pixels"
                if file["frame_records"][row]["camera_frame_id"] != frame_id:
                    return f"{name}: row {row} holds another record"
            count = frames * SAMPLES_PER_FRAME
            groups = file["photodiode/groups"]
            if groups["count"][groups["written"] == 1].sum() < count:
                return f"{name}: its groups cover fewer samples than were acknowledged"
            if not np.array_equal(file["photodiode/samples"]["counts"][:count], -np.arange(count)):
                return f"{name}: holds other samples"
    except (OSError, KeyError) as error:
        return f"{name}: {error}"
    return None


def main() -> None:
    for line in sys.stdin:
        recording, capture, frames = line.split()
        found = complaint(recording, int(capture), int(frames))
        if found:
            print(found)


if __name__ == "__main__":
    main()
