"""Settings and fixtures that every test shares."""

from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from hypothesis import settings
from support.bags import Message, write_mcap

# The first call of a kernel compiles it, so a deadline would fail on that; the same draws every time.
settings.register_profile("project", deadline=None, derandomize=True)
settings.load_profile("project")


@pytest.fixture
def write_bag(tmp_path: Path) -> Callable[..., Path]:
    """Writes a list of messages to an MCAP file of a given name."""

    def write(messages: Iterable[Message], name: str = "run.mcap", chunk_size: int = 4096, **empty: str) -> Path:
        topics = {f"/{topic}": kind for topic, kind in empty.items()}
        return write_mcap(tmp_path / name, messages, chunk_size, topics)

    return write


@pytest.fixture
def message() -> type[Message]:
    """The message form that `write_bag` takes."""
    return Message


@pytest.fixture
def run() -> Callable[..., list[Message]]:
    """Samples at 100 Hz as a graph without stamps records them: Hall voltage k, then duty k / 1000."""

    def messages(count: int = 50, start: float = 1000.0, **topics: str) -> list[Message]:
        hall, duty = topics.get("hall", "/hall_voltage"), topics.get("duty", "/duty")
        found = []
        for k in range(count):
            time = start + 0.01 * k
            found.append(Message(hall, "float", time, time, k, float(k)))
            found.append(Message(duty, "float", time + 0.001, time + 0.001, k, k / 1000))
        return found

    return messages


@pytest.fixture
def bag_with_a_gap(write_bag: Callable[..., Path], run: Callable[..., list[Message]]) -> Path:
    """A second at 100 Hz in which the duties 30 to 39 never came."""
    return write_bag([m for m in run(100) if not (m.topic == "/duty" and 30 <= m.sequence < 40)])
