"""Jobs as Python objects. Every call has a deadline; none of them ends a job."""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
import time
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator, Optional, Union

import grpc
from google.protobuf import json_format

from eyebox import arrays, capture, errors, preview, recordings
from eyebox.v1 import (capture_pb2, capture_service_pb2, capture_service_pb2_grpc, job_service_pb2,
                       job_service_pb2_grpc, recording_pb2, recording_service_pb2_grpc, results_pb2,
                       service_pb2, service_pb2_grpc)

_CALL_S = 30.0  # for a call that answers at once
_STREAM_S = 60.0  # for one stretch of a watch; the next goes on where it ended
_AWAY_S = 30.0  # how long a server may be away (a restart) before a watch gives up

_ENDED = (service_pb2.JOB_STATE_SUCCEEDED, service_pb2.JOB_STATE_FAILED,
          service_pb2.JOB_STATE_CANCELLED)


@dataclass(frozen=True)
class Update:
    """Where a job is."""

    sequence: int  # 1, 2, ... without gaps
    state: str  # "QUEUED", "RUNNING", "SUCCEEDED", "FAILED" or "CANCELLED"
    progress: float  # 0 to 1
    step: str  # in words


def _maps(result: Any) -> Iterator[dict[str, str]]:
    """Every MapFile of a result message, however deep."""
    for value in result.values() if isinstance(result, dict) else result:
        if isinstance(value, dict) and {"name", "unit", "file", "sha256"} <= value.keys():
            yield value
        if isinstance(value, (dict, list)):
            yield from _maps(value)


def _state_name(state: int) -> str:
    return service_pb2.JobState.Name(state)[len("JOB_STATE_"):]


