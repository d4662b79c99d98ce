"""`.ci/run`: a browser is installed where that is possible; what cannot be installed keeps no check from running."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BROWSER = "from support import browser; print(browser.WANTED)"


def program(folder, name, text):
    """A program of a `name` on the path of a `folder`."""
    (folder / name).write_text(f"#!/bin/sh\n{text}\n")
    (folder / name).chmod(0o755)


@pytest.mark.parametrize(("installs", "said"), [("exit 0", ""), ("exit 1", "are skipped")])
def test_a_browser_is_installed_where_it_may_and_never_in_the_way(tmp_path, installs, said):
    for name in ("bash", "dirname", "env"):
        (tmp_path / name).symlink_to(f"/usr/bin/{name}")
    program(tmp_path, "id", "echo 0")
    program(tmp_path, "apt-get", f"echo apt-get $@ >> {tmp_path}/asked; {installs}")
    program(tmp_path, "make", f"echo make $@ CI=$CI >> {tmp_path}/asked")
    done = subprocess.run(
        [tmp_path / "bash", ROOT / ".ci" / "run"], env={"PATH": str(tmp_path)}, capture_output=True, text=True
    )
    asked = (tmp_path / "asked").read_text().splitlines()
    assert done.returncode == 0 and said in done.stdout and asked[-1] == "make test CI=true"
    assert asked[0] == "apt-get update"
    assert (asked[1] == "apt-get install --yes chromium chromium-driver") == (said == "")


@pytest.mark.parametrize(
    ("found", "wanted"),
    [((), "False"), (("chromium",), "True"), (("chromedriver",), "False"), (("chromium", "chromedriver"), "True")],
)
def test_a_browser_without_its_driver_is_a_failure_where_all_checks_run(tmp_path, found, wanted):
    for name in found:
        program(tmp_path, name, "exit 1")
    environment = {"PATH": str(tmp_path), "CI": "true", "PYTHONPATH": str(ROOT / "test")}
    done = subprocess.run([sys.executable, "-c", BROWSER], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == wanted
