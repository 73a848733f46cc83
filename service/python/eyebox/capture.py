"""Captures on a rig while this script shows the stimuli, either way round."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Optional, Tuple

import grpc

from eyebox import errors
from eyebox.v1 import capture_service_pb2, recording_pb2, service_pb2

if TYPE_CHECKING:
    from eyebox.client import Client, Job

_POLL_S = 20.0  # for one NextStimulus
_CAPTURE_S = 900.0  # for one capture: long exposures, many frames, a display that settles
_AWAY_S = 30.0  # how long a server may be away (a restart) before a script gives up

_ENDED = (service_pb2.JOB_STATE_SUCCEEDED, service_pb2.JOB_STATE_FAILED,
          service_pb2.JOB_STATE_CANCELLED)


@dataclass(frozen=True)
class Stimulus:
    """What to put before the camera."""

    kind: str  # "light": on the headset; "dark": cover the lens; "flat": a uniform reference
    pattern: str  # "full_field", "disk", "black_disk" or "checkerboard"
    drive: Optional[Tuple[float, float, float]]  # red, green, blue, each 0 to 1
    diameter_deg: float  # of a disk; side of a checkerboard's square
    instruction: str  # in words, for an experimenter

    @classmethod
    def of(cls, capture: recording_pb2.CaptureSpec, instruction: str = "") -> Stimulus:
        """From what a plan or the server says."""
        stimulus = capture.stimulus
        rgb = stimulus.drive
        return cls(
            recording_pb2.FrameKind.Name(capture.kind)[len("FRAME_KIND_"):].lower(),
            recording_pb2.StimulusPattern.Name(stimulus.pattern)[len("STIMULUS_PATTERN_"):].lower(),
            (rgb.red, rgb.green, rgb.blue) if stimulus.HasField("drive") else None,
            stimulus.diameter_deg, instruction)


@dataclass(frozen=True)
class Captured:
    """A capture that is on stable storage."""

    number: int  # 1, 2, ... in the recording
    mean_dn: float  # mean count of its frames
    sigma_dn: float  # standard uncertainty of the mean
    attempts: int  # 0 where that is not known any more
    remark: str  # what the experimenter should know; mostly empty


Show = Callable[[Stimulus], None]


class Session:
    """The script decides what to capture: it shows a patch and calls capture()."""

    def __init__(self, job: Job, client: Client, number: int = 1) -> None:
        self.job = job
        self._client = client
        self._next = number

    def capture(self, spec: recording_pb2.CaptureSpec) -> Captured:
        """Takes what is shown now. Returns when it is on stable storage; asks again where the
        server was restarted meanwhile. Raises InvalidRequest, Rejected, JobFailed, EyeboxError.
        """
        request = capture_service_pb2.CaptureRequest(name=self.job.name, number=self._next,
                                                     capture=spec)
        try:
            reply = _while_away(
                lambda: self._client._call("Capture", request, _CAPTURE_S), self._fail_if_ended)
        except errors.Rejected:
            self._fail_if_ended()  # says why the session is over, if that is what it was
            raise
        self._next += 1
        return Captured(reply.number, reply.mean_dn, reply.sigma_dn, reply.attempts, reply.remark)

    def finish(self) -> Job:
        """Makes a recording of what was captured, and waits until it is there."""
        request = capture_service_pb2.FinishCaptureRequest(name=self.job.name)
        try:
            _while_away(lambda: self._client._call("FinishCapture", request), self._fail_if_ended)
        except errors.Rejected:  # the answer of an earlier call was lost: it has ended
            pass
        self.job.artifacts()
        return self.job

    def _fail_if_ended(self) -> None:
        if self.job.state in ("FAILED", "CANCELLED"):
            self.job.artifacts()  # raises what ended it


def carry_out(client: Client, job: Job, show: Show) -> None:
    """Shows what the server asks for until the job has ended, by unary calls alone."""
    shown = 0
    while True:
        request = capture_service_pb2.NextStimulusRequest(name=job.name, after_step=shown,
                                                          timeout_s=_POLL_S)
        step = _while_away(lambda: client._call("NextStimulus", request, _POLL_S + 10))
        if step.job.state in _ENDED:
            break
        if step.step == 0:
            continue
        show(Stimulus.of(step.capture, step.instruction))
        ack = capture_service_pb2.AckShownRequest(name=job.name, step=step.step)
        try:
            _while_away(lambda: client._call("AckShown", ack))
        except (errors.Rejected, errors.InvalidRequest):
            continue  # it ended, or began anew after a restart and asks again
        shown = step.step
    job.artifacts()  # raises what ended it


def stream(client: Client, job: Job, show: Show) -> None:
    """The same over one stream, which is opened again where the server was restarted."""
    _while_away(lambda: _one_stream(client, job, show))
    job.artifacts()


def _one_stream(client: Client, job: Job, show: Show) -> None:
    said: Any = _Mailbox()
    said.put(capture_service_pb2.RunPlanRequest(name=job.name))
    call = client._stubs["RunPlan"](said)
    try:
        for step in call:
            if step.job.state in _ENDED:
                return
            show(Stimulus.of(step.capture, step.instruction))
            said.put(capture_service_pb2.RunPlanRequest(shown_step=step.step))
    except grpc.RpcError as error:
        raise errors.of_call(error) from error
    finally:
        said.close()
        call.cancel()


class _Mailbox:
    """What a stream sends: an iterator that waits for the next message."""

    def __init__(self) -> None:
        import queue
        self._queue: Any = queue.SimpleQueue()

    def put(self, message: Any) -> None:
        self._queue.put(message)

    def close(self) -> None:
        self._queue.put(None)

    def __iter__(self) -> _Mailbox:
        return self

    def __next__(self) -> Any:
        message = self._queue.get()
        if message is None:
            raise StopIteration
        return message


def _while_away(call: Callable[[], Any], check: Callable[[], None] = lambda: None) -> Any:
    """Calls until a server that restarts, or a job that waits for its turn, answers."""
    away_since = time.monotonic()
    while True:
        try:
            return call()
        except errors.ServerUnavailable as error:
            if "turn" in error.what:
                away_since = time.monotonic()  # the server is there
            elif time.monotonic() - away_since > _AWAY_S:
                raise
        time.sleep(0.1)
        try:
            check()
        except errors.ServerUnavailable:
            pass
