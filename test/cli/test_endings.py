"""However a run ends, its results are whole or not there, and nothing else stays. Real processes throughout."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.library.output import output_folder, published

COMMAND = """
import os, signal, sys, time
from pathlib import Path
from types import SimpleNamespace
from pierburg_ros.cli import app
from pierburg_ros.library import output

signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts what runs in the background without

def tune() -> None:
    with output.output_folder(Path(sys.argv[1])) as folder:
        for name in ("a", "b"):
            (folder / name).write_bytes(b"x" * int(sys.argv[3]))
        print("ready", flush=True)
        if sys.argv[2] == "killed while publishing":
            moved = os.replace
            os.replace = lambda *paths: (moved(*paths), os.kill(os.getpid(), 9))
        elif sys.argv[2] == "waits":
            time.sleep(600)
        elif sys.argv[2] == "swallows":
            try:
                time.sleep(600)
            except BaseException:
                pass
            time.sleep(600)
        elif sys.argv[2] == "fails of its own":
            try:
                time.sleep(600)
            except BaseException:
                raise RuntimeError("no compiled object yet") from None

app.import_module = lambda name: SimpleNamespace(tune=tune)
app.main(["tune"])
"""
PATIENCE = 120.0


def start(output: Path, how: str = "ends", size: int = 1) -> subprocess.Popen:
    """A run into `output`."""
    command = [sys.executable, "-c", COMMAND, str(output), how, str(size)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def waiting(output: Path, how: str = "waits") -> subprocess.Popen:
    """A run into `output` that has half of its results and goes on."""
    process = start(output, how)
    assert process.stdout.readline() == "ready\n"
    return process


def ended(process: subprocess.Popen) -> tuple[int, str]:
    """Status and last words of a run."""
    _, words = process.communicate(timeout=PATIENCE)
    return process.returncode, words


def left(folder: Path) -> list[str]:
    """Everything in `folder`."""
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


@pytest.mark.parametrize(
    ("sent", "status", "said"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_a_signal_ends_a_run_with_one_line_and_nothing_left(tmp_path, sent, status, said):
    run = waiting(tmp_path / "deep" / "out")
    run.send_signal(sent)
    assert ended(run) == (status, f"pierburg: {said}.\n")
    assert left(tmp_path) == []


@pytest.mark.parametrize("how", ["swallows", "fails of its own"])
def test_a_signal_that_a_callback_swallowed_ends_the_run_all_the_same(tmp_path, how):
    run = waiting(tmp_path / "out", how)
    run.send_signal(signal.SIGINT)
    assert ended(run) == (130, "pierburg: interrupted.\n")
    assert left(tmp_path) == []


def test_what_a_killed_run_left_goes_with_the_next_run_beside_it(tmp_path):
    run = waiting(tmp_path / "out")
    run.kill()
    ended(run)
    assert not (tmp_path / "out").exists() and len(left(tmp_path)) > 1
    assert ended(start(tmp_path / "other")) == (0, "")
    assert left(tmp_path) == ["other", "other/a", "other/b"]


def test_a_run_killed_while_it_published_is_finished_by_the_next(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "a").write_text("old")
    assert ended(start(tmp_path / "out", "killed while publishing"))[0] == -signal.SIGKILL
    assert not (tmp_path / "out" / "b").exists()
    assert ended(start(tmp_path / "other")) == (0, "")
    assert left(tmp_path / "out") == ["a", "b"]
    assert left(tmp_path) == ["other", "other/a", "other/b", "out", "out/a", "out/b"]


def test_of_two_runs_into_one_folder_the_first_wins(tmp_path):
    first = waiting(tmp_path / "out")
    status, words = ended(start(tmp_path / "out"))
    assert status == 2 and "Another run writes into" in words and words.count("\n") == 1
    assert ended(start(tmp_path / "other"))[0] == 0
    first.terminate()
    ended(first)
    assert left(tmp_path) == ["other", "other/a", "other/b"]


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 256 KiB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(disk)]
    if os.geteuid() != 0 or subprocess.run(mount, capture_output=True, check=False).returncode != 0:
        pytest.skip("mounting a small file system needs rights that this user lacks")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


def test_a_full_disk_is_one_line_and_leaves_nothing(small_disk):
    status, words = ended(start(small_disk / "out", size=1 << 20))
    assert status == 2
    assert "No space left on device; nothing was written. Free some space" in words
    assert words.count("\n") == 1 and left(small_disk) == []


def test_a_disk_itself_takes_results_whole_and_from_one_run_alone(small_disk):
    first = waiting(small_disk)
    status, words = ended(start(small_disk))
    assert status == 2 and "Another run writes into" in words
    first.kill()
    ended(first)
    assert ended(start(small_disk)) == (0, "")
    assert left(small_disk) == ["a", "b"]


def test_a_run_into_a_disk_that_was_killed_while_it_published_is_finished_by_the_next(small_disk):
    assert ended(start(small_disk, "killed while publishing"))[0] == -signal.SIGKILL
    with output_folder(small_disk) as folder:
        assert published(folder / "c") == small_disk / "c"
        assert "b" in left(small_disk)
    assert left(small_disk) == ["a", "b"]


def test_a_folder_in_one_that_cannot_be_written_takes_results(tmp_path, monkeypatch):
    (tmp_path / "out").mkdir()
    monkeypatch.setattr("os.access", lambda path, mode: Path(path) != tmp_path)
    with output_folder(tmp_path / "out") as folder:
        (folder / "a").write_text("whole")
        assert os.listdir(tmp_path) == ["out"]
    assert left(tmp_path) == ["out", "out/a"]


def test_outputs_that_cannot_be_are_refused_before_the_work(tmp_path):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    for output, reason in (
        (Path("/"), "is the root of the file system"),
        (tmp_path / "file", "is a file, expected a folder"),
        (tmp_path / "file" / "below", "cannot be written"),
        (tmp_path / "loop", "is a link that leads nowhere"),
        (Path("/proc/x"), "/proc/x cannot be written, since /proc cannot. Choose another place."),
    ):
        with pytest.raises(InputError, match=reason), output_folder(output):
            raise AssertionError("the work began")
    assert left(tmp_path) == ["file", "loop"]


def test_a_name_with_markup_and_control_characters_is_a_name(tmp_path):
    output = tmp_path / "[red]x\x1b[2J"
    assert ended(start(output)) == (0, "")
    assert left(output) == ["a", "b"]


PARENT = """
import os, subprocess, sys, time
child = "from pierburg_ros.processes import end_with_parent; import signal, time; end_with_parent(%d, signal.SIGTERM)"
child = child % os.getpid() + "; print(1, flush=True); time.sleep(600)"
process = subprocess.Popen([sys.executable, "-c", child], start_new_session=True, stdout=subprocess.PIPE)
process.stdout.readline()
print(process.pid, flush=True)
time.sleep(600)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a process that its parent has ended")
def test_a_process_ends_with_a_parent_that_is_killed():
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    child = int(parent.stdout.readline())
    parent.kill()
    parent.communicate()
    deadline = time.monotonic() + PATIENCE
    while running(child) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not running(child)


def running(process: int) -> bool:
    """Whether a process runs; one that has ended and that nobody has asked about does not."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False
