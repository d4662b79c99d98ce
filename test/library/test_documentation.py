"""The page of the interface and the notebook, run as they stand."""

import json
import re
import shutil
from pathlib import Path

import pytest
from support.snippets import run

ROOT = Path(__file__).parents[2]
NOTEBOOK = ROOT / "examples" / "csv_to_model.ipynb"
pytestmark = pytest.mark.search


def snippets(page):
    """The pieces of Python on a page, in order."""
    return re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), flags=re.DOTALL)


def test_the_page_of_the_interface_runs_from_top_to_bottom(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {}
    for code in snippets("docs/library.md"):
        run(code, names)
    assert names["diagnosis"].verdict == "missing_physics" and names["diagnosis"].effects == ("sensor_lag",)
    assert names["corrected"].rmse < 1.1 * names["comparison"].noise < 0.5 * names["comparison"].rmse
    assert {path.name for path in (tmp_path / "diagnosis").iterdir()} >= {"diagnosis.json", "report.html"}
    assert capsys.readouterr().out  # what progress said


def test_the_notebook_leads_from_a_csv_to_a_corrected_model(tmp_path, monkeypatch):
    shutil.copy(ROOT / "examples" / "bench.csv", tmp_path)
    monkeypatch.chdir(tmp_path)
    names, shown = {}, []
    for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            shown.append(run("".join(cell["source"]), names))
    assert sum("<img" in value._repr_html_() for value in shown if hasattr(value, "_repr_html_")) == 3
    assert names["diagnosis"].effects == ("static_friction",)
    assert names["diagnosis"].model.values["armature_resistance"] == pytest.approx(4.55, rel=0.01)
    assert names["after"].rmse < 1.1 * names["after"].noise < 0.1 * names["before"].rmse
    assert "model.yaml" in shown[-1]


def test_the_notebook_is_kept_without_outputs():
    for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]:
        assert not cell.get("outputs") and cell.get("execution_count") is None
