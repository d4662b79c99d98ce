"""Compiling: what it leaves of Numba and of the disk, when it tells, and which cache folders stay."""

import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from pierburg_ros.kernel_cache import KEPT, opened, source_digest

IMPORTS = """
import json, sys
import numba
from numba.core import event
def settings():
    config = {name: getattr(numba.config, name) for name in dir(numba.config) if name.isupper()}
    return repr((config, {kind: len(listening) for kind, listening in event._registered.items() if listening}))
before, touched = settings(), []
CHANGES = ("os.mkdir", "os.remove", "os.rename", "os.rmdir", "os.utime", "shutil.rmtree")
def audit(name, arguments):
    if name in CHANGES or (name == "open" and isinstance(arguments[1], str) and set(arguments[1]) & set("wax+")):
        touched.append([name, str(arguments[0])])
sys.addaudithook(audit)
import pierburg_ros.closed_loop, pierburg_ros.diagnosis.diagnose, pierburg_ros.identification.identify
print(json.dumps({"touched": touched, "unchanged": settings() == before}))
"""
COMPILES = """
import logging, sys
import numpy as np
logging.basicConfig(level=logging.INFO, format="%(message)s")
from pierburg_ros.kernel import kernel
@kernel
def doubled(x):
    return 2.0 * x
@kernel
def quadrupled(x):
    return 2.0 * doubled(x)
assert doubled(3.0) == 6.0 and quadrupled(3.0) == 12.0
"""
LOSES_ITS_FOLDER = """
import logging, os, shutil
from pathlib import Path
logging.basicConfig(level=logging.WARNING, format="%(message)s")
from pierburg_ros.kernel import kernel
@kernel
def doubled(x):
    return 2.0 * x
@kernel
def tripled(x):
    return 3.0 * x
cache = Path(os.environ["XDG_CACHE_HOME"])
assert doubled(3.0) == 6.0
shutil.rmtree(cache)
assert tripled(3.0) == 9.0
print([path.name.split("-")[0] for path in cache.rglob("*.nbc")])
folder = next(cache.rglob("*.nbc")).parent
shutil.rmtree(folder)
folder.write_text("no folder can be made here")
assert doubled(3) == tripled(2) == 6
"""


def ran(code, tmp_path):
    """What a fresh process prints, with a cache of its own."""
    script = tmp_path / "script.py"
    if not script.exists():  # older Numba takes a file written again for a changed one
        script.write_text(code)
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, script], env=environment, capture_output=True, text=True, check=True)


def test_declaring_kernels_changes_no_file_and_no_setting_of_numba(tmp_path):
    done = ran(IMPORTS, tmp_path)
    assert json.loads(done.stdout) == {"touched": [], "unchanged": True}
    assert not done.stderr and not (tmp_path / "cache").exists()


def test_compiling_is_announced_once_and_not_where_the_cache_has_it(tmp_path):
    assert ran(COMPILES, tmp_path).stderr.count("compiling the simulator") == 1
    assert not ran(COMPILES, tmp_path).stderr


def test_a_library_is_silent_unless_asked_to_log(tmp_path):
    level = "\nprint(logging.getLogger('pierburg_ros').level == logging.NOTSET)"
    done = ran(COMPILES.replace("logging.basicConfig", "dict") + level, tmp_path)
    assert done.stdout.split() == ["True"] and not done.stderr


def test_a_new_cache_folder_takes_the_place_of_the_oldest(tmp_path):
    for age in range(KEPT + 3):
        old = tmp_path / f"old-{age}"
        old.mkdir()
        os.utime(old, (1e9 - age, 1e9 - age))
    opened(tmp_path / "new")
    assert {path.name for path in tmp_path.iterdir()} == {"new", *(f"old-{age}" for age in range(KEPT))}


def test_folders_opened_within_a_day_all_stay(tmp_path):
    """As many versions as one likes run side by side."""
    day, now = 86_400.0, time.time()
    for number in range(3 * KEPT):
        (tmp_path / f"running-{number}").mkdir()
        os.utime(tmp_path / f"running-{number}", (now, now - 0.99 * day * number / (3 * KEPT)))
    opened(tmp_path / "new")
    assert len(list(tmp_path.iterdir())) == 3 * KEPT + 1


def test_processes_that_tidy_up_at_once_do_not_trip_over_one_another(tmp_path):
    for age in range(400):
        (tmp_path / f"old-{age}").mkdir()
        os.utime(tmp_path / f"old-{age}", (1e9 - age, 1e9 - age))
    new = [tmp_path / f"new-{number}" for number in range(16)]
    with ThreadPoolExecutor(len(new)) as pool:
        assert list(pool.map(opened, new)) == new
    assert all(folder.is_dir() for folder in new)
    assert len(list(tmp_path.glob("old-*"))) <= KEPT


def test_a_process_outlives_the_loss_of_its_folder(tmp_path):
    """Made again where it was removed; one line where that cannot be done; right results in any case."""
    done = ran(LOSES_ITS_FOLDER, tmp_path)
    assert done.stdout.splitlines() == ["['script.tripled']"]
    assert len(done.stderr.splitlines()) == 1
    assert "could not be kept" in done.stderr and "compiles it again" in done.stderr


def test_a_folder_in_use_counts_as_new(tmp_path):
    used = tmp_path / "used"
    used.mkdir()
    os.utime(used, (0, 0))
    opened(used)
    assert used.stat().st_mtime > 1e9


def test_the_digest_follows_kernels_and_nothing_else(tmp_path):
    physics, text = tmp_path / "physics.py", tmp_path / "text.py"
    physics.write_text("from pierburg_ros.kernel import kernel\n")
    text.write_text("A = 1\n")
    before = source_digest(tmp_path)
    text.write_text("A = 2\n")
    assert source_digest(tmp_path) == before
    physics.write_text("from pierburg_ros.kernel import kernel  # changed\n")
    assert source_digest(tmp_path) != before
