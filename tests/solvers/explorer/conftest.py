"""A browser without a window; a test is skipped, with a reason, where there is none."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from wetdoublet.solvers import InputError, explore

from .page import GRANULATION, Page, written

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking", "--disable-sync"]


@pytest.fixture(scope="module")
def compiler() -> None:
    """Something that compiles a law to WebAssembly."""
    try:
        assert explore(GRANULATION).html
    except InputError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium without a window."""
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright (pip install playwright)")
    if BROWSER is None:
        pytest.skip("needs Chromium")
    with playwright.sync_playwright() as driver:
        yield driver.chromium.launch(executable_path=BROWSER, args=FLAGS)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Pages that are written already."""
    return {}


@pytest.fixture
def opened(browser: Any, compiler: None, files: dict[str, Path], tmp_path: Path) -> Iterator[Any]:
    """Opens the page of a scene by name."""
    contexts = []

    def open_page(name: str, address: str = "", **settings: Any) -> Page:
        contexts.append(browser.new_context(**settings))
        return Page(contexts[-1].new_page(), written(files, name, tmp_path), address)

    yield open_page
    for each in contexts:
        each.close()
