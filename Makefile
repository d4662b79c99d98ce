# `make demo` shows the main job, `make test` runs every check, `make quick` the quick tests, `make site`
# builds the documentation; all set up .venv first, once.
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
STAMP := $(VENV)/.installed
COLCON := build/colcon

# The newest suitable interpreter that can make virtual environments.
PYTHON := $(shell for name in python3.13 python3.12 python3.11 python3.10 python3 python; do \
	"$$name" -c 'import ensurepip, sys, venv; sys.exit(not (3, 10) <= sys.version_info[:2] <= (3, 13))' \
	2>/dev/null && echo "$$name" && break; done)
# That with which the oldest versions still come as wheels.
LOWEST_PYTHON := $(shell for name in python3.12 python3.11 python3.10; do \
	"$$name" -c 'import ensurepip, venv' 2>/dev/null && echo "$$name" && break; done)

.PHONY: demo test quick lint types site library nodes colcon lowest alone benchmarks clean

demo: $(READY)
	$(BIN)/pierburg demo

test: lint types site library nodes colcon

# What running takes; the tools of tests and documentation take as much again.
$(READY): setup.py pyproject.toml constraints/newest.txt
	@test -n "$(PYTHON)" || { echo "No Python 3.10 to 3.13 with venv found; install one (e.g. python3-venv)."; exit 1; }
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet 'setuptools>=70.1'
	$(BIN)/python -m pip install --quiet --no-build-isolation --editable '.[ros,mujoco]' --constraint constraints/newest.txt
	@touch $@

$(STAMP): $(READY)
	$(BIN)/python -m pip install --quiet --no-build-isolation --editable '.[ros,test,docs]' --constraint constraints/newest.txt
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

# Processes over DDS can be starved on a shared machine; a failure is tried again and shown as such. Worker processes
# run the tests, so that a crash of the middleware's own code is a failure like any other; two, for most of the time
# passes in waiting.
nodes: $(STAMP)
	$(BIN)/python -m pytest -n 2 --dist loadfile -m ros --reruns 2

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

# The quick tests with the oldest versions that setup.py allows: with Python 3.12, ROS 2 Jazzy's, if it is there.
# Of pyarrow, 21 still takes the oldest NumPy.
lowest:
	@test -x build/lowest/bin/python || $(LOWEST_PYTHON) -m venv build/lowest
	build/lowest/bin/python -m pip install --quiet 'setuptools>=70.1'
	build/lowest/bin/python -m pip install --quiet --no-build-isolation --editable '.[test]' 'pyarrow<22' --constraint constraints/lowest.txt
	build/lowest/bin/python -m pytest -n auto --dist loadfile -m 'not ros and not search'

# The source distribution, installed into an environment of its own and run there, away from the sources.
alone: $(STAMP)
	rm -rf build/alone && mkdir -p build/alone
	$(BIN)/python -c 'from setuptools import build_meta; build_meta.build_sdist("build/alone")'
	$(PYTHON) -m venv build/alone/venv
	build/alone/venv/bin/python -m pip install --quiet build/alone/*.tar.gz --constraint constraints/newest.txt
	printf 'time,duty\n0,0\n0.5,0.2\n1.5,0.1\n2.5,0.28\n3.5,0.05\n4.5,0.2\n5.5,0\n' > build/alone/duty.csv
	cd build/alone && venv/bin/pierburg simulate --actuator pierburg --duty duty.csv --noise 0.003 --output simulated
	cd build/alone && venv/bin/pierburg replay simulated/simulated.mcap --actuator pierburg --output replayed
	cd build/alone && venv/bin/pierburg diagnose simulated/simulated.mcap --output diagnosed

# Writes docs/developers/measurements.md, in about 25 minutes on an otherwise idle machine.
benchmarks: $(STAMP)
	$(BIN)/python benchmarks/simulator.py
	$(BIN)/python benchmarks/fuzzy.py
	$(BIN)/python benchmarks/pacing.py
	$(BIN)/python benchmarks/graph.py

clean:
	rm -rf build install log dist *.egg-info
