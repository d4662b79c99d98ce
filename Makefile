# `make demo` shows the main job, `make test` runs every check, `make quick` the quick tests, `make site`
# builds the documentation; all set up .venv first, once.
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
COLCON := build/colcon

# The newest suitable interpreter that can make virtual environments.
PYTHON := $(shell for name in python3.13 python3.12 python3.11 python3.10 python3 python; do \
	"$$name" -c 'import ensurepip, sys, venv; sys.exit(not (3, 10) <= sys.version_info[:2] <= (3, 13))' \
	2>/dev/null && echo "$$name" && break; done)

.PHONY: demo test quick lint types site library nodes colcon benchmarks clean

demo: $(STAMP)
	$(BIN)/pierburg demo

test: lint types site library nodes colcon

$(STAMP): setup.py pyproject.toml
	@test -n "$(PYTHON)" || { echo "No Python 3.10 to 3.13 with venv found; install one (e.g. python3-venv)."; exit 1; }
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet 'setuptools>=70.1'
	$(BIN)/python -m pip install --quiet --no-build-isolation --editable '.[ros,test,docs]'
	@touch $@

lint: $(STAMP)
	$(BIN)/ruff check .

types: $(STAMP)
	$(BIN)/mypy

# The documentation, build/site/index.html; a warning is an error.
site: $(STAMP)
	$(BIN)/sphinx-build -q -W --keep-going docs build/site

library: $(STAMP)
	$(BIN)/python -m pytest -n auto --dist loadfile -m 'not ros'

# What to run while changing something: all but whole searches, compiling anew, and processes over DDS.
quick: $(STAMP)
	$(BIN)/python -m pytest -n auto --dist loadfile -m 'not ros and not search'

# Processes over DDS can be starved on a shared machine; a failure is tried again and shown as such. One worker
# process runs the tests, so that a crash of the middleware's own code is a failure like any other.
nodes: $(STAMP)
	$(BIN)/python -m pytest -n 1 -m ros --reruns 2

# An environment of its own: colcon needs setuptools below 80. The libraries come from .venv.
$(COLCON)/.installed: $(STAMP)
	$(PYTHON) -m venv $(COLCON)
	$(COLCON)/bin/python -m pip install --quiet 'setuptools<80' colcon-common-extensions
	$(BIN)/python -c 'import sysconfig; print(sysconfig.get_paths()["purelib"])' \
		> "$$($(COLCON)/bin/python -c 'import sysconfig; print(sysconfig.get_paths()["purelib"])')/libraries.pth"
	@touch $@

colcon: $(COLCON)/.installed
	$(COLCON)/bin/python -m colcon --log-base build/log build --build-base build/colcon_build \
		--install-base build/install --paths . --event-handlers console_direct+
	PIERBURG_INSTALL_SPACE=$(CURDIR)/build/install $(BIN)/python -m pytest test/nodes/test_install_space.py

# Writes docs/benchmarks.md, in about 25 minutes on an otherwise idle machine.
benchmarks: $(STAMP)
	$(BIN)/python benchmarks/simulator.py
	$(BIN)/python benchmarks/fuzzy.py
	$(BIN)/python benchmarks/least_squares.py
	$(BIN)/python benchmarks/pacing.py
	$(BIN)/python benchmarks/graph.py

clean:
	rm -rf build install log dist *.egg-info
