"""Maps and frames as numpy arrays, with their unit and uncertainty."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional

if TYPE_CHECKING:
    import numpy


@dataclass(frozen=True)
class Map:
    """A quantity over the field."""

    name: str
    unit: str  # "1" where it has none
    value: numpy.ndarray  # [y, x]; NaN where there is none
    sigma: Optional[numpy.ndarray]  # standard uncertainty, the same shape; None where not known


def read_npy(content: bytes) -> numpy.ndarray:
    """An array from the bytes of an NPY file."""
    import io

    import numpy
    return numpy.load(io.BytesIO(content), allow_pickle=False)
