"""Where the time of a collision goes in the kernel, from counters in its driver; rewrites a table of kernel.md.

    python -m tests.benchmarks.shares            measures, prints and writes the page
    python -m tests.benchmarks.shares --print    only prints

A copy of the kernel reads the processor's clock between the parts of `run` (driver.h), and counts lanes after each
series. The clock's own time, read twice in a row, is subtracted. Impacts are those of the tasks, drawn on from their
sequence, without those decided at initial contact; of each part the least of several runs counts. Only on x86.
"""

# ruff: noqa: T201 -- a script that prints
from __future__ import annotations

import ctypes
import sys
from itertools import islice
from pathlib import Path

import numpy as np
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.machine import here
from wetdoublet.solvers.engines.settings import RTOL, STEPS
from wetdoublet.solvers.engines.taylor.build import kernel
from wetdoublet.solvers.engines.taylor.call import Impacts, bind_kernel, variant_for_many
from wetdoublet.solvers.engines.taylor.layout import ANSWER
from wetdoublet.solvers.engines.taylor.source import emitted_headers, flags, source
from wetdoublet.solvers.host.compiler import library
from wetdoublet.solvers.host.user_cache import loaded

from .measured.digits import of_rows
from .measured.tasks import TASKS, Task

PAGE = Path(__file__).resolve().parents[2] / "docs" / "engineering" / "kernel.md"
BEGIN, END = "<!-- shares -->", "<!-- end of shares -->"
RUNS, SETS = 60, {"granulation": 40, "pendulum": 100}
# Parts of `run`: the statement that ends each.
PARTS = {
    "implicit steps, jumps": "take_up_waiting(q, &l, &f);",
    "certificates": "end_sticks(q, &l, &f);",
    "rebound criteria": "criteria_met(q, &l, &f);",
    "series": "expand_states(&e, &l, &f);",
    "length of the step": "vec h = length_of_step(q, &e, &l, &f, &creeps);",
    "search for events": "first_event first = event_of_step(q, &e, &l, &f, h);",
    "sums": "mask lost = take_step(&e, &l, h, creeps, bits(falls) ? sum_at(e.s.gap, h) : first.gap);",
    "effects of events, queue, jumps from initial contact": "leave_to_others(q, &l, &f, lost, falls);",
}
COUNTS = {
    "lanes": "l.alive",
    "approaching": "l.alive & l.closing",
    "damped": "l.alive & creeps",
    "events": "l.alive & falls",
}
_CLOCK = """static void clock_at(int k)
{
    unsigned processor;
    long long now = __builtin_ia32_rdtscp(&processor); /* behind all that comes before it */
    TICKS[k] += now - CLOCKED;
    CLOCKED = now;
}
"""


def instrumented(text: str) -> str:
    """The kernel's source with the clock and the counters; AssertionError if `run` has changed."""
    start = text.index("static void run(queue *q)\n{")
    end = text.index("\n}\n", start)
    run = text[start:end]
    for k, statement in enumerate(PARTS.values()):
        assert run.count(statement) == 1, statement
        run = run.replace(statement, f"{statement} clock_at({k});")
    counted = " ".join(f"COUNTED[{k}] += __builtin_popcount(bits({what}));" for k, what in enumerate(COUNTS.values()))
    loop, falls = "for (;;) {", "mask falls = l.alive & (first.time <= 1.0);"
    assert run.count(loop) == run.count(falls) == 1
    run = run.replace(loop, f"for (;;) {{ clock_at({len(PARTS)}); clock_at({len(PARTS) + 1});")
    run = run.replace(falls, f"{falls} COUNTED[{len(COUNTS)}]++; {counted}")
    numbers = f"long long TICKS[{len(PARTS) + 2}], COUNTED[{len(COUNTS) + 1}], CLOCKED;\n"
    return text[:start] + numbers + _CLOCK + run + text[end:]


def column(task: Task, jumps: int) -> dict[str, str]:
    """The table's column for a task, with or without the jump along the slow manifold."""
    scene = Scene.load(task.preset)
    one = variant_for_many(scene, True, RTOL, False)
    emitted, plain = emitted_headers(one), kernel(one)
    assert emitted is not None
    assert plain is not None
    changed = loaded(library(instrumented(source(one, emitted)), flags(one, here()[0])), ctypes.CDLL)
    changed.collide.restype, changed.collide.argtypes = ctypes.c_char_p, [ctypes.c_void_p]
    drawn = [each for impacts in islice(task.drawn(), SETS[task.preset]) for each in impacts]
    speed, angle = scene.speed_of(np.array([each.stokes for each in drawn])), np.array([each.angle for each in drawn])
    live = Impacts(scene, speed, angle, {})
    answers = np.zeros(angle.size, ANSWER)
    bind_kernel(plain, RTOL, STEPS)(live, answers)
    live = live.part(np.flatnonzero((answers["steps"] > 0) & live.oblique))
    ticks = (ctypes.c_longlong * (len(PARTS) + 2)).in_dll(changed, "TICKS")
    counted = (ctypes.c_longlong * (len(COUNTS) + 1)).in_dll(changed, "COUNTED")
    runs = []
    for _ in range(RUNS):
        ctypes.memset(ticks, 0, ctypes.sizeof(ticks))
        ctypes.memset(counted, 0, ctypes.sizeof(counted))
        answers = np.zeros(live.angle.size, ANSWER)
        bind_kernel(changed, RTOL, STEPS, jumps)(live, answers)
        runs.append(list(ticks))
    least, (lanes, approaching, damped, events, vectors) = np.min(runs, axis=0), counted
    parts, size, steps = np.maximum(least[: len(PARTS)] - least[-1], 0), live.angle.size, answers["steps"]
    rows = {
        "collisions": f"{size}",
        "steps: mean, median, largest": f"{steps.mean():.1f}, {np.median(steps):.0f}, {steps.max()}",
        "of these approaching, opening": f"{approaching / size:.1f}, {(lanes - approaching) / size:.1f}",
        "of these damped": f"{damped / size:.1f}",
        "events": f"{events / size:.2f}",
        "lanes at work": f"{lanes / vectors / one.lanes:.1%}",
    }
    return rows | {f"{name}, of the time": f"{part / parts.sum():.1%}" for name, part in zip(PARTS, parts)}


def main() -> None:
    """Measure and write the page."""
    wet, strings = TASKS
    columns = {"granulation": column(wet, 0), "with jumps": column(wet, 2), "pendulum": column(strings, 0)}
    names = columns["pendulum"]
    rows = [{"a collision, rtol 1e-9": name} | {key: each[name] for key, each in columns.items()} for name in names]
    text = f"{BEGIN}\n{of_rows(rows)}\n{END}"
    print(text)
    if "--print" not in sys.argv:
        whole = PAGE.read_text()
        PAGE.write_text(whole[: whole.index(BEGIN)] + text + whole[whole.index(END) + len(END) :])


if __name__ == "__main__":
    main()
