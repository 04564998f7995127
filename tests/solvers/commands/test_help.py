"""Help of commands: their docstrings, with defaults of the public functions; what a shell completes; ranges."""

import inspect
import math
import re

import pytest
from click.testing import CliRunner
from wetdoublet.solvers import collision_averages, design, tracks
from wetdoublet.solvers.commands.cli import COMMANDS, cli
from wetdoublet.solvers.commands.texts import entry_range
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.scene.schema import FIELDS

from ...helpers.command import run

PUBLIC = [
    ("design", design, ("n", "data", "restitution_sd")),
    ("averages", collision_averages, ("films", "tolerance")),
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


def test_ranges():
    """Both ends are included exactly; log is even in the logarithm; one value is a range too."""
    stokes = FIELDS["impact.stokes"]
    assert entry_range(stokes, "20:80:4") == [20, 40, 60, 80]
    assert entry_range(stokes, "log:0.01:100:5") == pytest.approx([0.01, 0.1, 1, 10, 100])
    assert entry_range(stokes, "log:0.1:0.7:3")[::2] == [0.1, 0.7]
    assert entry_range(stokes, "5:5:1") == entry_range(stokes, "5") == [5]


@pytest.mark.parametrize(
    "text", ["1:2", "1:2:0", "2:1:3", "1:2:1", "1:1:2", "1:2:x", "1:2:3.5", "1:2:-3", "log:0:1:3", "::", ""]
)
def test_bad_ranges(text):
    """A range that is none, runs backwards or has the wrong count names its option."""
    with pytest.raises(InputError, match=r"--stokes: .*; accepted: .*"):
        entry_range(FIELDS["impact.stokes"], text, "--stokes")


def test_angles_are_degrees_on_the_command_line():
    """A bare angle is in degrees, alone and in ranges; either end of a range may carry the unit of both."""
    one = [run("collide", "granulation", "--angle", angle, "--json").stdout for angle in ("75", "75 deg")]
    assert one[0] == one[1] != ""
    assert run("scenes", "granulation", "--set", "bridge.contact_angle=20").stdout.count('"20 deg"') == 1
    angle, speed = FIELDS["impact.angle"], FIELDS["impact.speed"]
    assert entry_range(angle, "20 deg:70 deg:26", "--angle") == entry_range(angle, "20:70:26", "--angle")
    assert entry_range(angle, "40", "--angle") == entry_range(angle, "40:40deg:1", "--angle") == [math.radians(40)]
    assert entry_range(angle, "0:1 rad:2", "--angle") == [0.0, 1.0]
    speeds = entry_range(speed, "0.1:5 m/s:20", "--speed")
    assert speeds == entry_range(speed, "0.1 m/s:5:20", "--speed") and speeds[-1] == 5.0
