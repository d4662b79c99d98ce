"""What the tests of the search share: a pool, a short recording, a search that has fitted nothing."""

from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor

import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.estimation.data import Data


@pytest.fixture(scope="session")
def pool() -> Iterator[Executor]:
    with ThreadPoolExecutor(2) as threads:
        yield threads


@pytest.fixture(scope="session")
def short() -> Data:
    return data_on(recording({}, duration=5.0))


@pytest.fixture
def empty(short: Data, pool: Executor) -> Search:
    """A search that has fitted nothing yet."""
    return Search(short, NOMINAL, pool)
