"""What a signal does to a running command."""

import os
import signal
import sys

import pytest
from wetdoublet.solvers.host.interrupts import handled


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent as on POSIX")
def test_an_error_that_follows_an_interrupt_is_the_interrupt() -> None:
    """A library that reports an interrupted computation as failed does not turn Ctrl-C into a failure."""

    @handled()
    def interrupted_library() -> None:
        try:
            os.kill(os.getpid(), signal.SIGINT)
            signal.pause()
        except KeyboardInterrupt:
            raise RuntimeError("step failed") from None

    with pytest.raises(KeyboardInterrupt):
        interrupted_library()


def test_an_error_without_a_signal_stays_an_error() -> None:
    """Only a received signal turns an error into an interrupt."""
    with pytest.raises(RuntimeError, match="step failed"), handled():
        raise RuntimeError("step failed")
