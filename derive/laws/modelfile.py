"""Reading of a model file: run it, collect its declarations, derive its laws."""

import re
import traceback
from pathlib import Path

from .. import laws
from ..user.declarations import Declarations, ModelFileError, collecting
from ..user.structures import UserModel, express
from . import LAWS, files

_LARGEST = 1_000_000  # bytes
_IMPORTS = re.compile(r"(?<!wetdoublet\.derive\.user )\bimport")
_ACCEPTED = "a model file (see `wetdoublet generate --template`)"


def declared(path: Path, text: str | None = None) -> tuple[str, Declarations]:
    """The docstring's first line and the declarations of a model file; `text` replaces its content.

    Raises:
        ModelFileError: the file cannot be read or run, or declares nothing; names the line.
    """
    source = _text(path) if text is None else text
    for name in files() if _IMPORTS.search(source) else ():  # imported later, they would declare laws of its own
        getattr(laws, name)
    namespace = {"__name__": "wetdoublet_model", "__package__": __package__, "__file__": str(path)}
    with collecting(LAWS) as result:
        try:
            exec(compile(source, str(path), "exec", dont_inherit=True), namespace)  # the warnings are the user's own
        except ModelFileError as error:
            where = f"{path}, line {_line(error, path)}: {error.field}"
            raise ModelFileError(where, error.value, error.accepted, error.problem) from None
        except SyntaxError as error:
            where, problem = f"{path}, line {error.lineno}", f"is not Python ({error.msg})"
            raise ModelFileError(where, (error.text or "").strip(), "a model file", problem) from None
        except Exception as error:  # noqa: BLE001 # whatever a user's file does
            where = f"{path}, line {_line(error, path)}"
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise ModelFileError(where, None, _remedy(error), reason) from None
    if not (result.laws or result.events or result.energies or result.forces or result.criteria):
        accepted = "law(SLOT, NAME, ...), event(...), energy(...), force_on(...) or criterion(...), at least once"
        raise ModelFileError(str(path), None, accepted, "declares no law, event, term or criterion")
    doc = namespace.get("__doc__") or ""
    return doc.strip().partition("\n")[0].rstrip("."), result


def read(path: Path, text: str | None = None, name: str = "") -> UserModel:
    """The derived model of a file; `name` by default the file's.

    Raises:
        ModelFileError: as `declared`. DimensionError, ScalingError: as `express`.
    """
    meaning, result = declared(path, text)
    return express(name or path.stem.replace("_", "-"), meaning or "a user's model", result)


def _text(path: Path) -> str:
    try:
        if not path.is_file() and not path.is_dir():  # reading a pipe or a device may never end
            raise ModelFileError(str(path), None, _ACCEPTED, "is not a file" if path.exists() else "is not there")
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
        if len(content) > _LARGEST:
            raise ModelFileError(str(path), None, _ACCEPTED, "is larger than any model")
        return content.decode("utf-8")
    except OSError as error:
        raise ModelFileError(str(path), None, _ACCEPTED, f"cannot be read ({error.strerror or error})") from None
    except UnicodeDecodeError:
        raise ModelFileError(str(path), None, _ACCEPTED, "is not UTF-8 text") from None


def _remedy(error: Exception) -> str:
    """What to write in place of what failed."""
    if isinstance(error, NameError):
        return "a name of `wetdoublet generate --names`, or one of the file's own"
    if "truth value of Relational" in str(error):
        return "Piecewise((value, condition), (value, True)) in place of if, and, or"
    if "ufunc" in str(error):
        return "the functions of a model file, as exp(x), in place of numpy's"
    return _ACCEPTED


def _line(error: BaseException, path: Path) -> int:
    """The last line of the model file in the traceback of the error."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
    return (lines or [0])[-1] or 0
