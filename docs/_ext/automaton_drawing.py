"""The automaton as an SVG diagram: modes as boxes, events as arrows between them."""

from collections.abc import Sequence
from html import escape

from wetdoublet.derive.equations import automaton
from wetdoublet.derive.equations.automaton import CLOSING, OPENING, Event

_WIDTH, _HEIGHT = 980, 600
_BOX = 150, 52
_CLEAR = 2  # distance between a box and an arrow
_HALO = ' stroke="white" stroke-width="4"'  # halo of a label: the same text in a wide white stroke behind it
Mode = tuple[tuple[str, int], ...]


def _mode(film: int, motion: int, resting: int = 0) -> Mode:
    return (("film", film), ("motion", motion), ("resting", resting))


_SEPARATED, _CUT_OFF, _ANY = "separated", "stick, cut off", "any mode"
# centre of each box
_PLACES: dict[Mode | str, tuple[int, int]] = {
    _mode(0, CLOSING): (190, 130), _mode(0, OPENING): (560, 130), _mode(1, CLOSING): (190, 330),
    _mode(1, OPENING): (560, 330), _mode(1, OPENING, 1): (560, 520), _SEPARATED: (870, 130), _ANY: (870, 330),
    _CUT_OFF: (870, 520),
}  # fmt: skip


def drawing() -> str:
    """The diagram as the text of an SVG file."""
    lines = [
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}"'
            f' width="{_WIDTH}" height="{_HEIGHT}" font-family="sans-serif" font-size="13">'
        ),
        "<title>Modes of a collision and the events between them</title>",
        (
            '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
            '<path d="M0,0 L8,4 L0,8 z" fill="#333"/></marker></defs>'
        ),
        f'<rect width="{_WIDTH}" height="{_HEIGHT}" fill="white"/>',
        '<text x="190" y="420" text-anchor="middle" fill="#555">starts here, at initial contact</text>',
        '<path d="M190,404 L190,360" stroke="#555" fill="none" marker-end="url(#tip)"/>',
    ]
    for (source, target), words in _arrows().items():
        lines += _arrow(source, target, ", ".join(words))
    for box in _PLACES:
        lines += _box(box)
    return "\n".join([*lines, "</svg>"]) + "\n"


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


def _label(box: Mode | str) -> tuple[str, ...]:
    if isinstance(box, str):
        return (box,)
    names = {(each.name, value): name for each in automaton.COMPONENTS for value, name in each.values}
    state = dict(box)
    if state["resting"]:
        return ("resting contact",)
    return names["motion", state["motion"]], names["film", state["film"]]


def _box(box: Mode | str) -> list[str]:
    (x, y), (width, height) = _PLACES[box], _BOX
    fill = "#FBE3A6" if box in (_SEPARATED, _CUT_OFF) else "#DCEBF5"
    label = _label(box)
    lines = [
        (
            f'<rect x="{x - width // 2}" y="{y - height // 2}" width="{width}" height="{height}" rx="8" fill="{fill}"'
            ' stroke="#333"/>'
        )
    ]
    first = y + 5 - 8 * (len(label) - 1)
    return lines + [
        f'<text x="{x}" y="{first + 17 * k}" text-anchor="middle">{escape(line)}</text>' for k, line in enumerate(label)
    ]


def _arrow(source: Mode | str, target: Mode | str, words: str) -> list[str]:
    """A straight arrow between two boxes, shifted to the right of their line, with its label beside the middle."""
    (x0, y0), (x1, y1) = _PLACES[source], _PLACES[target]
    length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
    along, aside = ((x1 - x0) / length, (y1 - y0) / length), 9.0
    shift = -along[1] * aside, along[0] * aside
    x0, y0, x1, y1 = (round(v) for v in (x0 + shift[0], y0 + shift[1], x1 + shift[0], y1 + shift[1]))
    start = _clip((x0, y0), _PLACES[source], along)
    end = _clip((x1, y1), _PLACES[target], (-along[0], -along[1]))
    middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    steep = abs(along[1]) > 0.8
    anchor = "middle" if not steep else "start" if along[1] < 0 else "end"
    place = (
        middle[0] + (0 if not steep else 8 if along[1] < 0 else -8),
        middle[1] + (0 if steep else -6 if along[0] < 0 else 16),
    )
    return [
        (
            f'<path d="M{start[0]:.0f},{start[1]:.0f} L{end[0]:.0f},{end[1]:.0f}" stroke="#333" fill="none"'
            ' marker-end="url(#tip)"/>'
        ),
        *(
            f'<text x="{place[0]:.0f}" y="{place[1]:.0f}" text-anchor="{anchor}" font-size="12"{halo}>'
            f"{escape(words)}</text>"
            for halo in (_HALO, "")
        ),
    ]


def _clip(point: tuple[float, float], centre: tuple[float, float], along: tuple[float, float]) -> tuple[float, float]:
    """The point at which a ray from a point within a box leaves it."""
    reach = _CLEAR + min(
        (half - (at - middle) * (1 if way > 0 else -1)) / abs(way) if way else 1e9
        for half, at, middle, way in zip((_BOX[0] / 2, _BOX[1] / 2), point, centre, along, strict=True)
    )
    return point[0] + along[0] * reach, point[1] + along[1] * reach
