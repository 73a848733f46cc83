"""What recordings the server has."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from typing import Any, Callable, Iterator, Optional, Tuple

from eyebox.v1 import recording_pb2, recording_service_pb2

_EPOCH = datetime(1970, 1, 1, tzinfo=timezone.utc)


@dataclass(frozen=True)
class Recording:
    """A recording below the server's data folder, as the catalogue has it."""

    name: str  # as run() takes it: its path below the data folder
    state: str  # "COMPLETE", "PARTIAL" or "DAMAGED"
    rig: str  # empty where it cannot be read
    camera: str
    origin: str  # "CAPTURED", "SIMULATED" or "IMPORTED"; empty where it cannot be read
    start: Optional[datetime]  # in UTC, to the microsecond; None where it cannot be read
    captures: int  # published
    frames: int  # of these
    bytes: int  # of the files of these
    levels: int  # different drive levels
    series: Tuple[str, ...]  # "" is the main one
    results: Tuple[str, ...]  # kept in its folder results/
    problem: str  # why it is damaged; else empty

    @classmethod
    def of(cls, entry: recording_service_pb2.RecordingEntry) -> Recording:
        """From what the server says."""
        header = entry.header
        start = (_EPOCH + timedelta(microseconds=header.created_real_ns // 1000)
                 if header.created_real_ns > 0 else None)
        return cls(
            entry.name.partition("/")[2],
            recording_service_pb2.RecordingState.Name(entry.state)[len("RECORDING_STATE_"):],
            header.rig.name, header.camera.uri,
            recording_pb2.RecordingOrigin.Name(header.origin)[len("RECORDING_ORIGIN_"):]
            if header.origin else "", start, entry.captures, entry.frames, entry.bytes,
            entry.levels, tuple(entry.series), tuple(entry.results), entry.problem)


def pages(call: Callable[[str, Any], Any], filter: str, order_by: str,
          page_size: int) -> Iterator[Recording]:
    """Every recording that passes; asks for the next page when the one before is used up."""
    request = recording_service_pb2.ListRecordingsRequest(filter=filter, order_by=order_by,
                                                          page_size=page_size)
    while True:
        page = call("ListRecordings", request)
        yield from map(Recording.of, page.recordings)
        request.page_token = page.next_page_token
        if not request.page_token:
            return
