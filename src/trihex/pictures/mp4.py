"""Writer of MP4 (H.264), frame by frame, with PyAV."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trihex.errors import MissingExtraError


def import_av() -> Any:
    """Return the module PyAV.

    Raises
    ------
    MissingExtraError
        If it is not installed.
    """
    try:
        import av
    except ImportError as error:
        raise MissingExtraError(
            "writing .mp4 needs PyAV: pip install 'trihex[video]'; .gif needs nothing more"
        ) from error
    return av


class Mp4Writer:
    """Writes RGB frames of one size to a file, `frames_per_second` of them."""

    def __init__(self, path: Path, frames_per_second: int) -> None:
        self._av = import_av()
        self._rate = frames_per_second
        self._container = self._av.open(str(path), "w")
        self._stream: Any = None

    def add(self, frame: NDArray[np.uint8], milliseconds: int) -> None:
        """Append a frame, as often as it takes to show it for so long."""
        # Halved colour planes want an even size.
        frame = np.pad(frame, ((0, frame.shape[0] % 2), (0, frame.shape[1] % 2), (0, 0)), mode="edge")
        if self._stream is None:
            options = {"crf": "18", "preset": "veryfast"}
            self._stream = self._container.add_stream("libx264", rate=self._rate, options=options)
            self._stream.height, self._stream.width = frame.shape[:2]
            self._stream.pix_fmt = "yuv420p"
        for _ in range(max(1, round(milliseconds * self._rate / 1000))):
            video_frame = self._av.VideoFrame.from_ndarray(np.ascontiguousarray(frame), format="rgb24")
            self._container.mux(self._stream.encode(video_frame))

    def close(self) -> None:
        """Write what is left and close the file."""
        if self._stream is not None:
            self._container.mux(self._stream.encode(None))
        self._container.close()
