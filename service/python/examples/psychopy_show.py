#!/usr/bin/env python3
"""Shows what the server asks for with PsychoPy, and measures the display.

    python3 psychopy_show.py --address unix:eyebox.sock --rig rigs/lab.textproto --name left_eye

The window must not change what is drawn: no gamma correction in PsychoPy, none in the system's
colour profile.
"""

import argparse

import numpy
from psychopy import core, event, visual

import eyebox

BOARD_SQUARES = 64  # on each side of the middle: more than any field holds
SETTLE_S = 0.2  # from the flip to a steady panel, beside what the rig measures itself


class Patches:
    """A full field, a disk or a checkerboard of any grey or colour."""

    def __init__(self, degrees_per_height: float) -> None:
        self._window = visual.Window(fullscr=True, color=(-1, -1, -1), units="height",
                                     allowGUI=False, gammaErrorPolicy="raise")
        self._degrees_per_height = degrees_per_height
        self._disk = visual.Circle(self._window, edges=256, lineWidth=0)

    def show(self, stimulus: eyebox.Stimulus) -> None:
        """Returns once the patch is on the display."""
        if stimulus.kind != "light":  # the experimenter covers the lens or shows the reference
            self._ask(stimulus.instruction)
            return
        drawn = tuple(2 * drive - 1 for drive in stimulus.drive)  # PsychoPy counts from -1 to 1
        black = (-1, -1, -1)
        patch = self._disk
        if stimulus.pattern == "full_field":
            self._window.color = drawn
        elif stimulus.pattern == "checkerboard":
            patch = self._board(drawn, stimulus.diameter_deg)
        else:
            on_black = stimulus.pattern == "disk"
            self._window.color = black if on_black else drawn
            self._disk.fillColor = drawn if on_black else black
            self._disk.size = stimulus.diameter_deg / self._degrees_per_height
        for _ in range(2):  # a new background colour is cleared to with the next flip
            if stimulus.pattern != "full_field":
                patch.draw()
            self._window.flip()
        core.wait(SETTLE_S)

    def _board(self, drawn, side_deg: float) -> visual.ImageStim:
        """Four squares meet in the middle, the one above it to the left is bright."""
        row, column = numpy.indices((2 * BOARD_SQUARES, 2 * BOARD_SQUARES))
        bright = (row + column) % 2 == 0  # BOARD_SQUARES is even
        image = numpy.where(bright[..., None], drawn, (-1.0, -1.0, -1.0))
        size = 2 * BOARD_SQUARES * side_deg / self._degrees_per_height
        return visual.ImageStim(self._window, image=image[::-1], size=(size, size),
                                interpolate=False)

    def _ask(self, instruction: str) -> None:
        self._window.color = (-1, -1, -1)
        text = visual.TextStim(self._window, f"{instruction}\n\nthen press a key", height=0.05)
        for _ in range(2):
            text.draw()
            self._window.flip()
        event.waitKeys()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--address", default="unix:eyebox.sock")
    parser.add_argument("--rig", required=True)
    parser.add_argument("--name", required=True, help="of the recording")
    parser.add_argument("--degrees-per-height", type=float, default=90)
    options = parser.parse_args()
    patches = Patches(options.degrees_per_height)
    with eyebox.connect(options.address) as client:
        captured = client.run_plan(patches.show, options.name, options.rig)
        run = client.run(recording=captured.recording)
        run.watch_with_bar()
        run.download_all(options.name)


if __name__ == "__main__":
    main()