class Job:
    """Work on the server. It goes on whatever becomes of this object."""

    def __init__(self, client: Client, message: Any) -> None:
        self._client = client
        self._message = message

    @property
    def name(self) -> str:
        """jobs/J: `client.job(name)` gives the job back, also after a restart of either side."""
        return self._message.name

    @property
    def state(self) -> str:
        """As the server has it now."""
        self._message = self._client._call("GetJob", service_pb2.GetJobRequest(name=self.name))
        return _state_name(self._message.state)

    def watch(self, from_sequence: int = 1) -> Iterator[Update]:
        """Every update from a sequence number on until the job has ended.

        Goes on by itself where a deadline or a restart of the server interrupted it.
        Raises ServerUnavailable if the server stays away.
        """
        following, away_since = max(from_sequence, 1), None
        while True:
            try:
                for event in self._events(following):
                    following, away_since = event.sequence + 1, None
                    self._message = event.job
                    yield Update(event.sequence, _state_name(event.job.state), event.job.progress,
                                 event.job.step)
                return
            except grpc.RpcError as error:
                if error.code() == grpc.StatusCode.DEADLINE_EXCEEDED:
                    continue
                away_since = away_since or time.monotonic()
                if (error.code() != grpc.StatusCode.UNAVAILABLE
                        or time.monotonic() - away_since > _AWAY_S):
                    raise errors.of_call(error) from error
                time.sleep(0.2)

    def watch_with_bar(self) -> str:
        """Shows a progress bar on stderr until the job has ended; returns its state."""
        state = ""
        for update in self.watch():
            state = update.state
            bar = ("#" * int(30 * update.progress)).ljust(30, ".")
            print(f"\r\033[K[{bar}] {100 * update.progress:3.0f} %  {update.step}", end="",
                  file=sys.stderr, flush=True)
        print(file=sys.stderr)
        return state

    def wait(self, timeout_s: Optional[float] = None) -> str:
        """Returns the state once the job has ended or the time is over."""
        end = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            stretch = _STREAM_S if end is None else min(_STREAM_S, max(0, end - time.monotonic()))
            request = service_pb2.WaitJobRequest(name=self.name, timeout_s=stretch)
            self._message = self._client._call("WaitJob", request, stretch + _CALL_S)
            if self._message.state in _ENDED or (end is not None and time.monotonic() >= end):
                return _state_name(self._message.state)

    def cancel(self) -> None:
        """Asks the job to stop, which it does before its next step."""
        self._message = self._client._call("CancelJob",
                                           service_pb2.CancelJobRequest(name=self.name))

    def result(self) -> results_pb2.RunResult:
        """Waits for the end. Raises JobFailed or Cancelled."""
        self._succeed()
        return self._client._call("GetRunResult",
                                  service_pb2.GetRunResultRequest(name=self.name))

    def message(self, form: Any) -> Any:
        """The result of any verb, as a message of the type `form`, such as
        `results_pb2.UniformityResult`. Waits for the end; raises as result() does."""
        return json_format.Parse(self.read("result.json"), form())

    @property
    def recording(self) -> str:
        """What a capture job made, as run() takes it. Waits for the end; raises as result()."""
        return self.message(capture_pb2.CaptureResult).recording.partition("/")[2]

    def read(self, artifact: str) -> bytes:
        """A file of the result. Waits for the end; raises as result() does, and DataLoss."""
        self._succeed()
        with tempfile.TemporaryDirectory() as folder:
            return self.download(artifact, Path(folder) / "file").read_bytes()

    def map(self, name: str) -> arrays.Map:
        """A map of the result with its unit and, where it has one, its sigma: "g", "luminance",
        ... as in `maps` of result.json. Needs numpy. Raises NotFound."""
        described = {one["name"]: one for one in _maps(json.loads(self.read("result.json")))}
        if name not in described:
            raise errors.NotFound(f"map: {name} is none of {self.name}; give one of "
                                  f"{', '.join(sorted(described))}", grpc.StatusCode.NOT_FOUND)
        sigma = described.get(f"{name}_sigma") or described.get(f"sigma_{name}")
        return arrays.Map(name, described[name]["unit"],
                          arrays.read_npy(self.read(described[name]["file"])),
                          arrays.read_npy(self.read(sigma["file"])) if sigma else None)

    def artifacts(self) -> list[str]:
        """Names of the result's files. Waits for the end; raises as result() does."""
        self._succeed()
        return [artifact.name for artifact in self._message.artifacts]

    def download(self, artifact: str, path: Union[str, os.PathLike[str]]) -> Path:
        """Writes a file of the result to `path`, whole or not at all. Raises DataLoss."""
        target = Path(path)
        partial = target.with_name(target.name + ".partial")
        digest, wanted = hashlib.sha256(), ""
        request = service_pb2.DownloadArtifactRequest(name=self.name, artifact=artifact)
        try:
            with open(partial, "wb") as file:
                for chunk in self._client._stub.DownloadArtifact(request, timeout=600):
                    file.write(chunk.data)
                    digest.update(chunk.data)
                    wanted = chunk.sha256
            if digest.hexdigest() != wanted:
                raise errors.DataLoss(f"{artifact}: arrived damaged; download it again",
                                      grpc.StatusCode.DATA_LOSS)
            os.replace(partial, target)
        except grpc.RpcError as error:
            raise errors.of_call(error) from error
        finally:
            partial.unlink(missing_ok=True)
        return target

    def download_all(self, folder: Union[str, os.PathLike[str]]) -> list[Path]:
        """Writes every file of the result into `folder`, created if missing."""
        Path(folder).mkdir(parents=True, exist_ok=True)
        return [self.download(name, Path(folder) / name) for name in self.artifacts()]

    def _events(self, following: int) -> Iterator[Any]:
        request = service_pb2.WatchJobRequest(name=self.name, from_sequence=following)
        return self._client._stub.WatchJob(request, timeout=_STREAM_S, wait_for_ready=False)

    def _succeed(self) -> None:
        if self._message.state not in _ENDED:
            self.wait()
        if self._message.state == service_pb2.JOB_STATE_CANCELLED:
            raise errors.Cancelled(f"{self.name}: was cancelled; create the run again",
                                   grpc.StatusCode.CANCELLED)
        if self._message.state == service_pb2.JOB_STATE_FAILED:
            raise errors.of_job(self._message.error_code, self._message.error_message)


