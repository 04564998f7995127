#!/usr/bin/env bash
# npTDMS 1.13.0: the times of records that were appended to a file
#
# Guess: two impacts are recorded into one TDMS file, the second one a minute later and at another rate; each record has
#   its own start and increment, and `time_track()` or `as_dataframe(time_index=True)` give each sample its time.
# What happens: all samples get the start and the increment of the last record, one behind the other without a pause.
#   The first impact, recorded at 20 kHz, lasts a fifth of its time and has a fifth of its impulse; its first sample is
#   dated a minute late, and the second record begins where the first one ends. No message.
# Why: in this format a property that is written again replaces the former one; the reader keeps one value for each
#   channel, the last one, and counts samples from the beginning of the file. The other values are in the file still:
#   the first record alone, which is the beginning of the very same bytes, is read with its own.
# Why it matters here: a force sensor that is triggered by the impact appends a record for each drop, and the rate is
#   what one changes after the first look. The impulse gives the rebound, the duration of contact the stiffness. Write
#   each record into a group of its own.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'npTDMS==1.13.0' 'numpy==2.4.6' 'pandas==3.1.1'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from nptdms import ChannelObject, TdmsFile, TdmsWriter

FORCE, CONTACT = 10.0, 1e-3  # N, s: half a sine wave
RECORDS = [("2026-01-01T12:00:00", 20e3), ("2026-01-01T12:01:00", 100e3)]  # start, samples/s
impulse = 2 / np.pi * FORCE * CONTACT


def pulse(rate):
    time = np.arange(round(2 * CONTACT * rate)) / rate
    return np.where(time < CONTACT, FORCE * np.sin(np.pi * time / CONTACT), 0.0)


def write(path, records, group=lambda number: "drops"):
    for number, (start, rate) in enumerate(records):
        with TdmsWriter(path, mode="a" if number else "w") as writer:
            waveform = {"wf_start_time": np.datetime64(start), "wf_increment": 1 / rate, "wf_start_offset": 0.0}
            writer.write_segment([ChannelObject(group(number), "force", pulse(rate), waveform)])


def show(name, time, force):
    found = np.trapezoid(force, time)
    duration = np.ptp(time[force > 0.01 * FORCE])
    print(f"{name:32s} contact {1e3 * duration:5.2f} ms, impulse {1e3 * found:5.2f} mN s, {found / impulse:.3f} of it")
    return found / impulse


print("npTDMS", version("npTDMS"), f"- contact {1e3 * CONTACT:g} ms, impulse {1e3 * impulse:.2f} mN s, twice")
first = len(pulse(RECORDS[0][1]))
write("alone.tdms", RECORDS[:1])
write("both.tdms", RECORDS)
write("groups.tdms", RECORDS, lambda number: f"drop {number}")
with open("alone.tdms", "rb") as alone, open("both.tdms", "rb") as both:
    assert both.read().startswith(alone.read()), "the second record is appended"

channel = TdmsFile.read("alone.tdms")["drops"]["force"]
assert abs(show("first record alone", channel.time_track(), channel[:]) - 1) < 0.01, "the first record"
channel = TdmsFile.read("both.tdms")["drops"]["force"]
time, force = channel.time_track(), channel[:]
assert np.array_equal(force, np.concatenate([pulse(rate) for _, rate in RECORDS])), "samples"
small = show("first record of both", time[:first], force[:first])
assert abs(small - 0.2) < 0.01, "changed: time_track"
assert abs(show("second record of both", time[first:], force[first:]) - 1) < 0.01, "the second record"

table = TdmsFile.read("both.tdms").as_dataframe(time_index=True, absolute_time=True)
print("first sample of the first record ", table.index[0], "  recorded", RECORDS[0][0])
print("first sample of the second record", table.index[first], "  recorded", RECORDS[1][0])
assert table.index[0] == np.datetime64(RECORDS[1][0]), "changed: absolute times"
assert table.index[first] - table.index[0] == np.timedelta64(400, "us"), "changed: the pause"

for number in range(2):
    channel = TdmsFile.read("groups.tdms")[f"drop {number}"]["force"]
    assert abs(show(f"group of record {number + 1}", channel.time_track(), channel[:]) - 1) < 0.01, "groups"
PY
