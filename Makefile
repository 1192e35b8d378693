# Each target works on a bare clone with make and Python 3.11, 3.12 or 3.13: the first one to run sets up .venv.
PYTHON ?= $(shell for v in 3.11 3.12 3.13; do python$$v -c "" 2>/dev/null && echo python$$v && break; done)
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.ready
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1

.PHONY: help setup test fuzz lint demo train bench validate docs dist clean

help:
	@echo "make demo   roll the shipped policy: demo/run.html, metrics.json, gait.png, roll.mp4"
	@echo "make test   all tests"
	@echo "make fuzz   20,000 damaged inputs for every reader of a file, and for the environment: a quarter of an hour"
	@echo "make lint   ruff and mypy"
	@echo "make train  train the rolling policy from scratch: runs/rolling-s0"
	@echo "make validate  docs/validation.md with its figures: half an hour on two cores, and goes on where it was stopped"
	@echo "make docs   these documents as pages: build/docs/index.html"
	@echo "make dist   wheel and source distribution: dist"
	@echo "make bench  measured ratios: substep, environment, start-up beside their peers, flexure models against their FEM"

setup: $(STAMP)

$(STAMP): pyproject.toml constraints.txt
	@command -v "$(PYTHON)" >/dev/null || { \
	  echo "no $(or $(PYTHON),Python 3.11 to 3.13) here, and PyBullet has no wheels for other Pythons: run make PYTHON=/path/to/python3.13"; exit 1; }
	@$(PYTHON) -c 'import sys; v = sys.version_info[:2]; sys.exit(0 if (3, 11) <= v <= (3, 13) else \
	  f"Python {v[0]}.{v[1]} has no PyBullet wheel, 3.11 to 3.13 have: run make PYTHON=/path/to/python3.13")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[train,search,mujoco,view,dev]'
	@touch $(STAMP)

test: $(STAMP)
	$(BIN)/python -m pytest --numprocesses auto --maxprocesses 4 --dist loadfile

fuzz: $(STAMP)
	$(BIN)/python -m tests.fuzz

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/mypy

demo: $(STAMP)
	$(BIN)/tensegym roll --out demo --replay demo/run.html

train: $(STAMP)
	$(BIN)/tensegym train --config rolling --seed 0

bench: $(STAMP)
	$(BIN)/python benchmarks/ratios.py --out benchmarks/results/ratios.json
	$(BIN)/python benchmarks/flexure.py

validate: $(STAMP)
	$(BIN)/tensegym validate --page docs

docs: $(STAMP)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[docs]'
	$(BIN)/sphinx-build -W --keep-going -q -b html docs build/docs
	$(BIN)/python -m docs.check build/docs

dist: $(STAMP)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[docs]'
	rm -rf dist
	$(BIN)/python -m build --quiet
	$(BIN)/twine check --strict dist/*

clean:
	rm -rf $(VENV) build dist *.egg-info demo runs docs/reference docs/gallery