class Client:
    """A connection to one server; close it, or use it in a `with` statement."""

    def __init__(self, channel: grpc.Channel) -> None:
        self._channel = channel
        self._stub = service_pb2_grpc.RunServiceStub(channel)
        self._stubs = {name: getattr(stub, name) for stub in (
            self._stub, job_service_pb2_grpc.JobServiceStub(channel),
            recording_service_pb2_grpc.RecordingServiceStub(channel),
            capture_service_pb2_grpc.CaptureServiceStub(channel)) for name in vars(stub)}

    def run(self, recording: Optional[str] = None, rig: Optional[str] = None, *, seed: int = 1,
            hdrp_cube_size: int = 0, pps_strip_size: int = 0, clip_sigmas: float = 0,
            request_id: Optional[str] = None) -> Job:
        """Creates a run of a recording (its path below the server's data folder) or of a rig
        ("sim:NAME"). A script that may be started again gives a request_id of its own: the same
        one gives the same job. Sizes of 0 are the server's defaults; clip_sigmas leaves out frames
        that far off, 0 none.
        Raises InvalidRequest, NotFound, AlreadyExists, QueueFull, ServerUnavailable.
        """
        request = service_pb2.CreateRunRequest(
            request_id=request_id or uuid.uuid4().hex, hdrp_cube_size=hdrp_cube_size,
            pps_strip_size=pps_strip_size, clip_sigmas=clip_sigmas)
        if (recording is None) == (rig is None):
            raise ValueError("give either a recording or a rig")
        if recording is not None:
            request.recording = recording
        else:
            request.rig.CopyFrom(recording_pb2.Rig(name=rig.partition(":")[2], camera_uri=rig,
                                                   seed=seed))
        return Job(self, self._call("CreateRun", request))

    def create(self, request_id: Optional[str] = None, **work: Any) -> Job:
        """Creates a job of any verb, given as its message or a dict of its fields:
        `create(uniformity={"source": {"recording": "left_eye"}})`.
        Raises InvalidRequest, NotFound, AlreadyExists, QueueFull, ServerUnavailable.
        """
        if len(work) != 1:
            raise ValueError("give exactly one verb")
        try:
            request = job_service_pb2.CreateJobRequest(request_id=request_id or uuid.uuid4().hex,
                                                       **work)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{next(iter(work))}: {error}") from error
        return Job(self, self._call("CreateJob", request))

    def plan(self, **options: Any) -> recording_pb2.CapturePlan:
        """Darks, flats and grey levels in random order, as `eyebox capture` takes them; options
        are the fields of MakePlanRequest, such as levels=33. Raises InvalidRequest."""
        return self._call("MakePlan", capture_service_pb2.MakePlanRequest(**options))

    def session(self, recording: str, rig: str, *, seed: int = 1,
                plan: Optional[recording_pb2.CapturePlan] = None, resume: bool = False,
                request_id: Optional[str] = None) -> capture.Session:
        """Captures what this script decides. `rig` is "rigs/R", a rig file below the server's
        data folder, or "sim:NAME"; the recording is there as `recording` once it is finished.
        Raises as create() does."""
        job = self._capture_job(recording, rig, seed, plan, resume, request_id, session=True)
        return capture.Session(job, self)

    def run_plan(self, show: capture.Show, recording: str, rig: str, *, seed: int = 1,
                 plan: Optional[recording_pb2.CapturePlan] = None, resume: bool = False,
                 request_id: Optional[str] = None, stream: bool = False) -> Job:
        """Carries out a plan (by default plan()), and calls `show` for every stimulus: it returns
        once the stimulus is on the display. Returns when the recording is there. Goes on where the
        server was restarted. `stream`: over one stream instead of calls.
        Raises as create() does, JobFailed, Cancelled, and what `show` raises (the job then waits
        for another script: `resume`)."""
        plan = plan if plan is not None else self.plan()
        job = self._capture_job(recording, rig, seed, plan, resume, request_id, session=False)
        (capture.stream if stream else capture.carry_out)(self, job, show)
        return job

    def _capture_job(self, recording: str, rig: str, seed: int, plan: Any, resume: bool,
                     request_id: Optional[str], session: bool) -> Job:
        work = capture_service_pb2.CaptureWork(recording_id=recording, plan=plan, session=session,
                                               resume=resume)
        if rig.startswith("sim:"):
            work.simulated.CopyFrom(recording_pb2.Rig(name=rig.partition(":")[2], camera_uri=rig,
                                                      seed=seed))
        else:
            work.rig = rig
        return self.create(request_id, capture=work)

    def preview(self, rig: str, *, seed: int = 1, exposure_s: float = 0, gain_db: float = 0,
                most_width_px: int = 0, drive: Optional[float] = None) -> Iterator[preview.Picture]:
        """What the rig's camera sees now, ten times a second at most, until the loop is left; a slow
        script gets the newest picture. `rig` as in session(); `drive` is the grey that a simulated
        headset shows; zeros are the server's defaults.
        Raises InvalidRequest, NotFound, and Rejected where a job captures, which also ends a
        preview under way."""
        request = preview.request_of(rig, seed, exposure_s, gain_db, most_width_px, drive)
        return preview.pictures(self._stubs["Preview"], request)

    def job(self, name: str) -> Job:
        """The job of that name. Raises NotFound."""
        return Job(self, self._call("GetJob", service_pb2.GetJobRequest(name=name)))

    def jobs(self) -> Iterator[Job]:
        """All jobs, newest first."""
        token = ""
        while True:
            page = self._call("ListJobs", service_pb2.ListJobsRequest(page_token=token))
            yield from (Job(self, message) for message in page.jobs)
            token = page.next_page_token
            if not token:
                return

    def recordings(self, filter: str = "", *, order_by: str = "",
                   page_size: int = 0) -> Iterator[recordings.Recording]:
        """Recordings below the server's data folder, by name. `filter` joins conditions by AND:
        'rig = "left-eye" AND state = COMPLETE AND start_time >= "2026-11-01"'; fields are name,
        rig, camera, state, origin, start_time, captures, frames, bytes, levels, and series and
        results with ':'. `order_by` is "name" or "start_time", with " desc" backwards. Pages of
        `page_size` (at most 100; 0: the server's default) are asked for as they are needed.
        Raises InvalidRequest, which says where in the filter."""
        return recordings.pages(self._call, filter, order_by, page_size)

    def close(self) -> None:
        self._channel.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _call(self, method: str, request: Any, timeout_s: float = _CALL_S) -> Any:
        try:
            return self._stubs[method](request, timeout=timeout_s)
        except grpc.RpcError as error:
            raise errors.of_call(error) from error


