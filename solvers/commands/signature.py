"""Commands made of functions: options are read off docstrings, and their values checked before any file is read."""

import ast
import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import click

from ..engines.settings import UNTIL
from ..errors import InputError
from ..host import files
from ..scene.schema import FIELDS
from . import texts

_LINE = re.compile(
    r"(?:(?P<flag>-\S+?)(?: (?P<metavar>[^(\s]\S*?))?|(?P<argument>[^-(]+?))"
    r"(?: \((?P<name>\w+)\))?(?::(?: (?P<help>.*))?)?"
)
_PUBLIC = r"^        (\w+): ((?:.|\n {12})*)"
_FORMS: dict[str, Callable[[Any], Any]] = {
    "N": texts.whole,
    "NAMES": texts.names,
    "DIR": partial(files.check_folder, label=""),
    "FILE.png": partial(files.check_file, label="", suffixes=files.PICTURES),
    "FILE.toml": partial(files.check_file, label="", suffixes=(".toml",)),
    "TIME": UNTIL.number,
}
"""What reads a text, by what stands for it in the help."""


@dataclass(frozen=True)
class Option:
    """One option of a command.

    Arguments:
        flag: as it is typed; an argument of the command if it does not begin with a dash.
        metavar: what stands for its value in the help; "" for an option without value.
        help: its line in the help.
        read: the value of the text, None for the text; an InputError of it without a field is about the option.
    """

    flag: str
    metavar: str = ""
    help: str = ""
    read: Callable[[Any], Any] | None = None

    def parameter(self, name: str) -> click.Parameter:
        """The parameter of click."""
        if self.flag[0] != "-":  # not required by click, so that a wrong option is reported before a missing argument
            many = -1 if "..." in self.flag else 1
            return click.Argument([name], metavar=self.flag, required=False, nargs=many, shell_complete=_completed)
        if not self.metavar:
            return click.Option([self.flag, name], is_flag=True, help=self.help)
        form: dict[str, Any] = {"metavar": self.metavar, "multiple": self.help.endswith("repeatable.")}
        if self.metavar[0] == "[":  # of [N=500] the value may be absent
            form |= {"is_flag": False, "flag_value": self.metavar[3:-1]}
        return click.Option([self.flag, name], help=self.help, shell_complete=_completed, **form)


_CHOICES = {
    "source": "scene.scenefile:PRESETS", "engine": "engines.settings:ENGINES", "hold": "scene.held:HOLDS",
    "method": "sensitivity.sensitivities:METHODS", "films": "averages.sizes:FILMS", "to": "commands.scenes:KINDS",
    "item": "verify.paper.reproduce:PARTS", "of": "results:DIFFERENTIATED",
}  # fmt: skip
"""Where the values are among which a parameter has the choice; read when a shell completes a line."""


def _completed(_ctx: click.Context, parameter: click.Parameter, begun: str) -> list[Any]:
    """What a shell may complete: a choice, the name of an entry, and where neither is asked for, files."""
    from click.shell_completion import CompletionItem

    before, comma, _ = begun.rpartition(",") if parameter.metavar == "NAMES" else ("", "", "")
    names: list[str] = []
    if parameter.name in _CHOICES:
        file, name = _CHOICES[parameter.name].split(":")
        names = [*getattr(import_module(f"..{file}", __package__), name)]
    elif str(parameter.metavar).startswith("NAME="):
        names = [f"{name}=" for name in FIELDS if f"{name}=".startswith(begun)]
        if len(names) == 1:  # beside a second one the shell puts no space behind the sign
            field = FIELDS[names[0][:-1]]
            names += [names[0] + value for value in field.choices or [field.example.strip('"')]]
    elif str(parameter.metavar).startswith("NAME"):
        names = [name for name, field in FIELDS.items() if not (field.choices or field.flag)]
    items = [CompletionItem(before + comma + name) for name in names if (before + comma + name).startswith(begun)]
    return items + [CompletionItem(begun, type="file")] * (not names or parameter.name == "source")


@dataclass(frozen=True)
class Group:
    """Several options that are read together as one parameter: the value of their texts, given by keyword."""

    read: Callable[..., Any]
    options: Mapping[str, Option]


SHARED: dict[str, Option] = {}
"""Options that several commands have."""
_REGISTERED: dict[str, tuple[Callable[..., None], str, Mapping[str, str]]] = {}


