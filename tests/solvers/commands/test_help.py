"""Help of commands: their docstrings, with meanings and defaults of the public functions; what a shell completes."""

import inspect
import re

import pytest
from click.testing import CliRunner
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


@pytest.mark.parametrize(
    ("line", "completed"),
    [("col", {"collide"}), ("collide --sto", {"--stokes"}), ("collide gran", {"granulation", "granulation-dry-bridge"}),
     ("collide granulation --engine ro", {"rosenbrock"}), ("collide granulation --plot ro", {"ro"}),
     ("export granulation --to ca", {"casadi"}), ("reproduce fig4", {"fig4a", "fig4b"}),
     ("collide granulation --set liquid.vis", {"liquid.viscosity="}),
     ("sensitivity granulation --wrt impact.angle,liquid.vis", {"impact.angle,liquid.viscosity"})],
)  # fmt: skip
def test_a_shell_completes(line, completed):
    """Commands, options, presets, choices and names of entries, by what click writes for bash; the rest is files."""
    words = f"wetdoublet {line}"
    env = {"_WETDOUBLET_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    done = CliRunner().invoke(cli, [], env=env, prog_name="wetdoublet")
    assert (done.exit_code, done.stderr) == (0, "")
    assert completed <= {entry.partition(",")[2] for entry in done.stdout.split()}