def connect(address: str = "unix:eyebox.sock", timeout_s: float = 10, *,
            tls_ca: Optional[str] = None, tls_certificate: Optional[str] = None,
            tls_key: Optional[str] = None, token_file: Optional[str] = None) -> Client:
    """Connects to `eyebox serve`.

    A server on TCP ("host:port") wants all three PEM files: the authority that signed the server's
    certificate, this client's certificate and its key. One that was started with --token-file
    wants the token in a file here too. Raises ServerUnavailable if no server answers in time,
    OSError (a file cannot be read).
    """
    channel = _channel(address, (tls_ca, tls_certificate, tls_key), token_file)
    try:
        grpc.channel_ready_future(channel).result(timeout=timeout_s)
    except grpc.FutureTimeoutError as error:
        channel.close()
        raise errors.ServerUnavailable(
            f"{address}: no server answers; start it with `eyebox serve --listen {address}`",
            grpc.StatusCode.UNAVAILABLE) from error
    return Client(channel)


def _channel(address: str, tls: tuple[Optional[str], ...],
             token_file: Optional[str]) -> grpc.Channel:
    files = [Path(file).read_bytes() for file in tls if file is not None]
    if files and len(files) != 3:
        raise ValueError("give tls_ca, tls_certificate and tls_key, or none of them")
    if files:
        credentials = grpc.ssl_channel_credentials(files[0], private_key=files[2],
                                                   certificate_chain=files[1])
    elif token_file is None:
        return grpc.insecure_channel(address)
    else:
        credentials = grpc.local_channel_credentials(grpc.LocalConnectionType.UDS)
    if token_file is not None:
        token = grpc.access_token_call_credentials(Path(token_file).read_text().strip())
        credentials = grpc.composite_channel_credentials(credentials, token)
    return grpc.secure_channel(address, credentials)
