"""Binary trees over (x, z) with a tensor-product Chebyshev series in t, x and z in each leaf, as flat arrays.

Coordinates, all in 0..1: t (third variable), x (across an angle panel), z (across a cell). The series of panel edges
and of boundaries do not depend on z.
"""

from dataclasses import dataclass

import numpy as np

LEAF = -1


@dataclass
class Trees:
    """Many trees in common arrays; a tree is given by the number of its root node, a leaf holds a patch.

    Attributes:
        axis: what each node divides: 0 for x, 1 for z; LEAF for a leaf.
        cut: coordinate at which a node divides; below it goes to `child`, else to `child + 1`.
        child: first child of each node; of a leaf, the number of its patch.
        box: lower ends and reciprocal sizes of each patch: (x, z, 1/dx, 1/dz).
        size: numbers of coefficients of each patch in t, x and z.
        start: index in `coefficients` of each patch's first.
        coefficients: of all patches, those of one in the order (result, t, x, z).
        count: number of functions in each series, one for each result; 1 for edges.
    """

    axis: np.ndarray
    cut: np.ndarray
    child: np.ndarray
    box: np.ndarray
    size: np.ndarray
    start: np.ndarray
    coefficients: np.ndarray
    count: int

    def patch_of(self, root: np.ndarray, x: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Number of the patch of each point (x, z), in the tree with its root."""
        node = root.copy()
        while True:
            axis = self.axis[node]
            inner = np.flatnonzero(axis != LEAF)
            if not inner.size:
                return np.asarray(self.child[node])
            at = np.where(axis[inner] == 0, x[inner], z[inner])
            node[inner] = self.child[node[inner]] + (at >= self.cut[node[inner]])

    def values(
        self, root: np.ndarray, t: np.ndarray, x: np.ndarray, z: np.ndarray, slopes: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Values (n x count), and with `slopes` derivatives by t, x and z (3 x n x count)."""
        result = np.zeros((root.size, self.count))
        slope = np.zeros((3 if slopes else 0, root.size, self.count))
        if not root.size:
            return result, slope
        patch = self.patch_of(root, x, z)
        order = np.argsort(patch, kind="stable")
        edges = np.flatnonzero(np.diff(patch[order])) + 1
        for group in np.split(order, edges):
            k = int(patch[group[0]])
            n_t, n_x, n_z = (int(n) for n in self.size[k])
            size = n_t * n_x * n_z * self.count
            block = self.coefficients[self.start[k] : self.start[k] + size].astype(float)
            block = block.reshape(self.count, n_t, n_x, n_z)
            low_x, low_z, per_x, per_z = self.box[k]
            basis_t, slope_t = chebyshev(2 * t[group] - 1, n_t)
            basis_x, slope_x = chebyshev(2 * (x[group] - low_x) * per_x - 1, n_x)
            basis_z, slope_z = chebyshev(2 * (z[group] - low_z) * per_z - 1, n_z)
            result[group] = np.einsum("mijk,ni,nj,nk->nm", block, basis_t, basis_x, basis_z, optimize=True)
            if slopes:
                slope[0, group] = 2 * np.einsum("mijk,ni,nj,nk->nm", block, slope_t, basis_x, basis_z, optimize=True)
                slope[1, group] = (
                    2 * per_x * np.einsum("mijk,ni,nj,nk->nm", block, basis_t, slope_x, basis_z, optimize=True)
                )
                slope[2, group] = (
                    2 * per_z * np.einsum("mijk,ni,nj,nk->nm", block, basis_t, basis_x, slope_z, optimize=True)
                )
        return result, slope


def chebyshev(x: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Chebyshev polynomials at points (n x count), and their derivatives."""
    value, slope = np.zeros((x.size, count)), np.zeros((x.size, count))
    value[:, 0] = 1.0
    if count > 1:
        value[:, 1], slope[:, 1] = x, 1.0
    for k in range(2, count):
        value[:, k] = 2 * x * value[:, k - 1] - value[:, k - 2]
        slope[:, k] = 2 * value[:, k - 1] + 2 * x * slope[:, k - 1] - slope[:, k - 2]
    return value, slope


def nodes(count: int) -> np.ndarray:
    """Chebyshev points of the first kind in 0..1, ascending."""
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count))


def transform(count: int) -> np.ndarray:
    """The matrix that turns values at `nodes` into coefficients."""
    at = 2 * nodes(count) - 1
    matrix: np.ndarray = 2.0 / count * np.cos(np.arange(count)[:, None] * np.arccos(at)[None, :])
    matrix[0] *= 0.5
    return matrix


class Forest:
    """Trees under construction."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.axis: list[int] = []
        self.cut: list[float] = []
        self.child: list[int] = []
        self.box: list[tuple[float, float, float, float]] = []
        self.size: list[tuple[int, ...]] = []
        self.coefficients: list[np.ndarray] = []

    def mark(self) -> tuple[int, int]:
        return len(self.axis), len(self.box)

    def reset(self, mark: tuple[int, ...]) -> None:
        """Remove the nodes and patches added since a mark."""
        for nodes_ in (self.axis, self.cut, self.child):
            del nodes_[mark[0] :]
        for patches in (self.box, self.size, self.coefficients):
            del patches[mark[1] :]

    def node(self) -> int:
        """A new node, which `divide` or `leaf` must complete."""
        self.axis.append(LEAF)
        self.cut.append(0.0)
        self.child.append(-1)
        return len(self.axis) - 1

    def divide(self, node: int, axis: int, cut: float) -> tuple[int, int]:
        """Divide a node; returns its children."""
        first, second = self.node(), self.node()
        self.axis[node], self.cut[node], self.child[node] = axis, cut, first
        return first, second

    def leaf(self, node: int, low: np.ndarray, wide: np.ndarray, series: np.ndarray) -> None:
        """Make a node a leaf, whose patch has these coefficients (result, t, x, z)."""
        self.child[node] = len(self.box)
        self.box.append((float(low[0]), float(low[1]), 1 / float(wide[0]), 1 / float(wide[1])))
        self.size.append(series.shape[1:])
        self.coefficients.append(series)

    def trees(self, kind: type = np.float64) -> Trees:
        """The trees so far, with coefficients of this number type."""
        counts = [one.size for one in self.coefficients]
        flat = [one.ravel() for one in self.coefficients]
        return Trees(
            np.array(self.axis, dtype=np.int8),
            np.array(self.cut, dtype=float),
            np.array(self.child, dtype=np.int32),
            np.array(self.box, dtype=float).reshape(-1, 4),
            np.array(self.size, dtype=np.int16).reshape(-1, 3),
            np.array(np.cumsum([0, *counts[:-1]]) if counts else [], dtype=np.int32),
            np.concatenate(flat).astype(kind) if flat else np.zeros(0, kind),
            self.count,
        )
