"""The seal: what was sealed opens, anything changed since is refused."""

import json

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.proof.seal import opened, seal


@pytest.fixture
def sealed(tmp_path):
    (tmp_path / "holdout.mcap").write_bytes(b"unseen")
    seal(tmp_path, {"verdict": "consistent"})
    return tmp_path


def test_what_was_sealed_opens(sealed):
    assert opened(sealed)["verdict"] == "consistent"


def test_the_seal_does_not_tell_the_truth(sealed, tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    (other / "holdout.mcap").write_bytes(b"unseen")
    seal(other, {"verdict": "consistent"})
    first, second = (json.loads((folder / "seal.json").read_text()) for folder in (sealed, other))
    assert "consistent" not in (sealed / "seal.json").read_text()
    assert first["truth.json"] != second["truth.json"]


@pytest.mark.parametrize("name", ["truth.json", "holdout.mcap"])
def test_a_change_after_sealing_is_refused(sealed, name):
    (sealed / name).write_bytes((sealed / name).read_bytes() + b" ")
    with pytest.raises(InputError, match=f"{name} is not what was sealed"):
        opened(sealed)
