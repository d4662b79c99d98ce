"""A headless Chromium driven through chromedriver's WebDriver protocol (https://www.w3.org/TR/webdriver2/)."""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

CHROMIUM, DRIVER = shutil.which("chromium") or shutil.which("google-chrome"), shutil.which("chromedriver")
WANTED = bool(CHROMIUM and (DRIVER or os.environ.get("CI") == "true"))
"""Whether to test in a browser: where there is one with its driver. Where all checks run, a missing driver fails."""
NEEDS_BROWSER = pytest.mark.skipif(not WANTED, reason="needs chromium and chromedriver on the path")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
)
PATIENCE = 120.0
"""Seconds until a page must have drawn its plots, on a machine under load."""
JSON = {"Content-Type": "application/json"}


class Page:
    """A page in a browser."""

    def __init__(self, address: str) -> None:
        self.address = address

    def ask(self, method: str, path: str, **content: Any) -> Any:
        """The answer to a command of the protocol."""
        data = json.dumps(content).encode() if method == "POST" else None
        request = urllib.request.Request(f"{self.address}/{path}", data, JSON, method=method)
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            return json.load(answer)["value"]

    def run(self, script: str, *arguments: Any) -> Any:
        """What a `script` returns."""
        return self.ask("POST", "execute/sync", script=script, args=list(arguments))

    def open(self, path: Path) -> None:
        """Show a file and wait until its plots are drawn."""
        self.ask("POST", "url", url=path.resolve().as_uri())
        self.wait("return document.documentElement.dataset.drawn !== undefined")

    def wait(self, condition: str) -> None:
        """Wait until a script returns true."""
        end = time.monotonic() + PATIENCE
        while not self.run(condition):
            assert time.monotonic() < end, f"{condition}: {self.errors()}"
            time.sleep(0.1)

    def errors(self) -> list[str]:
        """What the console has said since it was asked last."""
        return [entry["message"] for entry in self.ask("POST", "se/log", type="browser")]

    def elements(self, selector: str) -> list[str]:
        """The elements of a selector, for `picture`."""
        found = self.ask("POST", "elements", using="css selector", value=selector)
        return [next(iter(element.values())) for element in found]

    def picture(self, element: str) -> bytes:
        """An element as PNG."""
        return base64.b64decode(self.ask("GET", f"element/{element}/screenshot"))

    def printed(self) -> bytes:
        """The page as PDF."""
        return base64.b64decode(self.ask("POST", "print", background=True))


@contextmanager
def browser(folder: Path, width: int) -> Iterator[Page]:
    """A browser with a window of a `width` [px], as narrow as a phone's if asked; its profile is in `folder`."""
    assert CHROMIUM and DRIVER, "found chromium and no chromedriver, expected both: install chromium-driver"
    log = (folder / "driver.log").open("w+")
    driver = subprocess.Popen([DRIVER, "--port=0"], stdout=log, stderr=log)
    page = None
    try:
        root = f"http://127.0.0.1:{_port(folder / 'driver.log', driver)}/session"
        options = {
            "binary": CHROMIUM,
            "args": [*FLAGS, f"--user-data-dir={folder / 'profile'}"],
            "mobileEmulation": {"deviceMetrics": {"width": width, "height": 1000, "pixelRatio": 1.0, "touch": False}},
        }
        wanted = {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        session = Page(root.removesuffix("/session")).ask(
            "POST", "session", capabilities={"alwaysMatch": {"browserName": "chrome", **wanted}}
        )
        page = Page(f"{root}/{session['sessionId']}")
        yield page
    finally:
        if page is not None:
            with suppress(OSError):
                urllib.request.urlopen(urllib.request.Request(page.address, method="DELETE"), timeout=PATIENCE).close()
        driver.terminate()
        driver.wait()
        log.close()


def _port(log: Path, driver: subprocess.Popen[bytes]) -> int:
    """The port that the driver says it has taken."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and driver.poll() is None:
        said = log.read_text()
        if "started successfully on port" in said:
            return int(said.split("started successfully on port")[1].split(".")[0])
        time.sleep(0.05)
    raise AssertionError(f"chromedriver did not start: {log.read_text()}")
