"""The environments for conda ask for what setup.py asks for."""

import re
import sys
from pathlib import Path

import pytest
import yaml
from test_packaging import MANIFEST, requirements

ROOT = Path(__file__).parent.parent
OTHER_NAMES = {"matplotlib": "matplotlib-base"}
"""What conda-forge calls differently, but for capitals."""


def required() -> dict[str, str]:
    """The bound of every requirement by its name at conda-forge."""
    bounds = {each.name: str(each.specifier) for each in requirements() if each.name != "setuptools"}
    return {OTHER_NAMES.get(name, name.lower()): bound for name, bound in bounds.items()}


def test_the_recipe_has_the_version_and_the_requirements_of_the_package():
    recipe = yaml.safe_load((ROOT / "conda" / "recipe.yaml").read_text())
    assert recipe["context"]["version"] == MANIFEST.findtext("version")
    lines = (re.split(r"\s+", line) for line in recipe["requirements"]["run"])
    assert {name: bound[0] for name, *bound in lines if bound and name != "python"} == required()


@pytest.mark.skipif(sys.version_info < (3, 11), reason="Python reads TOML from 3.11 on")
def test_the_environment_of_pixi_has_the_requirements_of_the_package():
    import tomllib

    manifest = tomllib.loads((ROOT / "pixi.toml").read_text())
    given = {**manifest["dependencies"], **manifest["pypi-dependencies"]}
    assert {name: given.get(name) for name in required()} == required()


def test_the_citation_names_the_version_of_the_package():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == MANIFEST.findtext("version")
