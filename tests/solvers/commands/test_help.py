"""Help of commands: their docstrings, with meanings and defaults of the public functions."""

import inspect
import re

import pytest
from wetdoublet.solvers import collision_averages, design, tracks
from wetdoublet.solvers.commands.cli import COMMANDS, cli

from ...helpers.command import run

PUBLIC = [
    ("design", design, ("n", "target", "data", "restitution_sd")),
    ("averages", collision_averages, ("films", "tolerance", "wrt")),
    ("tracks", tracks, ("rate", "noise", "particles")),
]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_explained(name):
    """Each option of each command has a sentence of its own, and the examples are of this command."""
    command = cli.get_command(None, name)
    for option in command.params:
        if option.param_type_name == "option":
            assert re.fullmatch(r"\S.*[.\]]", option.help), option.opts
    shown = run(name, "--help").stdout
    examples = re.findall(r"^    wetdoublet (\S+)", shown, re.MULTILINE)
    assert name in examples or not examples
    assert " ".join(command.short_help.split()) in " ".join(shown.split())


@pytest.mark.parametrize(("name", "function", "parameters"), PUBLIC)
def test_help_of_a_public_function(name, function, parameters):
    """What a function says of a parameter, and its default, is what the command says of the option."""
    options = {option.name: option for option in cli.get_command(None, name).params}
    described = " ".join(inspect.getdoc(function).split())
    for parameter in parameters:
        text, _, default = options[parameter].help.partition(" [")
        assert text[0].lower() + text[1:].rstrip(".") in described
        if default:
            assert default == f"{inspect.signature(function).parameters[parameter].default}]."