def command(public: str = "", **required: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Make a function the command of its name, whose docstring is the help.

    The docstring's last section has a line `--flag VALUE: help` for each option, `--flag VALUE (name): help` where the
    parameter has another name. Of an option that several commands have, the flag alone says the rest; a line without
    help has that of the public function's docstring, with the default of its signature. What stands for the value says
    how it is read, unless the parameter's annotation does; `str` is the text as it is typed. An option whose help ends
    in "repeatable." may be given several times. What is absent is None; the function's `**` has those that are present
    and no parameter of its own. An InputError about a parameter, of whatever function, is reported under its option.

    Arguments:
        public: the file below solvers/ and its function that the command is of, `collision.collide:collide`.
        required: what is accepted, by parameter without which the command cannot run.
    """

    def register(function: Callable[..., None]) -> Callable[..., None]:
        _REGISTERED[function.__name__.strip("_").replace("_", "-")] = (function, public, required)
        return function

    return register


def built(name: str) -> click.Command:
    """The command of click."""
    function, public, required = _REGISTERED[name]
    text, _, lines = inspect.cleandoc(function.__doc__ or "").partition("\n\nOptions:\n")
    hints = get_type_hints(function, include_extras=True)
    groups = {key: hint.__metadata__[0] for key, hint in hints.items() if get_origin(hint) is Annotated}
    groups = {key: group for key, group in groups.items() if isinstance(group, Group)}
    own = {key: _read_by(key, option, hints.get(key, Any)) for key, option in options_of(lines, public).items()}
    # a scene with its options comes before the tolerance, results come last
    order = [key for key in own if not any(key in group.options for group in groups.values())]
    after = [*order, "rtol"].index("rtol")
    order[after:after] = [key for key in groups if key != "output"]
    order += [key for key in groups if key == "output"]
    read_by = {key: groups[key] if key in groups else own[key] for key in order}
    options: dict[str, Option] = {}
    for key, item in read_by.items():
        members = item.options if isinstance(item, Group) else {key: item}
        options |= {name: own.get(name, option) for name, option in members.items()}
    flags = {key: option.flag for key, option in options.items()}

    def run(**typed: Any) -> None:
        values: dict[str, Any] = {}
        key = ""
        try:
            for key, item in read_by.items():
                if isinstance(item, Group):
                    values[key] = item.read(**{name: typed[name] for name in item.options})
                else:
                    values[key] = typed[key] if typed[key] is None or item.read is None else item.read(typed[key])
            _check_present(values, flags, required, typed.get("source"))
            given = {key: value for key, value in values.items() if key in hints or not _is_absent(value)}
            function(**given)
        except InputError as error:
            argument, _, rest = error.field.partition(" ")
            flag = flags.get(argument or key, "")
            if flag[:1] != "-":
                raise
            raise InputError(f"{flag} {rest}".strip(), error.value, error.accepted, error.problem) from None

    parameters = [option.parameter(key) for key, option in options.items()]
    debug = click.Option(["--debug"], is_flag=True, expose_value=False, help="Show a traceback behind an error.")
    # a scene is the first argument, wherever its options stand
    parameters.sort(key=lambda item: isinstance(item, click.Argument) and item.name != "source")
    paragraphs = ["\b\n" * ("\n  " in paragraph) + paragraph for paragraph in text.split("\n\n")]
    return click.Command(
        name, callback=run, params=[*parameters, debug], help="\n\n".join(paragraphs),
        short_help=" ".join(text.partition("\n\n")[0].split()),
    )  # fmt: skip


def _is_absent(value: Any) -> bool:
    return value is None or value is False or value in ((), {})


def _check_present(
    values: Mapping[str, Any], flags: Mapping[str, str], required: Mapping[str, str], source: Any
) -> None:
    """InputError for a required parameter that is absent, or before it for a scene that is none."""
    from ..scene.scenefile import read_text

    for key, accepted in required.items():
        if values[key] is None:
            for scene in source[:1] if isinstance(source, tuple) else () if source is None else (source,):
                read_text(scene)
            raise InputError(flags[key], None, accepted)


def options_of(text: str, public: str = "") -> dict[str, Option]:
    """The options that an indented text describes, by parameter."""
    options: dict[str, Option] = {}
    for line in re.split(r"\n    (?=\S)", "\n" + text.rstrip())[1:]:
        words = _LINE.fullmatch(" ".join(line.split()))
        assert words is not None, line
        metavar, name, meaning = words.group("metavar", "name", "help")
        flag = words["flag"] or words["argument"]
        name = name or next((key for key, option in SHARED.items() if option.flag == flag), "")
        name = name or flag.lstrip("-").replace("-", "_")
        plain = SHARED.get(name, Option(flag))
        meaning = meaning or plain.help or (_meaning(public, name) if public and flag[0] == "-" else "")
        options[name] = replace(plain, flag=flag, metavar=metavar or plain.metavar, help=meaning)
    return options


def _meaning(public: str, name: str) -> str:
    """What a public function says of a parameter, and its default; to read its file is cheaper than to import it."""
    file, function = public.split(":")
    path = Path(__file__).parents[1].joinpath(*file.split(".")).with_suffix(".py")
    tree = ast.parse(path.read_text(encoding="utf-8"))
    definition = next(item for item in tree.body if isinstance(item, ast.FunctionDef) and item.name == function)
    meanings = dict(re.findall(_PUBLIC, ast.get_docstring(definition, clean=False) or "", re.MULTILINE))
    given = definition.args
    defaults = [None] * (len(given.args) - len(given.defaults)) + [*given.defaults, *given.kw_defaults]
    index = [argument.arg for argument in (*given.args, *given.kwonlyargs)].index(name)
    default = getattr(defaults[index], "value", None)
    sentence = " ".join(meanings[name].split()).rstrip(".")
    ending = f" [{default}]." if default not in (None, False) else "."
    return sentence[:1].upper() + sentence[1:] + ending


def _read_by(name: str, option: Option, hint: Any) -> Option:
    """An option that is read as its annotation or its form says."""
    kind, *more = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    entry = FIELDS.get(f"impact.{name}")
    if more or kind is str or (str in get_args(kind) and get_origin(kind) is not list):
        return replace(option, read=more[0] if more else None)
    if option.read is None and entry is not None and option.metavar in ("RANGE", "LO:HI"):
        return replace(option, read=partial(texts.entry_range if option.metavar == "RANGE" else texts.span, entry))
    return replace(option, read=option.read or _FORMS.get(option.metavar))


def passed(**arguments: Any) -> dict[str, Any]:
    """The arguments that are present; the function that is called with them has its defaults for the others."""
    return {name: value for name, value in arguments.items() if value is not None}
