"""Lets sphinx-gallery show the pictures that a script has written, and puts them away."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

LEFT_BEHIND = ("*.csv", "*.nc", "*.toml", "*.txt")


class WrittenPictures:
    """Collects the PNG files in a script's folder."""

    def __repr__(self) -> str:
        """Same text in every build, or sphinx-gallery runs everything again."""
        return "WrittenPictures"

    def __call__(self, _block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
        """Return the text that shows the pictures written since the last call."""
        from sphinx_gallery.scrapers import figure_rst

        folder = Path(block_vars["src_file"]).parent
        targets = []
        for picture in sorted(folder.glob("*.png"), key=lambda path: path.stat().st_mtime):
            target = next(block_vars["image_path_iterator"])
            shutil.move(picture, target)
            targets.append(target)
        for pattern in LEFT_BEHIND:
            for path in folder.glob(pattern):
                path.unlink()
        return figure_rst(targets, gallery_conf["src_dir"])
