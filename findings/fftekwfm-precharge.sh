#!/usr/bin/env bash
# fftekwfm 0.4.1: samples before and after the record, in files of Tektronix's oscilloscopes
#
# Guess: `load_frames(pre=True).get_time_frame()` gives the samples that were kept before the record their own, earlier
#   times; without `post=True` those behind the record are left out.
# What happens: the first of the samples before the record gets the time of the record's first one: all that follows is
#   late by their number. An impact that fires the trigger is at 40 microseconds instead of 0. And the samples behind
#   the record come along, unasked for: a record of 200 samples has 240. Tektronix's own package, which wrote the
#   file, reads 200 and the impact at 0. No message.
# Why: the time vector begins at the record's start whatever was loaded; the number of samples that is read as the
#   record's counts those before and behind it, too.
# Why it matters here: forces of a series of drops are recorded in frames of one file, and the time from the trigger to
#   the peak, or to the film's frame, is what one wants. What is kept beside the record is there for filters, not for
#   the impulse. Cut frames to the samples from `data_start_offset` to `post_start_offset`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
# Tektronix's package asks for one NumPy up to Python 3.12 and for another from 3.13 on, and for Python before 3.14
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'tm_data_types==0.5.0'
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'fftekwfm==0.4.1'
cd "$work"
NUMBA_CACHE_DIR="$work" "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from fftekwfm import TekWFM
from tm_data_types import read_file, write_file
from tm_data_types.datum.waveforms.fastframe_analog_waveform import FastFrameAnalogWaveform

SAMPLES, BESIDE, INTERVAL, TRIGGER, DROPS = 200, 40, 1e-6, 80, 3  # record, kept before and behind it, s, sample


def write(path, beside):
    wave = FastFrameAnalogWaveform.create_fastframe(
        frame_count=DROPS,
        record_length=SAMPLES,
        dtype=np.int16,
        precharge_length=beside,
        postcharge_length=beside,
        y_axis_spacing=1e-4,
        y_axis_units="V",
        x_axis_spacing=INTERVAL,
        x_axis_units="s",
        trigger_index=float(TRIGGER),
    )
    for drop in range(DROPS):
        wave.fill_frame(drop, np.where(np.arange(SAMPLES) == TRIGGER, 20000, 0).astype(np.int16))
    write_file(path, wave)


print("fftekwfm", version("fftekwfm"), "with tm_data_types", version("tm_data_types"), "- the impact is at 0")
for beside in (0, BESIDE):
    path = f"{beside}.wfm"
    write(path, beside)
    wave = read_file(path)
    impact = (np.argmax(wave.frame_data(0)) - wave.trigger_index) * wave.x_axis_spacing
    print(f"{beside} before and behind; by Tektronix's package: {wave.record_length} samples, impact at {impact:g}")
    assert wave.record_length == SAMPLES and abs(impact) < 1e-12, "the file"
    for pre in (False, True):
        wave = TekWFM(path).load_frames(scale=True, pre=pre).get_time_frame()
        count, impact = wave.frames.shape[1], wave.time_frame[wave.frames[0].argmax()]
        print(f"  pre={pre!s:5s}  {count} samples, impact at {1e6 * impact:5.1f} microseconds")
        assert abs(impact - pre * beside * INTERVAL) < 1e-12, "changed: times"
        assert count == SAMPLES + (1 + pre) * beside, "changed: samples behind the record"
PY
