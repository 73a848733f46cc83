"""What a camera sees now."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterator, Optional

import grpc
import numpy as np

from eyebox import errors
from eyebox.v1 import capture_service_pb2, recording_pb2


@dataclass(frozen=True)
class Picture:
    """Never recorded: to aim and to focus by."""

    pixels: np.ndarray  # uint8 [height, width]: means of blocks, 255 for full scale
    frame: int  # 1, 2, ... since the camera was opened
    dropped: int  # pictures that this script was too slow for
    block_px: int  # side of the blocks, camera pixels
    lowest_dn: int  # of all camera pixels
    highest_dn: int
    mean_dn: float
    full_scale_dn: int
    saturated_share: float
    exposure_s: float

    @classmethod
    def of(cls, frame: Any) -> Picture:
        """From what the server says."""
        pixels = np.frombuffer(frame.pixels, np.uint8).reshape(frame.height_px, frame.width_px)
        return cls(pixels, frame.frame, frame.dropped, frame.block_px, frame.lowest_dn,
                   frame.highest_dn, frame.mean_dn, frame.full_scale_dn, frame.saturated_share,
                   frame.exposure_s)


def request_of(rig: str, seed: int, exposure_s: float, gain_db: float, most_width_px: int,
               drive: Optional[float]) -> capture_service_pb2.PreviewRequest:
    request = capture_service_pb2.PreviewRequest(
        exposure_s=exposure_s, gain_db=gain_db, most_width_px=most_width_px, drive=drive)
    if rig.startswith("sim:"):
        request.simulated.CopyFrom(recording_pb2.Rig(name=rig.partition(":")[2], camera_uri=rig,
                                                     seed=seed))
    else:
        request.rig = rig
    return request


def pictures(stub: Any, request: capture_service_pb2.PreviewRequest) -> Iterator[Picture]:
    stream = stub(request)
    try:
        for frame in stream:
            yield Picture.of(frame)
    except grpc.RpcError as error:
        raise errors.of_call(error) from error
    finally:
        stream.cancel()
