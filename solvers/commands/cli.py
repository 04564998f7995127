"""The command line `wetdoublet`: imports commands by name and reports every failure as one line and an exit status."""

import errno
import io
import logging
import os
import sys
import traceback
import warnings
from collections.abc import Callable, Sequence
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Any

import click

from ..errors import InputError, ModelWarning, WetDoubletError, cut, did_you_mean, one_line
from ..host.interrupts import INTERRUPTED, handled
from .bar import AtWork

COMMANDS = {
    "scenes": "scenes", "collide": "collisions", "sensitivity": "collisions", "map": "outcomes", "boundary": "outcomes",
    "critical": "outcomes", "solve": "collisions", "averages": "collisions", "reproduce": "checks",
    "generate": "scenes", "diff": "scenes", "export": "scenes", "explore": "scenes", "verify": "checks",
    "bench": "checks", "prove": "collisions", "tracks": "data", "check": "data", "fit": "data", "flow-curve": "data",
    "design": "data", "compile": "scenes", "cite": "scenes",
}  # fmt: skip
"""The file in `commands/` that has each command; it is imported when the command is called."""

_SAME = {"--out": ("-o",), "--output": ("-o", "--out"), "-o": ("--out",), "-p": ("--plot",), "-v": ("--version",)}
"""An option that some commands do not have -> the options that they may have instead."""

_LONGEST = 200  # most characters of the user's input repeated in a message
BROKEN_PIPE = 141  # as a shell reports SIGINT: 128 + 2


class Commands(click.Group):
    """A click group that imports a command when it is called, and reports failures in one line."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the command names in the order of the documentation."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import and return the command."""
        if cmd_name not in COMMANDS:
            return None
        from .signature import built

        import_module(f".{COMMANDS[cmd_name]}", __package__)
        return built(cmd_name)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the command named by the first of `args`; InputError with the nearest name if unknown."""
        if args[0] not in COMMANDS and not args[0].startswith("-"):
            hint = did_you_mean(args[0], COMMANDS)
            raise InputError("COMMAND", args[0], ", ".join(COMMANDS), "is not known" + hint)
        for k, (option, value) in enumerate(pairwise(args), 1):
            if option == "--stress" and value[:1] == "-" and value[1:2].isdigit():  # click would read it as an option
                args[k] = f" {value}"
        name, command, rest = super().resolve_command(ctx, args)
        if command is not None and not ctx.resilient_parsing:  # as a shell does that completes a line
            _check_once(click.Context(command, parent=ctx, info_name=name), rest)
        return name, command, rest

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; an interrupt and a closed pipe set the exit status and print no error."""
        try:
            with handled() as signals, AtWork():
                super().invoke(ctx)
            sys.stdout.flush()
        except KeyboardInterrupt as interrupt:
            click.echo(str(interrupt) or ("terminated" if signals.terminated else "interrupted"), err=True)
            ctx.exit(signals.status)
        except BrokenPipeError:
            # the pipe is closed; the interpreter's flush at exit would fail as well
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            ctx.exit(BROKEN_PIPE)

    def main(  # type: ignore[override]  # click's overloads say what standalone_mode returns; this one never returns
        self, args: Sequence[str] | None = None, prog_name: str | None = None, **extra: Any
    ) -> None:
        """Run the command and exit with its status."""
        _settle_streams()
        arguments = list(sys.argv[1:] if args is None else args)
        extra["standalone_mode"] = False
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("always", ModelWarning)
                warnings.showwarning = _remarks()
                status = super().main(arguments, prog_name or "wetdoublet", **extra)
        except WetDoubletError as error:
            status = _report(str(error), error.exit_status, error, arguments)
        except click.UsageError as error:
            status = _report(_usage(error), 2, error, arguments)
        except OSError as error:
            line = f"{error.filename or 'output'}: {error.strerror or error}; accepted: a file that can be written"
            status = _report(" ".join(line.split()), 1, error, arguments)
        except click.Abort as error:
            status = _report("interrupted", INTERRUPTED, error, arguments)
        except Exception as error:  # noqa: BLE001 # a defect of ours is still one line; --debug shows the rest
            line = " ".join(f"internal error: {type(error).__name__}: {error}".split())
            status = _report(f"{line} (--debug shows where; please report it)", 1, error, arguments)
        sys.exit(status or 0)


