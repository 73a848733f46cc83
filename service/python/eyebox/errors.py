"""Errors of the service as exceptions, with its advice.

The server writes "WHERE: WHAT; ADVICE"; an exception has the three apart.
"""

from __future__ import annotations

import grpc


class EyeboxError(Exception):
    """Anything that the service refused or that went wrong on the way."""

    def __init__(self, message: str, code: grpc.StatusCode = grpc.StatusCode.UNKNOWN) -> None:
        super().__init__(message)
        self.code = code
        where, colon, rest = message.partition(": ")
        what, _, advice = (rest if colon else message).rpartition("; ")
        self.where: str = where if colon else ""
        self.what: str = what or advice
        self.advice: str = advice if what else ""


class InvalidRequest(EyeboxError):
    """The request does not make sense; `where` is its field."""


class NotFound(EyeboxError):
    """No such recording, job or file."""


class AlreadyExists(EyeboxError):
    """The request_id belongs to another request."""


class Rejected(EyeboxError):
    """Not possible as things are, for example the result of a job that has not ended."""


class QueueFull(EyeboxError):
    """Too many jobs wait, or the request is too large."""


class ServerUnavailable(EyeboxError):
    """No server answers, or it is stopping."""


class DataLoss(EyeboxError):
    """Bytes are not what was written."""


class Cancelled(EyeboxError):
    """The job was cancelled."""


class JobFailed(EyeboxError):
    """The job ended with an error."""


_CLASSES = {
    grpc.StatusCode.INVALID_ARGUMENT: InvalidRequest,
    grpc.StatusCode.OUT_OF_RANGE: InvalidRequest,
    grpc.StatusCode.NOT_FOUND: NotFound,
    grpc.StatusCode.ALREADY_EXISTS: AlreadyExists,
    grpc.StatusCode.FAILED_PRECONDITION: Rejected,
    grpc.StatusCode.RESOURCE_EXHAUSTED: QueueFull,
    grpc.StatusCode.UNAVAILABLE: ServerUnavailable,
    grpc.StatusCode.DATA_LOSS: DataLoss,
}

_BY_NUMBER = {code.value[0]: code for code in grpc.StatusCode}


def of_call(error: grpc.RpcError) -> EyeboxError:
    """The exception for a call that failed."""
    return _CLASSES.get(error.code(), EyeboxError)(error.details() or str(error), error.code())


def of_job(number: int, message: str) -> JobFailed:
    """The exception for a job that failed; `number` is its canonical code."""
    return JobFailed(message, _BY_NUMBER.get(number, grpc.StatusCode.UNKNOWN))
