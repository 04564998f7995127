"""The kernel as a loaded library: source from emitted headers and the runtime, compiled once into the user's cache."""

import ctypes
import time
from collections.abc import Callable, Collection
from functools import cache

from ...errors import ComputationError
from ...host.compiler import CannotCompile, compiler, key
from ...host.compiler import library as compiled
from ...host.remarks import say_after
from ...host.thread_caches import once
from ...host.user_cache import fetch, has, loaded, lookup
from ...host.workers import usable_cores
from ...model.model import select_model
from ...scene.scene import Scene
from ..machine import own_sets
from ..settings import RTOL
from .headers import headers, tangents
from .orders import order_for
from .shipped import is_shipped, shipped
from .source import Variant, emitted_headers, flags, source, stem
from .undecided import no_kernel

_PATIENCE = 1.0  # s that a compilation may last before a remark


def kernel_supports(scene: Scene, obliquities: Collection[bool] = (True, False), gradients: bool = False) -> bool:
    """True if the kernel can integrate a scene here.

    Its laws have recurrences (and derivatives), and its kernel of the default tolerance is shipped or there is a
    compiler.

    Arguments:
        obliquities: True for oblique and False for head-on collisions, which have kernels of their own.
        gradients: with derivatives.
    """
    keys = [select_model(scene, oblique, fold=not gradients) for oblique in obliquities]
    if not all(headers(choice) and (tangents(choice) if gradients else True) for choice in keys):
        return False
    variants = (Variant(choice, order_for(RTOL), gradients=gradients) for choice in keys)
    return all(is_shipped(variant) for variant in variants) or compiler() is not None


def is_compiled(variant: Variant) -> bool:
    """True if the library of a variant is shipped or in the cache; nothing is derived or compiled for the answer."""
    if is_shipped(variant):
        return True
    if not has(f"{stem(variant)}-"):
        return False  # its headers may not have been derived yet
    entry = _expected(variant, flags(variant, own_sets()[0]))
    return entry is not None and has(entry.removesuffix("so"))


@cache
def _expected(variant: Variant, flags: tuple[str, ...]) -> str | None:
    """Name of a variant's library in the cache; None if it cannot be compiled."""
    emitted = emitted_headers(variant)
    return None if compiler() is None or emitted is None else _entry(variant, source(variant, emitted), flags)


def _entry(variant: Variant, text: str, flags: tuple[str, ...]) -> str:
    return f"{stem(variant)}-{key(text, flags)}.so"


@once
def kernel(variant: Variant) -> ctypes.CDLL:
    """The loaded kernel of a variant.

    Raises:
        ComputationError: it is not shipped, and there is no compiler or compilation fails.
    """
    content = shipped(variant) or _compiled(variant)
    try:
        library = loaded(content, ctypes.CDLL)
    except OSError as error:
        raise no_kernel(f"cannot be loaded ({error})") from None
    library.collide.restype = ctypes.c_char_p
    library.collide.argtypes = [ctypes.c_void_p]
    return library


def _compiled(variant: Variant) -> bytes:
    """The library of a variant, compiled if it is not in the cache."""
    tool = compiler()
    with say_after(_PATIENCE, "a kernel for this kind of scene is compiled, once; most take some seconds"):
        emitted = None if tool is None else emitted_headers(variant)
        if emitted is None:
            raise no_kernel() if tool is None else ComputationError("a law or event of this scene has no Taylor series")
        text, flagged = source(variant, emitted), flags(variant, own_sets()[0])
        try:
            return fetch(_entry(variant, text, flagged), lambda: compiled(text, flagged))
        except (CannotCompile, OSError) as error:
            ours = "source.c:" in str(error)  # a place in the text that we emit, not a failure of the compiler
            what = (
                "the C emitted for the Taylor kernel is wrong" if ours else f"{tool} cannot compile the Taylor kernel"
            )
            raise ComputationError(f"{what} ({error})", advice="please report the model" * ours) from None


def compile_all(
    variants: Collection[Variant], progress: Callable[[int, int], None] | None = None
) -> dict[Variant, float | None]:
    """Compile the kernels of several variants in parallel, where they are not cached.

    Arguments:
        progress: called with the numbers of finished and of all kernels.

    Returns:
        The seconds that each took; None for one that cannot be compiled.
    """
    from concurrent.futures import ThreadPoolExecutor  # slow import

    def compiled_here(variant: Variant) -> float | None:
        start = time.perf_counter()
        try:
            kernel(variant)
        except ComputationError:
            return None
        return time.perf_counter() - start

    took: dict[Variant, float | None] = {}
    with ThreadPoolExecutor(usable_cores()) as pool:  # threads suffice, since compilers are separate processes
        try:
            for variant, seconds in zip(variants, pool.map(compiled_here, variants), strict=True):
                took[variant] = seconds
                if progress is not None:
                    progress(len(took), len(variants))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)  # those that run get the interrupt themselves, and end
            raise
    return took


def size_of(variant: Variant) -> int:
    """Size in bytes of the compiled library of a variant; 0 if there is none yet."""
    content = shipped(variant)
    if content is None:
        entry = _expected(variant, flags(variant, own_sets()[0]))
        content = lookup(entry) if entry is not None else None
    return len(content or b"")
