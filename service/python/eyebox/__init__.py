"""Client of the Eyebox service.

    import eyebox

    with eyebox.connect("unix:eyebox.sock") as client:
        job = client.run(recording="left_eye")
        for update in job.watch():
            print(f"{update.progress:.0%} {update.step}")
        print(job.result().parameters)
        job.download("linearize.cube", "linearize.cube")
"""

from eyebox import _stubs

_stubs.find(__path__)

from eyebox.arrays import Map  # noqa: E402  needs the stubs
from eyebox.capture import Captured, Session, Stimulus  # noqa: E402
from eyebox.client import Client, Job, Update, connect  # noqa: E402  needs the stubs
from eyebox.errors import (AlreadyExists, Cancelled, DataLoss, EyeboxError, InvalidRequest,  # noqa: E402
                           JobFailed, NotFound, QueueFull, Rejected, ServerUnavailable)
from eyebox.recordings import Recording  # noqa: E402

__all__ = ["AlreadyExists", "Cancelled", "Captured", "Client", "DataLoss", "EyeboxError",
           "InvalidRequest", "Job", "JobFailed", "Map", "NotFound", "QueueFull", "Recording",
           "Rejected", "ServerUnavailable", "Session", "Stimulus", "Update", "connect"]
