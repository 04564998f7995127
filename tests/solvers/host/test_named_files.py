"""Files that users name: bounded in size, depth and time, whatever they are; outputs are judged before all else."""

import os
import threading
from pathlib import Path

import pytest
from wetdoublet.solvers import InputError, Scene, collide
from wetdoublet.solvers.host.bounded import read

from ...helpers.command import run
from ...helpers.mutations import files, judged

TEXT = Scene.load("granulation").to_toml()
posix = pytest.mark.skipif(os.name != "posix", reason="pipes and devices of POSIX")


def refused(scene, says):
    """The command with a scene is bad input of one line, which says why."""
    done = run("scenes", scene)
    assert (done.exit_code, done.stdout) == (2, "")
    assert says in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert len(done.stderr) < 1000


@pytest.mark.parametrize("seed", range(3))
def test_spoilt_scene_files(tmp_path, seed):
    """A hundred scene files spoilt at random: each is a scene, which survives TOML, or an InputError of one line."""
    found = [judged(content, tmp_path / "scene.toml") for content in files(100, seed)]
    assert len(found) == 100 and any(found) and not all(found)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a" + ".a" * 1000 + " = 1", "is nested too deeply"),
        ("x = " + "[" * 1000 + "]" * 1000, "is nested too deeply"),
        ('x = {a = """a"""", ' + "a." * 1000 + "a = 1}", "is nested too deeply"),
        ("# " + "x" * 200_000, "is larger than 200000 bytes"),
        ("a" * 10_000 + " = 1", "has an unknown name"),
        ("name = 1" + "0" * 5000, "is broken TOML"),
        ("name = 0x" + "f" * 5000 + "\n" + TEXT.partition("\n")[2], "an integer of 20000 bits is not text"),
        ('name = "a\\u0000b"\n' + TEXT.partition("\n")[2], "is no name"),
        ('name = "' + "a" * 2000 + '"\n' + TEXT.partition("\n")[2], "is no name"),
        (TEXT.replace("2 Pa s", "2 " + "f" * 150 + "!"), "has the unknown unit"),
        (TEXT.replace("2 Pa s", "2 " + "(" * 150), "has the unknown unit"),
        ("\0", "is broken TOML"),
        ("[particles]\ndiameter = 2 mm  # of a sphere", 'accepted: text in quotes, diameter = "2 mm"'),
        ("[particles]\ndry_restitution = 0,8", "accepted: dry_restitution = 0.8, with a point"),
    ],
)
def test_scene_files_that_are_too_much(tmp_path, text, says):
    """What is too deep, too long, too large or not text is refused by the name of the file or entry."""
    file = tmp_path / "scene.toml"
    file.write_text(text)
    refused(file, says)
    if "bytes" not in says:
        with pytest.raises(InputError):
            Scene.from_toml(text)


def test_depth_is_counted_outside_of_text(tmp_path):
    """Dots and brackets in comments, strings and numbers are none of the structure; a byte order mark is no fault."""
    file = tmp_path / "scene.toml"
    more = "# " + "a.b." * 99 + "[" * 99 + "\nname = '''" + "a.b." * 99 + "[\n" * 99 + "'''\n"
    file.write_bytes(b"\xef\xbb\xbf" + (more + TEXT.partition("\n")[2]).encode())
    assert Scene.load(file) == Scene.load("granulation").with_entries({"name": "a.b." * 99 + "[\n" * 99})


@posix
def test_names_that_are_no_files(tmp_path):
    """A folder, a device without an end, links to nothing and to themselves, and names that no system takes."""
    (tmp_path / "broken").symlink_to(tmp_path / "nowhere")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    for name, says in (
        (tmp_path, "Is a directory"),
        ("/dev/zero", "is larger than"),
        (tmp_path / "broken", "is neither a file nor a preset"),
        (tmp_path / "loop", "cannot be read"),
        ("a" * 5000, "cannot be read"),
        ("a\0b", "null byte"),
    ):
        refused(name, says)


def test_a_scene_file_named_without_its_ending(tmp_path, monkeypatch):
    """The file of that name is pointed to."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(TEXT)
    refused("mine", "is neither a file nor a preset, did you mean mine.toml?")


@posix
def test_pipes(tmp_path):
    """One of the shell is read to its end however slowly it comes, up to a size; a named one is not waited for."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    refused(pipe, "is a named pipe")
    reader, writer = os.pipe()
    goes_on = threading.Event()

    def slowly():
        for line in TEXT.splitlines(keepends=True):
            os.write(writer, line.encode())
            goes_on.wait(0.001)
        os.close(writer)

    thread = threading.Thread(target=slowly)
    thread.start()
    assert read(f"/dev/fd/{reader}", 10_000, "scene", "a file") == TEXT.encode()
    thread.join()
    os.close(reader)
    with pytest.raises(InputError, match=r'^scene: "/dev/zero" is larger than 10 bytes; accepted: a file$'):
        read("/dev/zero", 10, "scene", "a file")


@posix
@pytest.mark.parametrize("name", ["pipe", "/dev/zero", "link.py", "nowhere.py", "a" * 300 + ".py", "a\0.py", "junk"])
def test_models_that_are_none(tmp_path, monkeypatch, name):
    """A pipe, a device, a link to one, and a folder with a manifest that is no manifest are no models."""
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    Path("link.py").symlink_to("/dev/zero")
    Path("junk").mkdir()
    for text in ("[" * 5000, "3", '{"kind": "wetdoublet model", "format": 1}', "\0", "x" * 2_000_000):
        Path("junk/manifest.json").write_text(text)
        done = run("collide", "granulation", "--model", name)
        assert (done.exit_code, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
        assert done.stderr.startswith("--model: ")
        if name != "junk":
            break


@posix
@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("no/such/x", "in a folder that does not exist"), ("/dev/null/x", "in a folder that does not exist"),
        ("folder", "is a folder"), ("dangling", "in a folder that does not exist"), ("a" * 300, "too long a name"),
        ("a" * 245, "too long a name"), ("/proc/x", "cannot be written"), ("", "is not a file name"),
        ("a\0b", "is not a file name"),
    ],
)  # fmt: skip
def test_outputs_that_cannot_be(tmp_path, monkeypatch, name, says):
    """They are bad input of every command that writes a file, before a scene is looked for."""
    monkeypatch.chdir(tmp_path)
    for suffix in (".nc", ".png", ""):
        Path("folder" + suffix).mkdir()
        Path("dangling" + suffix).symlink_to("no/such/file" + suffix)
    for command, option, suffix in (("map", "-o", ".nc"), ("collide", "--plot", ".png"), ("collide", "-o", "")):
        done = run(command, "nowhere.toml", option, name and name + suffix)
        assert (done.exit_code, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
        assert done.stderr.startswith(f"{option}: ")
        assert says in done.stderr or "unsupported suffix" in done.stderr


def test_a_picture_that_cannot_be(tmp_path):
    """From Python too it is bad input, and a collision without a trajectory says how to have one."""
    one = collide("granulation", stokes=0.1, angle=0.0)
    for name in (tmp_path / "no/such/x.png", "x.gif", "", 3, b"x.png", "a" * 300 + ".png"):
        with pytest.raises(InputError, match="^path: "):
            one.plot(name)
    with pytest.raises(InputError, match="^trajectory: "):
        one.plot(tmp_path / "x.png")
