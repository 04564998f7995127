"""CasADi functions compiled as C and loaded. Without a compiler they are interpreted."""

from casadi import Function, external

from .compiler import CannotCompile, compiler, key, library, more_flags
from .remarks import say_once
from .user_cache import kept, loaded

FLAGS = (
    "-O1",
    "-fPIC",
    "-shared",
    "-ffp-contract=off",  # as interpreted: products and sums are rounded one by one
)  # -O3 compiles 1.6 times as long, runs a sixth faster (docs/engineering/performance.md)


def compiled(function: Function) -> Function:
    """`function` as machine code if there is a compiler, else `function` itself. Safe with several processes."""
    working = compiler()
    if working is None:
        return function
    name, source, flags = function.name(), _source(function), FLAGS + more_flags()
    try:
        content = kept(f"{name}-{key(source, flags)}.so", lambda: library(source, flags))
        return loaded(content, lambda path: external(name, path))
    except (CannotCompile, OSError, RuntimeError) as error:
        message = " ".join(str(error).split())
        say_once(f"{working} cannot compile {name} ({message}): it runs interpreted")
        return function


def _source(function: Function) -> str:
    """C source of a function."""
    from casadi import CodeGenerator

    generator = CodeGenerator(function.name())
    generator.add(function)
    return str(generator.dump())
