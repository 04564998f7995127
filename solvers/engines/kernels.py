"""What the Taylor kernels of scenes answer, and `compile_kernels`, which compiles them before they are needed."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from pathlib import Path

from ..errors import ComputationError
from ..host.arguments import check_flag
from ..host.compiler import compiler
from ..host.user_cache import folder, why_unwritable
from ..scene.items import item
from ..scene.origin import Record
from ..scene.scene import Scene
from .settings import RTOL, check_rtol
from .taylor.build import compile_all, is_compiled, kernel_supports, size_of
from .taylor.call import variant
from .taylor.orders import order_backward, order_for
from .taylor.source import Variant
from .taylor.tangent import variant_of
from .taylor.undecided import no_kernel

Named = Scene | str | Path


class CompiledKernel(Record):
    """A kernel of a scene."""

    _keys = "scene oblique order serves already seconds bytes"

    scene: str = item("the name of the scene")
    oblique: bool = item("for oblique collisions; else for head-on ones")
    order: int = item("of the Taylor series")
    serves: tuple[str, ...] = item("what it answers")
    already: bool = item("True if it came with the package or was compiled before")
    seconds: float = item("that its compilation took, 0 if it was compiled before")
    bytes: int = item("size in the cache")

    def __str__(self) -> str:
        took = "already compiled" if self.already else f"{self.seconds:.2f} s"
        about, size = "oblique" if self.oblique else "head-on", f"{self.bytes / 1000:4.0f} kB"
        return f"  {about:7}  order {self.order:2}  {took:>16}  {size}  {', '.join(self.serves)}"


def compile_kernels(
    scenes: Named | Iterable[Named],
    *,
    rtol: float | Sequence[float] = RTOL,
    derivatives: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[CompiledKernel, ...]:
    """Compile the kernels of scenes, on all cores, so that no later process waits for them.

    Those of `collide` with and without ledger and trajectory, `collide_many`, `regime_map` and `boundary`, for oblique
    and for head-on collisions. Kernels depend on the terms and laws of a scene and not on its numbers.

    Arguments:
        scenes: a Scene, a path to a scene file, a preset's name, or several of these.
        rtol: relative tolerances for which they are needed, 1e-13..1e-3.
        derivatives: also those of `sensitivities` and `gradients_many`, which take several seconds each.
        progress: called with the numbers of finished and of all kernels.

    Returns:
        A `CompiledKernel` for each, in the order of the scenes.

    Raises:
        InputError: a scene or option is not acceptable.
        ComputationError: there is no C compiler, it fails, a law of the scene has no Taylor series, or
            the cache cannot be written.

    Example:
        >>> from wetdoublet.solvers import compile_kernels
        >>> first = compile_kernels("granulation", rtol=1e-6)[0]
        >>> first.serves, first.oblique, first.order
        (('collide',), True, 9)
    """
    loaded = [Scene.load(source) for source in ([scenes] if isinstance(scenes, (Scene, str, Path)) else scenes)]
    tolerances = [check_rtol(tolerance) for tolerance in ([rtol] if isinstance(rtol, (int, float, str)) else rtol)]
    check_flag(derivatives, "derivatives")
    wanted: dict[Variant, tuple[Scene, bool, list[str]]] = {}
    for scene in loaded:
        if not kernel_supports(scene):
            if compiler() is None:
                raise no_kernel()
            message = "a law of this scene has no Taylor series"
            raise ComputationError(f"{scene.name or 'scene'}: {message}")
        for use, oblique, kernel in needed(scene, tolerances, derivatives):
            serves = wanted.setdefault(kernel, (scene, oblique, []))[2]
            if use not in serves:
                serves.append(use)
    already = {variant for variant in wanted if is_compiled(variant)}
    missing = [variant for variant in wanted if variant not in already]
    if missing and (reason := why_unwritable()):
        message = f"kernels cannot be kept in the cache {folder()}: {reason}"
        raise ComputationError(message, advice="name a folder that can be written in WETDOUBLET_CACHE")
    took = compile_all(missing, progress)
    failed = [variant for variant, seconds in took.items() if seconds is None]
    if failed:
        scene, _, serves = wanted[failed[0]]
        message = f"{scene.name or 'scene'}: the kernel for {', '.join(serves)} could not be compiled"
        raise ComputationError(message, advice="see the remark of the compiler")
    return tuple(
        CompiledKernel(
            scene.name, oblique, variant.order, tuple(serves), variant in already, took.get(variant) or 0.0,
            size_of(variant),
        )
        for variant, (scene, oblique, serves) in wanted.items()
    )  # fmt: skip


def differentiates(scene: Scene, oblique: Collection[bool] = (True, False)) -> bool:
    """True if the kernel differentiates a scene's collisions: oblique ones, head-on ones or both."""
    return kernel_supports(scene, oblique, gradients=True)


def needed(scene: Scene, tolerances: Sequence[float], derivatives: bool) -> Iterator[tuple[str, bool, Variant]]:
    """Use, obliquity and variant of each kernel; some uses share one."""
    for rtol in tolerances:
        for oblique in (True, False):
            yield "collide", oblique, variant(scene, oblique, rtol, ledger=True, small=True)
            yield "collide with its trajectory", oblique, variant(scene, oblique, rtol, ledger=True, trajectory=True)
            yield "collide without ledger", oblique, variant(scene, oblique, rtol, small=True)
            yield "collide_many", oblique, variant(scene, oblique, rtol, rotation=False)
            for small in (True, False):
                yield "map", oblique, variant(scene, oblique, rtol, small=small)
            yield "boundary", oblique, variant(scene, oblique, RTOL, trajectory=True, fold=False)
            if derivatives:
                for rotation in (False, True):
                    yield "sensitivities", oblique, variant_of(scene, oblique, order_for(rtol), rotation, small=True)
                yield "gradients_many", oblique, variant_of(scene, oblique, order_backward(rtol), False, True)
