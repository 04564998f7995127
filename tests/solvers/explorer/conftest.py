"""A browser without a window; a test is skipped, with a reason, where there is none."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from .page import Page, written

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking", "--disable-sync"]
# In place of the browser's: the page has its coarse map, which it makes itself, and waits for the fine one for ever.
NO_WORKERS = "window.Worker = class { postMessage() {} terminate() {} }"


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium without a window."""
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright (pip install playwright)")
    if BROWSER is None:
        pytest.skip("needs Chromium")
    with playwright.sync_playwright() as driver:
        yield driver.chromium.launch(executable_path=BROWSER, args=FLAGS)


@pytest.fixture(scope="session")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Pages that are written already."""
    return {"": tmp_path_factory.mktemp("pages")}


@pytest.fixture(scope="module")
def opened(browser: Any, files: dict[str, Path]) -> Iterator[Any]:
    """Opens the page of a scene by name; the next one takes its place. Nothing moves by itself, which takes time.

    Nor are there fine maps without workers, which take most of the time.
    """
    contexts: list[Any] = []

    def open_page(name: str, address: str = "", workers: bool = True, **settings: Any) -> Page:
        while contexts:
            contexts.pop().close()
        contexts.append(browser.new_context(**{"reduced_motion": "reduce"} | settings))
        if not workers:
            contexts[-1].add_init_script(NO_WORKERS)
        return Page(contexts[-1].new_page(), written(files, name), address, workers)

    yield open_page
    for each in contexts:
        each.close()
