#!/usr/bin/env python3
"""That compare tells better, worse and no longer reached apart, and that every row of the table
names a benchmark and counters that exist."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import rows

HERE = pathlib.Path(__file__).resolve().parent


def figure(value, better="lower", met=None, work="reduction"):
    return {"work": work, "case": "all", "value": value, "better": better, "met": met}


class Compare(unittest.TestCase):
    def compare(self, before, after, *options):
        with tempfile.TemporaryDirectory() as folder:
            paths = [pathlib.Path(folder, name) for name in ("before.json", "after.json")]
            for path, figures in zip(paths, (before, after)):
                path.write_text(json.dumps({"figures": figures}))
            return subprocess.run([sys.executable, HERE / "compare", *paths, *options],
                                  capture_output=True, text=True)

    def test_a_change_within_the_noise_is_none(self):
        done = self.compare([figure(4.0)], [figure(4.4)])
        self.assertEqual((done.returncode, "WORSE" in done.stdout), (0, False), done.stdout)

    def test_slower_is_worse_whichever_way_the_figure_counts(self):
        for before, after in ((figure(4.0), figure(6.0)),
                              (figure(6.0, "higher"), figure(4.0, "higher"))):
            done = self.compare([before], [after])
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn("0.67 WORSE", done.stdout)

    def test_faster_is_better(self):
        done = self.compare([figure(6.0)], [figure(3.0)])
        self.assertEqual(done.returncode, 0)
        self.assertIn("2.00 better", done.stdout)

    def test_a_row_that_no_longer_reaches_is_worse_within_the_noise(self):
        done = self.compare([figure(2.9, met=True)], [figure(3.1, met=False)])
        self.assertEqual(done.returncode, 1)
        self.assertIn("no longer reached", done.stdout)

    def test_frames_lost_where_none_were(self):
        self.assertEqual(self.compare([figure(0)], [figure(0)]).returncode, 0)
        self.assertEqual(self.compare([figure(0)], [figure(2)]).returncode, 1)

    def test_rows_of_one_side_are_told(self):
        done = self.compare([figure(1)], [figure(1, work="scatter")])
        self.assertIn("only in before", done.stdout)
        self.assertIn("only in after", done.stdout)

    def test_the_noise_can_be_stated(self):
        self.assertEqual(self.compare([figure(4)], [figure(6)], "--noise", "0.6").returncode, 0)

    def test_a_file_that_is_none_of_ours(self):
        done = subprocess.run([sys.executable, HERE / "compare", HERE / "rows.py", "missing"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("rows.py", done.stderr)


class Rows(unittest.TestCase):
    def test_every_row_names_what_exists(self):
        for row in rows.ROWS:
            source = (HERE / f"{row.program}.cc").read_text()
            self.assertIn(row.case.split("/")[0], source, row)
            for name in (row.counter, *row.beside):
                self.assertIn(f'counters["{name}"]', source, row)

    def test_a_reach_counts_only_where_it_was_stated(self):
        row = rows.Row("w", "p", "c", "n", "u", 3, reach_only="side_px:2048")
        self.assertIs(row.met("side_px:548", 9), None)
        self.assertIs(row.met("side_px:2048", 9), False)
        self.assertIs(row.met("side_px:2048", 3), True)


if __name__ == "__main__":
    unittest.main()
