"""The documentation as a site: `make site` writes build/site/index.html, with warnings as errors."""

import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "docs")]

project = "pierburg_ros"
author = "pierburg_ros developers"
extensions = ["myst_parser", "sphinx.ext.autodoc", "reference.site"]
exclude_patterns = ["**/README.template.md", "**/__pycache__"]
html_theme = "furo"
html_title = "pierburg_ros"
html_show_sphinx = False
html_copy_source = False
# Headings get the anchors that GitHub gives them, so that links hold on both.
myst_heading_anchors = 4
autodoc_default_options = {"members": True, "inherited-members": False, "member-order": "bysource"}
autodoc_typehints = "description"
python_maximum_signature_line_length = 88
default_role = "code"
suppress_warnings = ["misc.highlighting_failure"]  # Pygments has no lexer for CSV
