"""The Python client against the real server and the real pipeline.

    EYEBOX_BINARY=build/dev/bin/eyebox python3 python_client_test.py
"""

import filecmp
import json
import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import unittest
from datetime import datetime, timedelta, timezone
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[3] / "service" / "python"
sys.path.insert(0, str(PACKAGE))

import eyebox  # noqa: E402  found through the line above

EYEBOX = os.environ["EYEBOX_BINARY"]
LIMIT_S = 240


def run(*command, **options):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True,
                          timeout=LIMIT_S, check=False, **options)


class Server:
    """`eyebox serve` as a child process, ready when constructed."""

    def __init__(self, folder):
        self.address = f"unix:{folder}/eyebox.sock"
        self._process = subprocess.Popen(
            [EYEBOX, "serve", "--listen", self.address, "--data", f"{folder}/data",
             "--state", f"{folder}/state"], stdout=subprocess.PIPE, text=True)
        self.ready = self._process.stdout.readline()

    def stop(self, how=signal.SIGTERM):
        self._process.send_signal(how)
        self._process.communicate(timeout=LIMIT_S)
        return self._process.returncode


class PythonClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls._temporary.name)
        made = run(EYEBOX, "simulate", "sim:rift-s-like", "--seed", 5, "--levels", 7,
                   "--exposures", "0.0125,0.1", "--repeats", 2, "--out", cls.folder / "data/rec")
        assert made.returncode == 0, made.stderr
        cls.expected = cls.folder / "expected"
        done = run(EYEBOX, "run", cls.folder / "data/rec", "--out", cls.expected)
        assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls._temporary.cleanup()

    def setUp(self):
        self.server = Server(self.folder)
        self.addCleanup(lambda: self.server.stop())
        self.client = eyebox.connect(self.server.address)
        self.addCleanup(lambda: self.client.close())

    def assert_same_files(self, folder):
        names = sorted(path.name for path in self.expected.iterdir())
        self.assertEqual(sorted(path.name for path in folder.iterdir()), names)
        _, different, missing = filecmp.cmpfiles(self.expected, folder, names, shallow=False)
        self.assertEqual((different, missing), ([], []))
        self.assertIn("linearize.cube", names)
        self.assertIn("report.html", names)

    def test_server_says_when_it_is_ready_and_its_socket_is_private(self):
        self.assertIn(self.server.address, self.server.ready)
        mode = (self.folder / "eyebox.sock").stat().st_mode
        self.assertTrue(stat.S_ISSOCK(mode))
        self.assertEqual(stat.S_IMODE(mode), 0o660)

    def test_script_gives_the_bytes_of_the_command_line(self):
        out = self.folder / "by-script"
        done = run(sys.executable, PACKAGE / "measure.py", "--address", self.server.address,
                   "--recording", "rec", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("gamma", done.stdout)
        self.assertIn("100 %", done.stderr)
        self.assert_same_files(out)

    def test_job_outlives_the_server_that_was_killed(self):
        job = self.client.run(recording="rec", request_id="killed")
        first = next(job.watch())
        self.assertEqual(first.sequence, 1)
        self.server.stop(signal.SIGKILL)
        self.server = Server(self.folder)
        updates = list(job.watch(from_sequence=2))
        self.assertEqual([update.sequence for update in updates],
                         list(range(2, 2 + len(updates))))
        self.assertEqual(updates[-1].state, "SUCCEEDED")
        self.assertEqual(self.client.run(recording="rec", request_id="killed").name, job.name)
        job.download_all(self.folder / "after-kill")
        self.assert_same_files(self.folder / "after-kill")

    def test_rig_gives_the_bytes_of_the_command_line(self):
        out = self.folder / "by-command"
        done = run(EYEBOX, "run", "sim:rift-s-like", "--out", out,
                   "--recording", self.folder / "rig-recording")
        self.assertEqual(done.returncode, 0, done.stderr)
        job = self.client.run(rig="sim:rift-s-like")
        files = job.download_all(self.folder / "by-rig")
        self.assertEqual(sorted(file.name for file in files),
                         sorted(path.name for path in out.iterdir()))
        for file in files:
            self.assertEqual(file.read_bytes(), (out / file.name).read_bytes(), file.name)

    def test_script_from_the_readme_captures_both_ways_round(self):
        made = run(EYEBOX, "simulate", "sim:rift-s-like", "--seed", 1, "--levels", 5,
                   "--out", self.folder / "without-server")
        self.assertEqual(made.returncode, 0, made.stderr)
        by_command = self.folder / "without-server-result"
        done = run(EYEBOX, "run", self.folder / "without-server", "--out", by_command)
        self.assertEqual(done.returncode, 0, done.stderr)
        out = self.folder / "both-ways"
        done = run(sys.executable, PACKAGE / "examples" / "both_ways.py", "--address",
                   self.server.address, "--levels", 5, "--out", out,
                   env={**os.environ, "PYTHONPATH": str(PACKAGE)})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("capture 1:", done.stdout)
        names = sorted(path.name for path in by_command.iterdir())
        for way in ("told_what_to_show", "deciding_what_to_show"):
            self.assertEqual(sorted(path.name for path in (out / way).iterdir()), names)
            _, different, missing = filecmp.cmpfiles(by_command, out / way, names, shallow=False)
            self.assertEqual((different, missing), ([], []), way)
            self.assertGreater((out / f"{way}.pgm").stat().st_size, 1000)

    def test_maps_come_with_their_unit_and_uncertainty(self):
        import numpy
        g = self.client.run(recording="rec").map("g")
        self.assertEqual(g.unit, "1")
        self.assertEqual(g.value.shape, g.sigma.shape)
        self.assertLess(abs(numpy.nanmedian(g.value) - 1), 0.5)
        self.assertGreater(numpy.nanmin(g.sigma), 0)

    def test_result_is_the_message_that_the_command_line_prints(self):
        from google.protobuf import json_format
        from eyebox.v1 import results_pb2
        wanted = json_format.Parse((self.expected / "result.json").read_text(),
                                   results_pb2.RunResult())
        self.assertEqual(self.client.run(recording="rec", request_id="r").result(), wanted)

    def test_recordings_are_listed_filtered_and_paged(self):
        rec = [one for one in self.client.recordings() if one.name == "rec"][0]
        self.assertEqual((rec.state, rec.rig, rec.origin), ("COMPLETE", "rift-s-like", "SIMULATED"))
        self.assertEqual(rec.series, ("",))
        self.assertGreater(rec.frames, rec.captures)
        header = (self.folder / "data/rec/recording.textproto").read_text()
        start_ns = int(re.search(r"created_real_ns: (\d+)", header)[1])
        self.assertEqual(rec.start, datetime.fromtimestamp(0, timezone.utc)
                         + timedelta(microseconds=start_ns // 1000))
        for number in range(3):
            shutil.copytree(self.folder / "data/rec", self.folder / f"data/listed/{number}")
        (self.folder / "data/listed/1/captures/000001.h5").unlink()
        listed = 'name = "recordings/listed/*"'
        whole = [one.name for one in self.client.recordings(listed + " AND state = COMPLETE",
                                                            order_by="name desc", page_size=1)]
        self.assertEqual(whole, ["listed/2", "listed/0"])
        (damaged,) = self.client.recordings(listed + " AND state = DAMAGED")
        self.assertIn("000001.h5", damaged.problem)
        self.assertIsNone(damaged.start)
        with self.assertRaises(eyebox.InvalidRequest) as caught:
            next(self.client.recordings("state = COMPLETE OR rig = a"))
        self.assertEqual(caught.exception.where, "filter")
        self.assertIn("character 18", str(caught.exception))
        shutil.rmtree(self.folder / "data/listed")

    def test_errors_carry_the_field_and_the_advice(self):
        with self.assertRaises(eyebox.InvalidRequest) as caught:
            self.client.run(recording="../secret")
        self.assertEqual(caught.exception.where, "recording")
        self.assertIn("give", caught.exception.advice)
        with self.assertRaises(eyebox.NotFound):
            self.client.run(recording="missing")
        with self.assertRaises(eyebox.NotFound):
            self.client.job("jobs/999999")

    def test_plans_and_prices_are_those_of_the_command_line(self):
        scenes = PACKAGE.parents[1] / "fixtures/scenes/requirements"
        shutil.copy(scenes / "01-grey-patch-central.textproto", self.folder / "data/scene.textproto")
        sim = {"name": "rift-s-like", "camera_uri": "sim:rift-s-like", "seed": 1}
        planned = self.client.create(plan={"scene": "scene.textproto", "simulated": sim,
                                           "tolerance": 0.02}, request_id="plan")
        files = planned.download_all(self.folder / "planned")
        self.assertEqual(sorted(path.name for path in files), ["plan.textproto", "result.json"])
        done = run(EYEBOX, "plan", "--scene", self.folder / "data/scene.textproto", "--tolerance",
                   "2%", "sim:rift-s-like", "--out", self.folder / "by-hand.textproto")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.folder / "planned/plan.textproto").read_bytes(),
                         (self.folder / "by-hand.textproto").read_bytes())
        self.assertIn('"plan.textproto"', (self.folder / "planned/result.json").read_text())
        priced = self.client.create(tradeoff={"recording": "rec", "trials": 2}, request_id="prices")
        files = priced.download_all(self.folder / "priced")
        self.assertEqual(sorted(path.name for path in files),
                         ["result.json", "tradeoff.csv", "tradeoff.json", "tradeoff.svg"])
        self.assertIn("baseline,", (self.folder / "priced/tradeoff.csv").read_text())
        self.assertEqual(json.loads((self.folder / "priced/result.json").read_text())["source"],
                         "rec")

    def test_scatter_is_measured_taken_out_and_judged_as_on_the_command_line(self):
        from eyebox.v1 import results_pb2, scatter_pb2
        made = run(EYEBOX, "simulate", "sim:rift-s-like", "--levels", 2, "--disks", "1,4,16",
                   "--black-disks", "3,10", "--checkerboards", 5, "--out", self.folder / "data/haze")
        self.assertEqual(made.returncode, 0, made.stderr)
        source = {"recording": "haze"}
        scatter = self.client.create(scatter={"series": source}).message(
            scatter_pb2.ScatterResult)
        kernel = self.folder / "kernel.json"
        done = run(EYEBOX, "scatter", self.folder / "data/haze", "--json")
        kernel.write_text(done.stdout)
        for level in ("0", "1"):
            seen = self.client.create(reduce={"source": source, "level": float(level)}).message(
                results_pb2.ReduceResult)
            clean = self.client.create(reduce={"source": {
                **source, "scatter": scatter, "surround": "continued"}, "level": float(level)})
            maps = [path.name for path in clean.download_all(self.folder / f"clean{level}")]
            self.assertIn("luminance_scatter_sigma.npy", maps)
            done = run(EYEBOX, "reduce", self.folder / "data/haze", "--level", level, "--scatter",
                       kernel, "--surround", "continued", "--json")
            by_hand = {one["name"]: one["value"] for one in json.loads(done.stdout)["parameters"]}
            value = {one.name: one.value for one in clean.message(
                results_pb2.ReduceResult).parameters}
            self.assertNotIn("scatter_removed_share", [one.name for one in seen.parameters])
            self.assertEqual(value["mean"], by_hand["mean"])
        contrast = self.client.create(contrast={"source": source, "scatter": scatter}).message(
            scatter_pb2.ContrastResult)
        done = run(EYEBOX, "contrast", self.folder / "data/haze", "--scatter", kernel, "--json")
        figures = json.loads(done.stdout)["figures"]
        self.assertEqual([one.name for one in contrast.figures], [one["name"] for one in figures])
        self.assertEqual([one.value for one in contrast.figures], [one["value"] for one in figures])
        self.assertIn("checkerboard_contrast_of_display", [one["name"] for one in figures])
        for verb, work, where in (
                ("contrast", {"source": {**source, "scatter": scatter}}, "contrast.source.scatter"),
                ("reduce", {"source": {**source, "surround": "dark"}}, "reduce.source.surround"),
                ("uniformity", {"source": {**source, "scatter": scatter, "surround": "light"}},
                 "uniformity.source.surround")):
            with self.subTest(where), self.assertRaises(eyebox.InvalidRequest) as caught:
                self.client.create(**{verb: work})
            self.assertEqual(caught.exception.where, where)
        shutil.rmtree(self.folder / "data/haze")

    def test_plans_and_prices_that_make_no_sense_are_refused_by_field(self):
        sim = {"name": "rift-s-like", "camera_uri": "sim:rift-s-like", "seed": 1}
        plan = {"scene": "scene.textproto", "simulated": sim}
        for verb, work, where in (
                ("tradeoff", {}, "tradeoff.source"),
                ("tradeoff", {"simulated": sim, "trials": 1}, "tradeoff.trials"),
                ("tradeoff", {"simulated": sim, "costs": {"frame_s": -1}},
                 "tradeoff.costs.frame_s"),
                ("tradeoff", {"recording": "../rec"}, "tradeoff.recording"),
                ("plan", {"scene": "scene.textproto"}, "plan.pilot"),
                ("plan", {**plan, "scene": "/etc/passwd"}, "plan.scene"),
                ("plan", {**plan, "tolerance": 1.0}, "plan.tolerance"),
                ("plan", {**plan, "budget_s": float("nan")}, "plan.budget_s"),
                ("plan", {**plan, "costs": {"stimulus_s": float("inf")}},
                 "plan.costs.stimulus_s")):
            with self.subTest(where), self.assertRaises(eyebox.InvalidRequest) as caught:
                self.client.create(**{verb: work})
            self.assertEqual(caught.exception.where, where)
        with self.assertRaises(eyebox.InvalidRequest) as caught:
            self.client.run(recording="rec", clip_sigmas=2)
        self.assertEqual(caught.exception.where, "clip_sigmas")
        (self.folder / "data/cube.textproto").write_text('cube_file: "x.cube"\n' + (
            PACKAGE.parents[1] / "fixtures/scenes/requirements/01-grey-patch-central.textproto"
        ).read_text())
        job = self.client.create(plan={**plan, "scene": "cube.textproto"})
        with self.assertRaises(eyebox.JobFailed) as caught:
            job.result()
        self.assertIn("cube_file", str(caught.exception))

    def test_a_preview_shows_what_the_camera_sees_and_ends_with_the_loop(self):
        seen = []
        for picture in self.client.preview("sim:rift-s-like", drive=1.0, exposure_s=0.0125):
            seen.append(picture)
            if len(seen) == 2:
                break
        self.assertEqual(seen[0].pixels.shape, (120, 160))
        self.assertGreater(seen[0].pixels.mean(), 50)
        self.assertGreater(seen[1].frame, seen[0].frame)
        with self.assertRaises(eyebox.InvalidRequest) as caught:
            next(self.client.preview("sim:rift-s-like", most_width_px=1))
        self.assertEqual(caught.exception.where, "most_width_px")

    def test_failed_job_says_what_was_wrong_with_the_recording(self):
        (self.folder / "data" / "empty").mkdir(exist_ok=True)
        job = self.client.run(recording="empty")
        with self.assertRaises(eyebox.JobFailed) as caught:
            job.result()
        self.assertIn("empty", str(caught.exception))
        self.assertNotIn("/proc", str(caught.exception))

    def test_cancelled_job_has_no_result(self):
        job = self.client.run(rig="sim:rift-s-like", request_id="cancelled")
        job.cancel()
        with self.assertRaises(eyebox.Cancelled):
            job.result()
        self.assertEqual(job.state, "CANCELLED")

    def test_orderly_stop_ends_with_success(self):
        self.assertEqual(self.server.stop(), 0)
        self.assertFalse((self.folder / "eyebox.sock").exists())
        self.server = Server(self.folder)


class WithoutServerTest(unittest.TestCase):
    def test_no_server_is_said_with_what_to_do(self):
        with self.assertRaises(eyebox.ServerUnavailable) as caught:
            eyebox.connect("unix:/nonexistent/eyebox.sock", timeout_s=0.2)
        self.assertIn("eyebox serve", caught.exception.advice)

    def test_tcp_is_refused(self):
        done = run(EYEBOX, "serve", "--listen", "localhost:0")
        self.assertEqual(done.returncode, 3)
        self.assertIn("mutual TLS", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
