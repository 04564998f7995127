"""Work in a process that outlives the one that starts it."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from wetdoublet.solvers import InputError
from wetdoublet.solvers.host.background import allowed, begin
from wetdoublet.solvers.host.locks import take
from wetdoublet.solvers.host.user_cache import lock_file

from ...helpers.command import PATIENCE

pytestmark = pytest.mark.skipif(os.name != "posix", reason="no background processes")


@pytest.mark.parametrize(
    ("setting", "ci", "expected"),
    [(None, None, True), ("off", None, False), ("on", None, True), (None, "true", False), ("on", "true", True)],
)
def test_who_forbids_it(monkeypatch, setting, ci, expected):
    """It is allowed unless WETDOUBLET_BACKGROUND is off, or CI is set and WETDOUBLET_BACKGROUND is not on."""
    for name, value in {"WETDOUBLET_BACKGROUND": setting, "CI": ci}.items():
        if value is None:
            monkeypatch.delenv(name, raising=False)
        else:
            monkeypatch.setenv(name, value)
    assert allowed() is expected


def test_a_wrong_setting_is_named(monkeypatch):
    """Anything but on and off is an input error."""
    monkeypatch.setenv("WETDOUBLET_BACKGROUND", "maybe")
    with pytest.raises(InputError, match=r"WETDOUBLET_BACKGROUND: \"maybe\" is not known; accepted: on, off"):
        allowed()


def test_one_at_a_time_for_each_cache(monkeypatch, tmp_path):
    """While the cache's lock is held nothing is started; once it is free the work is done."""
    monkeypatch.setenv("WETDOUBLET_BACKGROUND", "on")
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path / "cache"))
    done = tmp_path / "done"
    descriptor = lock_file()
    assert descriptor is not None
    assert take(descriptor)
    assert not begin(Path.touch, done)
    os.close(descriptor)
    assert begin(Path.touch, done)
    deadline = time.monotonic() + PATIENCE
    while not done.exists():
        assert time.monotonic() < deadline
        time.sleep(0.02)
