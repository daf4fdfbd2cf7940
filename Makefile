# penink: `make` draws all samples, `make test` passes the tests. Both do all their own set-up.
#
#   make            virtual environment, install, samples/out/*.ps and *.preview.png
#   make test       the tests            make lint    ruff and mypy
#   make bench      the measurements     make dist    wheel and source distribution
#   make check-dist both, installed in an empty environment
#   make clean      remove what make made
#
# PYTHON is the interpreter to build the environment with, VENV the environment's folder.

PYTHON ?= python3
VENV   ?= .venv

BIN       := $(abspath $(VENV))/bin
INSTALLED := $(VENV)/.installed
KERNELS   := $(shell sed -n 's/^sources = \["\(.*\)"\]/\1/p' pyproject.toml)
BENCHES   := $(patsubst tests/benchmarks/%.py,tests.benchmarks.%,$(filter-out %/__init__.py %/_%,$(wildcard tests/benchmarks/*.py)))

.PHONY: all install samples test lint bench dist check-dist clean needs needs-python
.DELETE_ON_ERROR:

all: samples

install: $(INSTALLED)

# What only the system's package manager can bring; each is installed if permitted, else named.
needs:
	@.ci/need gs ghostscript
needs-python:
	@PYTHON="$(PYTHON)" .ci/need python-venv python3-venv
	@PYTHON="$(PYTHON)" .ci/need python-headers python3-dev

$(INSTALLED): pyproject.toml penink_cli/__init__.py $(KERNELS) | needs-python
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test,lint]'
	touch $@

samples: $(INSTALLED) needs
	$(MAKE) -C samples PATH="$(BIN):$$PATH"

test: $(INSTALLED) needs
	PATH="$(BIN):$$PATH" $(BIN)/python -m pytest $(TESTS)

lint: $(INSTALLED)
	$(BIN)/ruff check .
	$(BIN)/mypy

bench: $(INSTALLED) needs
	@for bench in $(BENCHES); do echo "== $$bench"; PATH="$(BIN):$$PATH" $(BIN)/python -m $$bench || exit 1; done

dist: $(INSTALLED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check build
	$(BIN)/python -m build --outdir dist .

check-dist: needs-python
	.ci/check-dist $(PYTHON)

clean:
	rm -rf $(VENV) build dist *.egg-info .pytest_cache .hypothesis .mypy_cache .ruff_cache
	rm -f $(KERNELS:.py=.c) $(wildcard $(KERNELS:.py=.*.so))
	find penink_cli tests -name __pycache__ -prune -exec rm -rf {} +
	$(MAKE) -C samples clean
