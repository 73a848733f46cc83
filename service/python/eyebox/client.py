"""Runs as Python objects. Every call has a deadline; none of them ends a job."""

from __future__ import annotations

import hashlib
import os
import time
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator, Optional, Union

import grpc

from eyebox import errors
from eyebox.v1 import recording_pb2, results_pb2, service_pb2, service_pb2_grpc

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


def _state_name(state: int) -> str:
    return service_pb2.JobState.Name(state)[len("JOB_STATE_"):]


class Job:
    """A run on the server. It goes on whatever becomes of this object."""

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

    def run(self, recording: Optional[str] = None, rig: Optional[str] = None, *, seed: int = 1,
            hdrp_cube_size: int = 0, pps_strip_size: int = 0,
            request_id: Optional[str] = None) -> Job:
        """Creates a run of a recording (its path below the server's data folder) or of a rig
        ("sim:NAME"). A script that may be started again gives a request_id of its own: the same
        one gives the same job. Sizes of 0 are the server's defaults.
        Raises InvalidRequest, NotFound, AlreadyExists, QueueFull, ServerUnavailable.
        """
        request = service_pb2.CreateRunRequest(
            request_id=request_id or uuid.uuid4().hex, hdrp_cube_size=hdrp_cube_size,
            pps_strip_size=pps_strip_size)
        if (recording is None) == (rig is None):
            raise ValueError("give either a recording or a rig")
        if recording is not None:
            request.recording = recording
        else:
            request.rig.CopyFrom(recording_pb2.Rig(name=rig.partition(":")[2], camera_uri=rig,
                                                   seed=seed))
        return Job(self, self._call("CreateRun", request))

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

    def close(self) -> None:
        self._channel.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _call(self, method: str, request: Any, timeout_s: float = _CALL_S) -> Any:
        try:
            return getattr(self._stub, method)(request, timeout=timeout_s)
        except grpc.RpcError as error:
            raise errors.of_call(error) from error


def connect(address: str = "unix:eyebox.sock", timeout_s: float = 10) -> Client:
    """Connects to `eyebox serve`. Raises ServerUnavailable if no server answers in time."""
    channel = grpc.insecure_channel(address)
    try:
        grpc.channel_ready_future(channel).result(timeout=timeout_s)
    except grpc.FutureTimeoutError as error:
        channel.close()
        raise errors.ServerUnavailable(
            f"{address}: no server answers; start it with `eyebox serve --listen {address}`",
            grpc.StatusCode.UNAVAILABLE) from error
    return Client(channel)
