"""Takes the README's picture of a report: python docs/images/report.py (needs chromium and chromedriver).

The report is that of docs/my_bag.md: the bag of examples/throttle_bag.py, diagnosed.
"""

import io
import runpy
import sys
import tempfile
from pathlib import Path

from PIL import Image

import pierburg_ros as pr

ROOT = Path(__file__).parents[2]
SIGNALS = {
    "duty": {"topic": "/throttle/pwm", "unit": "percent"},
    "hall_voltage": {"topic": "/throttle/adc", "unit": "counts", "scale": 5.0 / 4096},
}
WIDTH, COLOURS = 1200, 64


def take(report: Path, output: Path, folder: Path) -> None:
    """Write the picture of the head of a `report` to `output`; the browser's profile is in `folder`."""
    sys.path.insert(0, str(ROOT / "test"))
    from support.browser import browser

    with browser(folder, WIDTH) as page:
        page.open(report)
        (body,) = page.elements("body")
        picture = Image.open(io.BytesIO(page.picture(body))).convert("RGB")
        picture.quantize(COLOURS).save(output / "report.png", optimize=True)


def main() -> None:
    """Write the bag, diagnose it, take the picture."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        runpy.run_path(str(ROOT / "examples" / "throttle_bag.py"))["write"](folder / "throttle")
        actuator = ROOT / "examples" / "my_actuator.yaml"
        recording = pr.read(folder / "throttle", signals=SIGNALS)
        pr.diagnose(recording, actuator=actuator).save(folder / "results")
        take(folder / "results" / "report.html", Path(__file__).parent, folder)


if __name__ == "__main__":
    main()
