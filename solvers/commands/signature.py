"""Commands made of functions: options read off a signature and its docstring, and checked before any file is read."""

import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import click

from ..errors import InputError
from .texts import names, whole

_LINE = re.compile(r"(?P<flag>\S+)(?: (?P<metavar>[^(\s]\S*))??(?: \((?P<name>\w+)\))?:(?: (?P<help>.*))?", re.DOTALL)


@dataclass(frozen=True)
class Option:
    """One option of a command.

    Arguments:
        flag: as it is typed; an argument of the command if it does not begin with a dash.
        metavar: what stands for its value in the help; "" for an option without value.
        help: its line in the help.
        read: the value of the text; an InputError of it without a field is about the option.
        settings: further arguments of `click.Option` or `click.Argument`.
    """

    flag: str
    metavar: str = ""
    help: str = ""
    read: Callable[[Any], Any] = lambda text: text
    settings: Mapping[str, Any] = field(default_factory=dict)

    def parameter(self, name: str) -> click.Parameter:
        """The parameter of click."""
        if self.flag[0] != "-":  # not required by click, so that a wrong option is reported before a missing argument
            return click.Argument([name], metavar=self.flag, **{"required": False, **self.settings})
        form: dict[str, Any] = {"metavar": self.metavar} if self.metavar else {"is_flag": True}
        return click.Option([self.flag, name], help=self.help, **form, **self.settings)


@dataclass(frozen=True)
class Group:
    """Several options that are read together as one parameter.

    Arguments:
        read: the value of the texts, which are its keyword arguments.
        options: the options by keyword.
    """

    read: Callable[..., Any]
    options: Mapping[str, Option]


def options_of(text: str) -> dict[str, Option]:
    """The options that an indented text describes, by parameter: lines `--flag VALUE (name): help`."""
    options = {}
    for line in re.split(r"\n    (?=\S)", "\n" + text.rstrip())[1:]:
        parts = _LINE.fullmatch(" ".join(line.split()))
        assert parts is not None, line
        name = parts["name"] or parts["flag"].lstrip("-").replace("-", "_")
        options[name] = Option(parts["flag"], parts["metavar"] or "", parts["help"] or "")
    return options


def as_command(
    short_help: str, kind: type[click.Command] = click.Command, **settings: Mapping[str, Any]
) -> Callable[[Callable[..., None]], click.Command]:
    """Make a function the command of its module's name; its signature and docstring say which options there are.

    A parameter is annotated with a type, with a type and what reads it from a text, or with one of the options below.
    Its flag, what stands for its value and its help are a line `--flag VALUE: help` of the docstring's last section,
    `--flag VALUE (name): help` where the parameter has another name. Tuples and dictionaries are repeatable. Values are
    read in the order of the parameters; one that is absent is None. An InputError about a parameter, of whatever
    function, is reported under its option.

    Arguments:
        settings: of click's options, by parameter.
    """

    def decorated(function: Callable[..., None]) -> click.Command:
        text, _, lines = inspect.cleandoc(function.__doc__ or "").partition("\n\nOptions:\n")
        documented = options_of(lines)
        read_by: dict[str, Option | Group] = {}
        for name, hint in get_type_hints(function, include_extras=True).items():
            if name != "return":
                read_by[name] = _read_as(hint, documented.get(name), settings.get(name, {}))
        flags = {name: each.flag for name, each in read_by.items() if isinstance(each, Option) and each.flag[0] == "-"}

        def run(**texts: Any) -> None:
            values: dict[str, Any] = {}
            name = ""
            try:
                for name, option in read_by.items():
                    if isinstance(option, Group):
                        values[name] = option.read(**{key: texts[key] for key in option.options})
                    else:
                        values[name] = None if texts[name] is None else option.read(texts[name])
                function(**values)
            except InputError as error:
                argument, _, rest = error.field.partition(" ")
                flag = flags.get(argument or name)
                if flag is None:
                    raise
                raise InputError(f"{flag} {rest}".strip(), error.value, error.accepted, error.problem) from None

        parameters = [
            option.parameter(name)
            for key, each in read_by.items()
            for name, option in (each.options if isinstance(each, Group) else {key: each}).items()
        ]
        debug = click.Option(["--debug"], is_flag=True, expose_value=False, help="Show a traceback behind an error.")
        # a scene is the first argument, wherever its options stand
        parameters.sort(key=lambda each: isinstance(each, click.Argument) and each.name != "source")
        name = function.__module__.rpartition(".")[2].replace("_", "-")
        return kind(name, callback=run, params=[*parameters, debug], help=text, short_help=short_help)

    return decorated


def _read_as(hint: Any, line: Option | None, settings: Mapping[str, Any]) -> Option | Group:
    """The option of a parameter, by its annotation and its line of the docstring."""
    kind, *more = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    if more and isinstance(more[0], (Option, Group)):
        return more[0]
    assert line is not None, hint
    multiple = {"multiple": True} if get_origin(kind) in (tuple, dict) else {}
    read = more[0] if more else {list[str] | None: names, int | None: whole}.get(kind, lambda text: text)
    return replace(line, read=read, settings={**multiple, **settings})


def passed(**arguments: Any) -> dict[str, Any]:
    """The arguments that are present; the function that is called with them has its defaults for the others."""
    return {name: value for name, value in arguments.items() if value is not None}