def _check_once(ctx: click.Context, args: list[str]) -> None:
    """Refuse an option that takes one value and is given several, of which click keeps the last."""
    try:
        values, _, order = ctx.command.make_parser(ctx).parse_args(list(args))
    except click.UsageError as error:
        error.ctx = ctx  # of which click does not always say
        raise
    for option in order:
        if isinstance(option, click.Option) and not (option.multiple or option.is_flag) and order.count(option) > 1:
            flag = option.opts[0]
            raise InputError(flag, str(values[str(option.name)]), f"{flag} once", "is given twice or more")


class _Closed(io.TextIOBase):
    """A standard output that the caller has closed (>&-): to write there is an error, as to a full disk."""

    def write(self, text: str) -> int:
        if text:
            raise OSError(errno.EBADF, "is closed", "standard output")
        return 0


def _settle_streams() -> None:
    """Replace closed standard streams, and silence matplotlib's warnings on standard error."""
    if sys.stdout is None:
        os.open(os.devnull, os.O_WRONLY)  # takes the free number, so that no file that is opened gets it
        sys.stdout = _Closed()
    if sys.stderr is None:
        sys.stderr = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 # open to the end
    # matplotlib warns of a read-only home, though it then uses a temporary folder, and of slow fonts
    logging.getLogger("matplotlib").setLevel(logging.ERROR)


def _remarks() -> Callable[..., None]:
    """A `warnings.showwarning` that writes each distinct warning once per command, as one line on standard error."""
    lines: set[str] = set()

    def remark(message: Warning | str, category: type[Warning], *_: Any) -> None:
        problem = "warning" if category is ModelWarning else category.__name__
        line = f"{problem}: {one_line(str(message))}"
        if line not in lines:
            lines.add(line)
            click.echo(line, err=True)

    return remark


def _report(line: str, status: int, error: BaseException, arguments: list[str]) -> int:
    if "--debug" in arguments:
        traceback.print_exception(error)
    click.echo(line, err=True)
    return status


def _usage(error: click.UsageError) -> str:
    """Return click's usage error as our one line: the option, the nearest known one, and what is accepted."""
    ctx = error.ctx
    options = [name for param in ctx.command.get_params(ctx) for name in param.opts if name[0] == "-"] if ctx else []
    if isinstance(error, click.NoSuchOption):
        instead = next((name for name in _SAME.get(error.option_name, ()) if name in options), None)
        hint = f", did you mean {instead}?" if instead else did_you_mean(error.option_name, options)
        return f"{cut(error.option_name, _LONGEST)}: no such option{hint}; accepted: {', '.join(options)}"
    problem = cut(" ".join(error.format_message().split()).removesuffix("."), _LONGEST)
    if isinstance(error, click.BadOptionUsage):
        return _misused(error.option_name, ctx)
    if ctx and isinstance(ctx.command, click.Group):
        problem = "missing" if problem == "Missing command" else problem
        return f"COMMAND: {problem}; accepted: {', '.join(COMMANDS)}"
    usage = " ".join(ctx.get_usage().split()).removeprefix("Usage: ") if ctx else "see --help"
    return f"{ctx.info_name if ctx else 'wetdoublet'}: {problem}; accepted: {usage}"


def _misused(name: str, ctx: click.Context | None) -> str:
    """Return the message for an option that lacks its value or has one that it does not take."""
    params = ctx.command.get_params(ctx) if ctx else []
    option = next((param for param in params if name in param.opts and isinstance(param, click.Option)), None)
    if option is not None and option.is_flag:
        return f"{name}: is given a value; accepted: {name} alone"
    return f"{name}: its value is missing; accepted: {name} {(option and option.metavar) or 'VALUE'}"


@click.command(cls=Commands, no_args_is_help=False, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="wetdoublet", prog_name="wetdoublet", message="%(prog)s %(version)s")
def cli() -> None:
    """Oblique collisions of two wet particles.

    A SCENE is a TOML file or a preset's name (see `wetdoublet scenes`).
    """


def main(args: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its status."""
    cli.main(args)
