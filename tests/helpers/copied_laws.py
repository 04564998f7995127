"""The library's files of laws as model files: the same declarations, each law under another name."""

import re
from pathlib import Path

import wetdoublet.derive.laws
from wetdoublet.derive.laws import LAWS

FOLDER = Path(wetdoublet.derive.laws.__file__).parent
FILES = sorted(path.stem for path in FOLDER.glob("*.py") if path.stem not in ("__init__", "modelfile"))
_NAMES = "|".join(sorted((re.escape(name) for laws in LAWS.values() for name in laws), key=len, reverse=True))


def copied(*files: str) -> str:
    """Text of a model file with the laws of some files, NAME as NAME-copy."""
    text = "\n".join((FOLDER / f"{file}.py").read_text() for file in files)
    return re.sub(rf'^(law\(\s*"\w+", |_\w+\()"({_NAMES})",', r'\1"\2-copy",', text, flags=re.MULTILINE)
