"""The rows of the performance table: which benchmark and counter show each, and what it is to reach.

A row's figure is a ratio to a yardstick measured in the same run wherever there is one, so that
results of two machines, or of a busy and an idle one, can be compared; times stand beside it.
"""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Row:
    work: str
    program: str
    case: str  # benchmark of the program; its arguments are told apart as cases of the row
    counter: str
    unit: str  # of the counter: what it is a multiple of
    reach: float
    better: str = "lower"
    reach_only: str = ""  # the arguments that the reach is stated for; empty: all of them
    beside: tuple = ()  # further counters worth reading

    def met(self, arguments, value):
        """None where nothing was promised."""
        if self.reach_only and self.reach_only != arguments:
            return None
        return value <= self.reach if self.better == "lower" else value >= self.reach


ROWS = (
    Row("common-exponent fit", "common_exponent_bench", "CommonExponentAgainstMemcpy", "memcpys",
        "memcpy of the stack", 3, reach_only="locations:1048576/levels:17",
        beside=("fit_ms", "memcpy_ms")),
    Row("reduction, rate", "reduction_bench", "Reduction", "raw_GB_per_s", "GB/s of raw data", 1,
        "higher", reach_only="width_px:4096/height_px:3000/frames:8"),
    Row("reduction", "reduction_bench", "Reduction", "memcpys", "memcpy of what it moves", 4,
        reach_only="width_px:4096/height_px:3000/frames:8",
        beside=("stack_ms", "reduce_ms", "memcpys_2", "memcpy_GB_per_s")),
    Row("scatter correction", "scatter_bench", "CorrectionAgainstTwoTransforms/no_mask", "dfts",
        "two cv::dft", 1.5, reach_only="side_px:2048", beside=("correction_ms", "pair_ms")),
    Row("scatter correction, masked", "scatter_bench",
        "CorrectionAgainstTwoTransforms/one_in_a_thousand_masked", "dfts", "two cv::dft", 1.5,
        beside=("correction_ms", "pair_ms")),
    Row("cube design", "cube_bench", "DesignHdrp", "in_time", "the time allowed / taken", 1,
        "higher", beside=("max_relative",)),
    Row("recording", "recording_bench", "Recording", "of_plain", "plain pwrite + fdatasync", 0.8,
        "higher", beside=("MB_s", "plain_MB_s")),
    Row("camera to disk, frames lost", "camera_to_disk_bench", "CameraToDisk", "lost", "frames", 0,
        beside=("frames_per_s", "MB_s", "plain_MB_s")),
    Row("health check p99, 64 streams", "health_bench", "HealthCheck", "p99_ms", "ms", 10,
        beside=("p50_ms", "streams_MB_s")),
    Row("whole run", "pipeline_bench", "WholeRun", "reads", "reading with checksums", 0,
        reach_only="nothing", beside=("run_ms", "read_ms", "MB_per_s")),
)
