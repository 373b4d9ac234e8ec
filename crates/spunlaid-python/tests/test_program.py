"""The program that comes with the package is the program of the repository."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pytest
from conftest import CASES

# Lines that say what a command takes or took.
COSTS = ("computed in", "expected: about", '"wall_s"', '"ns_per_element_step"')

COMMANDS = (
    "--version",
    "--help",
    "keys air.velocity",
    "keys --markdown",
    "completions bash",
    "check table1.toml",
    "run table1.toml --out {out} --replicates 3 --set run.duration=10ms --set run.spin_up=0s --json",
    "web web_known.toml --out {out} --set web.width=0.2m --set web.length=0.2m --set web.margin=0.1m",
    "spin spinline.toml --out {out}",
    "analyse records/probe.csv --out {out}",
    "run no_such_case.toml",
    "run table1.toml --set air.velocity=fast --out {out}",
    "fly table1.toml",
    "",
)


@pytest.fixture(scope="module")
def installed() -> Path:
    """The program `spunlaid` of this environment."""
    return Path(sysconfig.get_path("scripts")) / ("spunlaid.exe" if os.name == "nt" else "spunlaid")


def outcome(command: list[str | Path], folder: Path) -> tuple[int, str, str, dict[str, bytes]]:
    """What a command says, and what it leaves in its folder."""
    words = [str(word).format(out=folder / "out") for word in command]
    done = subprocess.run(words, capture_output=True, cwd=CASES)
    said = [stream.decode().replace(str(folder), "") for stream in (done.stdout, done.stderr)]
    lines = ["\n".join(line for line in text.splitlines() if not any(cost in line for cost in COSTS)) for text in said]
    tables = sorted((folder / "out").glob("*.parquet")) + sorted((folder / "out").glob("*.npy"))
    return done.returncode, *lines, {path.name: path.read_bytes() for path in tables}


@pytest.mark.parametrize("words", COMMANDS)
def test_identical_to_the_program_of_the_repository(words: str, program: Path, installed: Path, tmp_path: Path) -> None:
    found = [
        outcome([one, *words.split()], tmp_path / name) for one, name in ((program, "theirs"), (installed, "ours"))
    ]
    assert found[0] == found[1]
    assert found[0][1] or found[0][2], "it says something"


def test_the_module_is_the_program_too(installed: Path) -> None:
    said = [
        subprocess.run([*command, "--version"], capture_output=True, text=True, check=True).stdout
        for command in ([installed], [sys.executable, "-m", "spunlaid"])
    ]
    assert said[0] == said[1] and said[0].startswith("spunlaid ")


@pytest.mark.skipif(os.name == "nt", reason="there are no such signals")
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_a_stopped_run_leaves_nothing_and_says_so(sent: signal.Signals, installed: Path, tmp_path: Path) -> None:
    command = [installed, "run", CASES / "table1.toml", "--out", tmp_path / "r", "--set", "run.duration=1000s"]
    child = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    # Its hidden folder is there as soon as it can be stopped.
    while not list(tmp_path.glob(".*/new")):
        assert child.poll() is None
        time.sleep(0.01)
    time.sleep(0.2)
    child.send_signal(sent)
    _, said = child.communicate()
    assert child.returncode == 130 and "interrupted; nothing was written" in said, said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="there are no such signals")
def test_ctrl_c_ends_a_command_that_waits_for_an_answer(installed: Path) -> None:
    # Where this test runs in the background, Ctrl-C may be ignored; a command would ignore it too.
    child = subprocess.Popen(
        [installed, "check", "-"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    maps = Path(f"/proc/{child.pid}/maps")
    if not maps.exists():
        child.kill()
        pytest.skip("what the process has loaded cannot be seen here")
    while "_spunlaid" not in maps.read_text():
        assert child.poll() is None
        time.sleep(0.01)
    # From here on Python does not catch the signal any more.
    status = Path(f"/proc/{child.pid}/status")
    caught = re.compile(r"^SigCgt:\s*([0-9a-f]+)$", re.MULTILINE)
    while int(caught.findall(status.read_text())[0], 16) >> (signal.SIGINT - 1) & 1:
        assert child.poll() is None
        time.sleep(0.01)
    child.send_signal(signal.SIGINT)
    child.communicate()
    assert child.returncode == -signal.SIGINT


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are text there")
def test_names_that_are_no_text_are_taken(installed: Path, tmp_path: Path) -> None:
    name = os.fsencode(tmp_path) + b"/\xff.toml"
    Path(os.fsdecode(name)).write_bytes((CASES / "table1.toml").read_bytes())
    subprocess.run([installed, b"check", name], check=True, capture_output=True)


def test_a_reader_that_has_enough_is_no_error(installed: Path) -> None:
    for words in (["completions", "bash"], ["run", "--help"]):
        child = subprocess.Popen([installed, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert child.stdout is not None
        child.stdout.close()
        child.stdout = None
        _, said = child.communicate()
        assert (child.returncode, said) == (0, b"")
