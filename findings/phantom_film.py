"""A Phantom film (.cine) for the scripts beside this file: 16 bit grey, not compressed, a time stamp a frame."""

import struct
from pathlib import Path

import numpy as np

HEADER, BITMAP, SETUP = 44, 40, 12432  # bytes of the three headers


def write(path: str, images: np.ndarray, first: int, rate: int, trigger: float = 1_700_000_000.25) -> None:
    """Write images (frame, row, column) that were taken at `rate` per second.

    `first` is the first frame's number, negative before the trigger, whose time is in seconds since 1970.
    """
    count, rows, columns = images.shape
    setup = bytearray(SETUP)
    for place, kind, value in (
        (140, "2s", b"ST"),
        (142, "H", SETUP),
        (768, "I", rate),
        (800, "I", 800),  # version of the camera's software
        (896, "I", 12),  # bits that are used
        (5736, "i", 4095),  # white
        (10388, "f", 1.0),  # every frame is kept
        (10400, "d", rate),
    ):
        struct.pack_into("<" + kind, setup, place, value)

    def stamp(frame: int) -> int:
        """Seconds since 1970 as the format has them: 32 bits before the point, 32 behind it."""
        return (int(trigger) << 32) + round((trigger % 1 + frame / rate) * 2**32)

    times = struct.pack(f"<{count}Q", *(stamp(number) for number in range(first, first + count)))
    exposures = struct.pack("<I", 4295) * count  # a microsecond
    blocks = struct.pack("<IHH", 8 + len(times), 1002, 1) + times
    blocks += struct.pack("<IHH", 8 + len(exposures), 1003, 0) + exposures
    offsets = HEADER + BITMAP + SETUP + len(blocks)
    size = 2 * rows * columns
    places = [offsets + 8 * count + number * (8 + size) for number in range(count)]
    film = [
        struct.pack("<2sHHHiIiI", b"CI", HEADER, 0, 1, first, count, first, count),
        struct.pack("<IIIQ", HEADER, HEADER + BITMAP, offsets, stamp(0)),
        struct.pack("<IiiHHIIiiII", BITMAP, columns, rows, 1, 16, 0, size, 0, 0, 0, 4096),
        bytes(setup),
        blocks,
        struct.pack(f"<{count}q", *places),
    ]
    for image in images:
        film += [struct.pack("<II", 8, size), np.ascontiguousarray(image[::-1], "<u2").tobytes()]
    Path(path).write_bytes(b"".join(film))
