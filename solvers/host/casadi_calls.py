"""Calls of CasADi functions: on numpy arrays without conversion to CasADi matrices, and with their prints captured.

The former is about ten times faster. CasADi prints on `sys.stderr`, which all threads share. A temporary replacement
stores the output of capturing threads and passes the output of all others to the original stream. Threads may start and
end capturing in any order.
"""

import contextlib
import io
import sys
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
from casadi import Function


class Buffered:
    """A function of dense columns with arguments and one result in fixed memory. Use it in one thread only.

    Arguments:
        function: the CasADi function.
        inputs: indices of the passed arguments; the others are zero.
        result: index of the returned result.
    """

    def __init__(self, function: Function, inputs: tuple[int, ...], result: int = 0) -> None:
        self.function = function
        self._buffer, self._evaluate = function.buffer()
        self._arguments = [np.zeros(function.nnz_in(k)) for k in inputs]
        for k, argument in zip(inputs, self._arguments, strict=True):
            self._buffer.set_arg(k, memoryview(argument))  # type: ignore[call-arg, arg-type]  # stubs: (index, pointer, size) only
        self._counts = not function.is_a("External")  # an integrator compiled to C keeps no statistics
        self._result = np.zeros(function.nnz_out(result))
        self._buffer.set_res(result, memoryview(self._result))  # type: ignore[call-arg, arg-type]  # as above

    def __call__(self, *values: np.ndarray) -> np.ndarray:
        """The result as a new array. RuntimeError if the function fails."""
        for argument, value in zip(self._arguments, values, strict=True):
            argument[:] = value
        self._evaluate()
        if self._buffer.ret():
            raise RuntimeError("Evaluation failed")
        return self._result.copy()

    @property
    def steps(self) -> int:
        """Number of steps of the integrator's last call; 0 if it is compiled."""
        stats = self._buffer.stats() if self._counts else {}
        return int(stats.get("n_steps", stats.get("nsteps", 0)))


class _Capture(threading.local):
    text: io.StringIO | None = None


_CAPTURE = _Capture()
_LOCK = threading.Lock()
_capturing = 0


class _PerThreadStream:
    """A stream that stores the output of capturing threads and passes on that of the others."""

    def __init__(self, original: Any) -> None:
        self.original = original

    def write(self, text: str) -> int:
        stream = _CAPTURE.text or self.original
        written: int = stream.write(text)
        return written

    def __getattr__(self, name: str) -> Any:
        return getattr(self.original, name)


@contextlib.contextmanager
def captured_stderr() -> Iterator[io.StringIO]:
    """Capture the text that this thread prints on `sys.stderr`."""
    global _capturing  # counted for the process, because sys.stderr is shared
    before, text = _CAPTURE.text, io.StringIO()
    with _LOCK:
        _capturing += 1
        if not isinstance(sys.stderr, _PerThreadStream):
            sys.stderr = _PerThreadStream(sys.stderr)
    _CAPTURE.text = text
    try:
        yield text
    finally:
        _CAPTURE.text = before
        with _LOCK:
            _capturing -= 1
            if not _capturing and isinstance(sys.stderr, _PerThreadStream):
                sys.stderr = sys.stderr.original
