#!/usr/bin/env bash
# lecroyscope 1.0.0, lecroyparser 1.4.2, lecroyutils 4.0.2: a trace of a LeCroy oscilloscope (.trc)
#
# Guess: three readers give the same voltages at the same times, those of the waveform descriptor: the first at the
#   horizontal offset, each sample one horizontal interval later.
# What happens: where the oscilloscope sends the high byte first, as its manual has it by default (`COMM_ORDER`),
#   lecroyscope reads the descriptor rightly and exchanges the bytes of each sample: a pulse of 0.2 V is noise of 1 V to
#   either side. lecroyparser and lecroyutils read both orders, and stretch the time: the last of n samples is one
#   interval late, all intervals are n / (n - 1) times too long, by 11 % for ten samples, 1 % for a hundred. No message.
# Why: the order of bytes is found in the descriptor and used for it alone. The times are n points from 0 to n
#   intervals with both ends, one interval too much.
# Why it matters here: the pulse of a force sensor gives an impact's impulse and duration. Both are too large by the
#   same share, and a trace of one contact, or a short segment, has few samples.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'lecroyscope==1.0.0' 'lecroyparser==1.4.2' \
    'lecroyutils==4.0.2' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import struct
from importlib.metadata import version
from pathlib import Path

import lecroyparser
import numpy as np
from lecroyscope import Trace
from lecroyutils.data import LecroyScopeData

GAIN, INTERVAL, WIDTH = 2.0**-15, 1e-6, 346  # V per step, s, bytes of the descriptor in the template LECROY_2_3


def waveform(volts, start, low_byte_first):
    """One sweep of 16-bit samples: descriptor and data, everything else empty."""
    order = "<" if low_byte_first else ">"
    data = np.round(volts / GAIN).astype(order + "i2").tobytes()
    block = bytearray(WIDTH)
    for place, kind, value in (
        (0, "16s", b"WAVEDESC"),
        (16, "16s", b"LECROY_2_3"),
        (32, "h", 1),  # words, not bytes
        (34, "h", int(low_byte_first)),
        (36, "i", WIDTH),
        (60, "i", len(data)),
        (76, "16s", b"LECROY"),
        (116, "i", len(volts)),
        (120, "i", len(volts)),  # per screen
        (128, "i", len(volts) - 1),  # the last that is valid
        (136, "i", 1),  # each sample is kept
        (144, "i", 1),  # segments
        (148, "i", 1),  # sweeps
        (156, "f", GAIN),
        (164, "f", 32767.0),
        (168, "f", -32768.0),
        (172, "h", 16),
        (174, "h", 1),
        (176, "f", INTERVAL),
        (180, "d", start),
        (196, "48s", b"V"),
        (244, "48s", b"S"),
        (296, "d", 12.5),  # trigger: seconds, minute, hour, day, month, year
        (304, "4b", (30, 10, 3, 2)),
        (308, "h", 2026),
        (312, "f", len(volts) * INTERVAL),
        (324, "h", 18),  # 1 microsecond per division
        (328, "f", 1.0),
        (332, "h", 15),
    ):
        struct.pack_into(order + kind, block, place, *(value if isinstance(value, tuple) else (value,)))
    content = bytes(block) + data
    return f"#9{len(content):09d}".encode() + content


def trace(name):
    whole = Trace(name)
    return whole.time, whole.voltage


def of_attributes(reader):
    return lambda name: ((whole := reader(name)).x, whole.y)


READERS = {
    "lecroyscope": trace,
    "lecroyparser": of_attributes(lecroyparser.ScopeData),
    "lecroyutils": of_attributes(LecroyScopeData.parse_file),
}
print("half-sine pulse of 0.2 V: largest error (V), interval over the true one, last time late by (intervals)")
for count in (10, 100, 1000):
    times = -2e-6 + INTERVAL * np.arange(count)
    volts = 0.2 * np.sin(np.pi * np.arange(count) / count)
    for low_byte_first in (True, False):
        Path("pulse.trc").write_bytes(waveform(volts, times[0], low_byte_first))
        for name, reader in READERS.items():
            x, y = reader("pulse.trc")
            error, stretch = abs(y - volts).max(), np.diff(x).mean() / INTERVAL
            late = (x[-1] - times[-1]) / INTERVAL
            order = "low" if low_byte_first else "high"
            print(f"{count:5d} samples, {order:4s} byte first, {name:12s} {error:9.2g} {stretch:8.4f} {late:7.3f}")
            assert len(x) == len(y) == count and abs(x[0] - times[0]) < 1e-12, "the first time"
            exchanged = name == "lecroyscope" and not low_byte_first
            assert (error > 0.5) if exchanged else (error < GAIN), "changed: voltages"
            factor = 1 if name == "lecroyscope" else count / (count - 1)
            assert abs(stretch - factor) < 1e-6, "changed: times"
print(", ".join(f"{name} {version(name)}" for name in READERS))
PY
