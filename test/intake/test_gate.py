"""What passes the gate and what does not: kinds of files, faults of libraries, faults of our own."""

import json
import os
import socket

import pytest

from pierburg_ros.errors import InputError, one_line
from pierburg_ros.intake import opened, reading, text_of
from pierburg_ros.plant.model_file import read_model
from pierburg_ros.recording import read_recording


def refusal(path, read=lambda path: text_of(path, "a model file")) -> str:
    with pytest.raises(InputError) as refused:
        read(path)
    line = str(refused.value)
    assert len(line) <= 290 and line.isprintable()
    return line


@pytest.mark.parametrize("read", [read_model, read_recording])
def test_a_pipe_is_refused_without_waiting_for_its_writer(tmp_path, read):
    path = tmp_path / "run.mcap"
    os.mkfifo(path)
    assert "is a pipe, expected" in refusal(path, read)


@pytest.mark.parametrize("read", [read_model, read_recording])
def test_a_device_without_end_is_refused(tmp_path, read):
    path = tmp_path / "run.csv"
    path.symlink_to("/dev/zero")
    assert "is a device, expected" in refusal(path, read)


def test_a_socket_and_a_folder_are_refused(tmp_path):
    with socket.socket(socket.AF_UNIX) as other:
        other.bind(str(tmp_path / "s"))
        assert "is a socket, expected" in refusal(tmp_path / "s")
    assert "is a folder, expected" in refusal(tmp_path)


@pytest.mark.parametrize("read", [read_model, read_recording])
def test_a_loop_of_links_is_refused(tmp_path, read):
    path = tmp_path / "run.mcap"
    path.symlink_to(path)
    assert "Too many levels of symbolic links" in refusal(path, read)


def test_a_name_with_a_zero_byte_and_one_too_long_are_refused(tmp_path):
    assert "null byte" in refusal(tmp_path / "a\0b", read_recording)
    assert "too long" in refusal(tmp_path / ("a" * 5000), read_recording)


def test_a_text_beyond_its_size_is_refused_before_it_is_taken(tmp_path):
    path = tmp_path / "model.yaml"
    with path.open("wb") as file:
        file.truncate(1 << 40)
    assert "has more than 1 MiB" in refusal(path)


def test_a_text_in_another_encoding_is_refused(tmp_path):
    path = tmp_path / "model.yaml"
    path.write_bytes("ä".encode("latin-1"))
    assert "is not text in UTF-8 (byte 0)" in refusal(path)


def test_what_a_library_raises_becomes_one_line():
    said = r"run cannot be read as a recording \(JSONDecodeError: "
    with pytest.raises(InputError, match=said), reading("run", "a recording"):
        json.loads("{")
    with pytest.raises(InputError, match="run needs more memory than there is"), reading("run", "a recording"):
        raise MemoryError


def test_a_fault_of_a_test_is_not_taken_for_one_of_the_package():
    with pytest.raises(InputError, match="TypeError"), reading("run", "a recording"):
        raise TypeError("from a library")


def test_a_mistake_of_the_package_is_not_hidden(monkeypatch, tmp_path):
    monkeypatch.setattr("pierburg_ros.recording.read.tabulated", None)
    (tmp_path / "run.csv").write_text("time,duty,position\n0,0,0\n1,0,0\n")
    with pytest.raises(TypeError):
        read_recording(tmp_path / "run.csv")


def test_a_message_is_one_literal_line_with_its_end_kept():
    assert one_line("a\n b\t\x1b[2Jc\u202e") == r"a b \x1b[2Jc\u202e"
    long = one_line("found " + "x" * 1000 + ", expected less. Do this.")
    assert len(long) <= 285 and long.startswith("found xxx") and long.endswith(", expected less. Do this.")


def test_a_file_that_is_open_is_read(tmp_path):
    (tmp_path / "a").write_bytes(b"abc")
    with opened(tmp_path / "a", "a file") as file:
        assert file.read() == b"abc"
