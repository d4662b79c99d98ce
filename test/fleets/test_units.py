"""Which recordings a folder, a glob, a pattern or a table names, and whose they are."""

from datetime import datetime, timezone

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.fleets.recordings.pattern import instant, matcher
from pierburg_ros.fleets.recordings.place import at_hand, digest
from pierburg_ros.fleets.recordings.units import sources


def utc(*moment):
    return datetime(*moment, tzinfo=timezone.utc)


@pytest.fixture
def folder(tmp_path):
    """Two units with two recordings each, one of them a rosbag2 folder, and a file that is none."""
    for name in ("a/2026-01-05_x.mcap", "a/2026-02-05_x.mcap", "b/2026-01-06_x.mcap", "b/notes.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name)
    bag = tmp_path / "b" / "2026-03-06_bag"
    bag.mkdir()
    (bag / "metadata.yaml").write_text("version: 5")
    (bag / "bag_0.mcap").write_text("messages")
    return tmp_path


def test_the_unit_is_the_folder_and_a_bag_counts_once(folder):
    found = [(each.unit, each.path.rpartition("/")[2], each.time) for each in sources(str(folder))]
    assert found == [
        ("a", "2026-01-05_x.mcap", None),
        ("a", "2026-02-05_x.mcap", None),
        ("b", "2026-01-06_x.mcap", None),
        ("b", "2026-03-06_bag", None),
    ]


def test_a_pattern_says_unit_and_date(folder):
    found = sources(str(folder), "{unit}/{date}_*")
    assert [(each.unit, each.time) for each in found] == [
        ("a", utc(2026, 1, 5)),
        ("a", utc(2026, 2, 5)),
        ("b", utc(2026, 1, 6)),
        ("b", utc(2026, 3, 6)),
    ]
    assert len(sources(str(folder), "{unit}/{date}_*.mcap")) == 3


def test_a_glob_takes_what_it_matches(folder):
    assert len(sources(f"{folder}/*/*_x.mcap")) == 3
    assert [each.unit for each in sources(f"{folder}/*/2026-01*", "{unit}/{date}_*.mcap")] == ["a", "b"]


def test_paths_may_be_told_from_here(folder, monkeypatch):
    monkeypatch.chdir(folder.parent)
    assert len(sources(f"./{folder.name}/", "{unit}/{date}_*")) == 4
    monkeypatch.chdir(folder)
    assert [each.unit for each in sources("*/*_x.mcap")] == ["a", "a", "b"]
    assert len(sources(".", "{unit}/{date}_*")) == 4


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_a_table_says_all_three(folder, kind):
    file = folder / f"fleet.{kind}"
    if kind == "csv":
        rows = ["recording,unit,time", "a/2026-01-05_x.mcap,valve 7,2026-01-05T10:30:00+01:00", "/elsewhere.mcap,8,"]
        file.write_text("\n".join(rows))
    else:
        pyarrow = pytest.importorskip("pyarrow", reason="needs pyarrow")
        rows = [
            {"recording": "a/2026-01-05_x.mcap", "unit": "valve 7", "time": utc(2026, 1, 5, 9, 30)},
            {"recording": "/elsewhere.mcap", "unit": "8", "time": None},
        ]
        parquet = pytest.importorskip("pyarrow.parquet")
        parquet.write_table(pyarrow.Table.from_pylist(rows), file)
    other, own = sources(str(file))
    assert (own.path, own.unit, own.time) == (f"{folder}/a/2026-01-05_x.mcap", "valve 7", utc(2026, 1, 5, 9, 30))
    assert (other.path, other.unit, other.time) == ("/elsewhere.mcap", "8", None)


def test_recordings_in_memory_are_found_and_brought_to_hand():
    fsspec = pytest.importorskip("fsspec", reason="needs fsspec")
    system = fsspec.filesystem("memory")
    system.pipe({"/fleet/a/2026-01-05_x.mcap": b"one", "/fleet/b/2026-01-06_x.mcap": b"two"})
    system.pipe({"/fleet/b/bag/metadata.yaml": b"version: 5", "/fleet/b/bag/bag_0.mcap": b"three"})
    found = sources("memory://fleet")
    assert [(each.unit, each.path) for each in found] == [
        ("a", "memory:///fleet/a/2026-01-05_x.mcap"),
        ("b", "memory:///fleet/b/2026-01-06_x.mcap"),
        ("b", "memory:///fleet/b/bag"),
    ]
    with at_hand(found[0].path) as file:
        assert file.name == "2026-01-05_x.mcap" and file.read_bytes() == b"one"
    assert not file.exists()
    with at_hand(found[2].path) as bag:
        assert sorted(each.name for each in bag.iterdir()) == ["bag_0.mcap", "metadata.yaml"]
    with pytest.raises(InputError, match="does not exist"), at_hand("memory://fleet/none.mcap"):
        pass


def test_a_digest_is_of_the_content_and_not_of_the_place(folder, tmp_path):
    copy = tmp_path / "copy.mcap"
    copy.write_bytes((folder / "a/2026-01-05_x.mcap").read_bytes())
    assert digest(copy) == digest(folder / "a/2026-01-05_x.mcap") != digest(folder / "a/2026-02-05_x.mcap")
    before = digest(folder / "b/2026-03-06_bag")
    (folder / "b/2026-03-06_bag" / "bag_0.mcap").rename(folder / "b/2026-03-06_bag" / "bag_1.mcap")
    assert digest(folder / "b/2026-03-06_bag") != before


@pytest.mark.parametrize(
    ("text", "moment"),
    [
        ("2026-01-31", utc(2026, 1, 31)),
        ("20260131", utc(2026, 1, 31)),
        ("2026_01_31-12_30_05", utc(2026, 1, 31, 12, 30, 5)),
        ("20260131T123005", utc(2026, 1, 31, 12, 30, 5)),
        ("2026-01-31T12-30-05", utc(2026, 1, 31, 12, 30, 5)),
        ("2026-01-31T12:30:05+02:00", utc(2026, 1, 31, 10, 30, 5)),
    ],
)
def test_dates_are_read_as_they_are_written(text, moment):
    assert instant(text) == moment


@pytest.mark.parametrize(
    ("where", "pattern", "said"),
    [
        ("none", None, "is no folder"),
        ("a/notes.csv", None, "cannot be read"),
        ("", "{unit}/{when}.mcap", "found {when}"),
        ("", "{unit}/{unit}.mcap", "once"),
        ("", "*.mcap", "0 fields"),
        ("", "{unit}-{date}.mcap", "fits none of 4 recordings"),
        ("", "{unit}/2026-{date}.mcap", "found the date"),
    ],
)
def test_what_cannot_be_used_is_one_line(folder, where, pattern, said):
    with pytest.raises(InputError, match=said.replace("{", r"\{")):
        sources(f"{folder}/{where}", pattern)


def test_a_field_takes_no_slash():
    assert matcher("{unit}/{date}_*.mcap").fullmatch("a/b/2026_x.mcap") is None
    assert matcher("**/{unit}/{date}_*.mcap").fullmatch("a/b/2026_x.mcap")["unit"] == "b"
