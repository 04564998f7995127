"""Loops over the terms of a sum that differ in constants only, as those of an integral over its nodes.

Written out, each node has a text of its own, which compilers read for minutes. Here the terms are compared with each
other from the sum down: what is the same operation in all of them is a family, computed in a loop, whose members are
one array over the nodes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .program import Operation

LEAST = 6
"""Terms of which a loop is made."""


class Loops:
    """The families of a program's operations.

    Arguments:
        operations: of the program, in order.
        before: the loops of the program that it continues.

    Attributes:
        places: for each member of a family, the first member and the node; also of those before.
        families: operations of the members by the name of the first.
    """

    def __init__(self, operations: Sequence[Operation] = (), before: Loops | None = None) -> None:
        self._own = {operation.name: operation for operation in operations}
        self._shapes: dict[str, object] = {}
        self.places: dict[str, tuple[str, int]] = dict(before.places) if before else {}
        self.families: dict[str, tuple[Operation, ...]] = {}
        for operation in operations:
            for terms in self._alike(operation) if operation.kind == "linear" else ():
                places, families = dict(self.places), dict(self.families)
                if self._same(terms, places, families):
                    self.places, self.families = places, families

    def _alike(self, total: Operation) -> list[tuple[str, ...]]:
        """The terms of a sum, in groups of one shape each, in the order in which they are computed."""
        groups: dict[object, list[str]] = {}
        terms = {*total.series} - self.places.keys()
        for name in (name for name in self._own if name in terms):
            groups.setdefault(self._shape(name), []).append(name)
        return [tuple(group) for group in groups.values() if len(group) >= LEAST]

    def _shape(self, name: str) -> object:
        """What the members of a family have in common."""
        if name in self.places or name not in self._own:
            return self.places.get(name, (name,))[0]
        if name not in self._shapes:
            operation = self._own[name]
            self._shapes[name] = hash((operation.kind, *map(self._shape, operation.series)))
        return self._shapes[name]

    def _same(
        self, names: Sequence[str], places: dict[str, tuple[str, int]], families: dict[str, tuple[Operation, ...]]
    ) -> bool:
        """True if these are one series, or members of a family, which is added with all that it is computed from."""
        if len(set(names)) == 1:
            return names[0] not in places
        if any(name in places for name in names):
            first = places.get(names[0], ("", 0))[0]
            return [places.get(name) for name in names] == [(first, node) for node in range(len(names))]
        members = tuple(self._own[name] for name in names if name in self._own)
        if len(set(names)) < len(names) or len(members) < len(names):
            return False
        factors = zip(*(member.factors for member in members), strict=True) if members[0].factors else ()
        if members[0].kind not in ("linear", "product") and any(len(set(column)) > 1 for column in factors):
            return False
        kinds = {(member.kind, len(member.series)) for member in members}
        if len(kinds) > 1 or members[0].kind in ("call", "sine", "cosine"):
            return False
        places |= {name: (names[0], node) for node, name in enumerate(names)}
        families[names[0]] = members
        columns = zip(*(member.series for member in members), strict=True)
        return all(self._same(column, places, families) for column in columns)

    def stages(self) -> Iterator[tuple[int, list[Operation]]]:
        """Operations in the order of computation, of families the first: number of nodes (or 0), operations."""
        stage: dict[str, int] = {}
        for name, operation in self._own.items():
            looped = name in self.families
            if looped or name not in self.places:
                inner = [stage.get(self.places.get(operand, (operand, 0))[0], 0) for operand in operation.series]
                stage[name] = max([looped, *(above + (above % 2 != looped) for above in inner)])
        for number in range(max(stage.values(), default=-1) + 1):
            nodes = {name: len(self.families.get(name, ())) for name in self._own if stage.get(name) == number}
            for count in dict.fromkeys(nodes.values()):
                yield count, [self._own[name] for name, own in nodes.items() if own == count]
