# `make demo` and `make test` set up all they need: uv where it is present, venv and pip otherwise.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
UV := $(shell command -v uv 2>/dev/null)
# One worker for each core; `make test JOBS=0` runs in one process.
JOBS ?= auto

ifdef UV
  MAKE_VENV = $(UV) venv --quiet --allow-existing --python $(PYTHON) $(VENV)
  INSTALL = $(UV) pip install --quiet --python $(BIN)/python
else
  MAKE_VENV = $(PYTHON) -m venv $(VENV)
  INSTALL = $(BIN)/python -m pip install --quiet --disable-pip-version-check
endif

.PHONY: help demo test test-all lint bench docs figures studies golden clean
help:
	@echo "make demo    plan with every planner on three tessellations; a table, a picture and an animation in demo/"
	@echo "make test    all tests, on few cases each: minutes; make test-all on all cases, as in CI"
	@echo "make lint    ruff, mypy and import-linter"
	@echo "make bench   speed, as ratios against other libraries"
	@echo "make docs    the documentation in build/docs; make figures draws its pictures anew"
	@echo "make studies the pages of the studies from their tables of results"
	@echo "make clean   remove the environment and all caches"

# What a user needs, and beyond it what a developer needs: the demo waits only for the former.
$(VENV)/.user: pyproject.toml
	$(MAKE_VENV)
	$(INSTALL) -e .
	@touch $@
$(VENV)/.dev: pyproject.toml $(VENV)/.user
	$(INSTALL) -e '.[dev]'
	$(INSTALL) --no-deps 'jupedsim>=1.2' # its window alone needs Qt and VTK, 1.2 GB
	@touch $@
$(VENV)/.bench: pyproject.toml $(VENV)/.user
	$(INSTALL) -e '.[bench]'
	@touch $@
$(VENV)/.docs: pyproject.toml $(VENV)/.user
	$(INSTALL) -e '.[docs]'
	@touch $@

demo: $(VENV)/.user
	$(BIN)/trihex demo --out demo

# How many cases tests try says TRIHEX_SWEEPS (tests/sweeps.py).
test: $(VENV)/.dev
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal

test-all: $(VENV)/.dev
	TRIHEX_SWEEPS=full $(BIN)/python -m pytest -n $(JOBS) --dist worksteal

lint: $(VENV)/.dev
	$(BIN)/ruff check src tests benchmarks examples
	$(BIN)/ruff format --check src tests benchmarks examples
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(VENV)/.bench
	$(BIN)/python -m benchmarks

docs: $(VENV)/.docs
	$(BIN)/python -m sphinx --fail-on-warning --keep-going -q -b html -d build/doctrees docs build/docs
	@echo "build/docs/index.html"

figures: $(VENV)/.docs $(VENV)/.dev
	$(BIN)/python -m examples
	$(BIN)/python -m tests.viewer.picture

studies: $(VENV)/.docs
	$(BIN)/python -m examples.studies

clean:
	rm -rf $(VENV) demo build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
