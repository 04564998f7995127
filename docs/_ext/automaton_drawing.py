"""The automaton as a diagram: modes as boxes, events as arrows between them."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch
from wetdoublet.derive.equations import automaton
from wetdoublet.derive.equations.automaton import CLOSING, OPENING, Event

Mode = tuple[tuple[str, int], ...]


def _mode(film: int, motion: int, resting: int = 0) -> Mode:
    return (("film", film), ("motion", motion), ("resting", resting))


_SEPARATED, _CUT_OFF, _ANY = "separated", "stick, cut off", "any mode"
# centre of each box
_PLACES: dict[Mode | str, tuple[int, int]] = {
    _mode(0, CLOSING): (190, 470), _mode(0, OPENING): (560, 470), _mode(1, CLOSING): (190, 270),
    _mode(1, OPENING): (560, 270), _mode(1, OPENING, 1): (560, 80), _SEPARATED: (870, 470), _ANY: (870, 270),
    _CUT_OFF: (870, 80),
}  # fmt: skip
_BEND = 0.12  # of the arrows, over their length: there and back do not coincide


def draw(file: Path) -> None:
    """Draw the modes of a collision and the events between them."""
    figure = Figure(figsize=(9.8, 5.5))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, 980), ylim=(0, 550))
    axes.axis("off")
    boxes = {}
    for box, (x, y) in _PLACES.items():
        fill = "#FBE3A6" if box in (_SEPARATED, _CUT_OFF) else "#DCEBF5"
        boxes[box] = FancyBboxPatch((x - 70, y - 21), 140, 42, boxstyle="round,pad=6", fc=fill, ec="#333333")
        axes.add_patch(boxes[box])
        axes.text(x, y, _label(box), ha="center", va="center")
    for (source, target), words in _arrows().items():
        (x0, y0), (x1, y1) = _PLACES[source], _PLACES[target]
        curve = {"arrowstyle": "-|>", "connectionstyle": f"arc3,rad={_BEND}", "mutation_scale": 14, "color": "#333333"}
        ends = {"patchA": boxes[source], "patchB": boxes[target], "shrinkA": 2, "shrinkB": 2}
        axes.add_patch(FancyArrowPatch((x0, y0), (x1, y1), **curve, **ends))
        aside = _BEND / 2 * (y1 - y0), _BEND / 2 * (x0 - x1)
        steep = abs(y1 - y0) > abs(x1 - x0)
        place = {"ha": "left" if aside[0] > 0 else "right", "va": "center"} if steep else {"ha": "center"}
        place |= {} if steep else {"va": "bottom" if aside[1] > 0 else "top"}
        side = [0.0 if abs(shift) < 1 else 5.0 if shift > 0 else -5.0 for shift in aside]
        axes.text((x0 + x1) / 2 + aside[0] + side[0], (y0 + y1) / 2 + aside[1] + side[1], ", ".join(words),
                  fontsize=9, bbox={"fc": "white", "ec": "none", "pad": 1}, **place)  # fmt: skip
    axes.annotate("starts here, at initial contact", (150, 241), (105, 180), color="#555555", ha="center",
                  arrowprops={"arrowstyle": "-|>", "color": "#555555"})  # fmt: skip
    figure.savefig(file, metadata={"Date": None})


def _arrows() -> dict[tuple[Mode | str, Mode | str], list[str]]:
    """Pairs of boxes, with the words of the events that lead from one to the other."""
    result: dict[tuple[Mode | str, Mode | str], list[str]] = {}
    for event in automaton.EVENTS:
        for source in _sources(event):
            target = _target(event, source)
            if target != source:
                words: Sequence[str] = event.words
                if event.chosen_by == "motion" and not isinstance(source, str):
                    words = [event.words[dict(source)["motion"] == OPENING]]
                result.setdefault((source, target), []).extend(words)
    (rest,) = (rule for rule in automaton.RULES if rule.name == "rest")
    result[_mode(1, CLOSING), _mode(1, OPENING, 1)] = [f"a criterion, {rest.words[0]} (beyond the film too)"]
    return result


def _sources(event: Event) -> list[Mode | str]:
    """Boxes in which an event can happen; a single box for all modes if it is watched in each."""
    if not event.where:
        return [_ANY]
    result: list[Mode | str] = []
    for box in _PLACES:
        state = {} if isinstance(box, str) else dict(box)
        watched = bool(state) and all(state.get(component, value) == value for component, value in event.where)
        # while closing the film can only be entered, while opening only left
        passes = event.follows != "film" or (bool(state) and (state["film"] == 1) == (state["motion"] == OPENING))
        if watched and passes:
            result.append(box)
    return result


def _target(event: Event, source: Mode | str) -> Mode | str:
    last = event.actions[-1]
    if isinstance(source, str) or event.ends:
        return _SEPARATED if last == "separate" else _CUT_OFF
    state = dict(source)
    change = {
        "turn": {"motion": -state["motion"]},
        "rebound": {"motion": OPENING},
        "cross film edge": {"film": 1 - state["film"]},
        "open": {"motion": OPENING, "resting": 0},
    }.get(last, {})
    return _mode(**(state | change))


def _label(box: Mode | str) -> str:
    if isinstance(box, str):
        return box
    names = {(component.name, value): name for component in automaton.COMPONENTS for value, name in component.values}
    state = dict(box)
    if state["resting"]:
        return "resting contact"
    return f"{names['motion', state['motion']]}\n{names['film', state['film']]}"
