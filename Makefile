# penink: `make` draws all samples, `make test` passes the tests. Both do all their own set-up.
#
#   make            virtual environment, install, samples/out/*.ps and *.preview.png
#   make test       the tests            make lint    ruff, mypy, cython-lint
#   make quick      the tests that need neither Ghostscript nor Chromium and do not take long
#   make figures    the paper's figures with other pictures: samples/out/figures.pdf, .png and table1.md
#   make gallery    the README's pictures: samples/gallery/*.png; samples/out/gallery.html and .pdf
#   make bench      the measurements     make dist    wheel and source distribution
#   make check-dist both, installed in an empty environment
#   make check-pythons  the same bytes under every CPython that this machine has (PYTHONS=…)
#   make check-resolver  whether every dependency is to be had for other interpreters and machines
#   make check-roots  `make` and `make test` on an otherwise empty Debian 12 and 13 (ROOTS=bookworm)
#   make cluster    twenty photographs on a Slurm of one node that is started for it, jobs killed, resumed: as root
#   make fuzz       every reader against anything (SECONDS=600)
#   make manual     man pages, completion, schemas and tables that follow from help texts and registries
#   make torture    a thousand runs killed, two hundred photographs
#   make clean      remove what make made
#
# PYTHON is the interpreter to build the environment with, VENV the environment's folder.

PYTHON ?= python3
VENV   ?= .venv

BIN       := $(abspath $(VENV))/bin
INSTALLED := $(VENV)/.installed
KERNELS   := $(shell find penink_cli -path '*/_compiled/*.pyx')
BENCHES   := $(patsubst tests/benchmarks/%.py,tests.benchmarks.%,$(filter-out %/__init__.py %/_%,$(wildcard tests/benchmarks/*.py)))

.PHONY: all install samples gallery figures test lint bench fuzz torture manual dist check-dist check-pythons check-roots check-resolver cluster clean needs quick
.DELETE_ON_ERROR:

all: samples

install: $(INSTALLED)

# Programs that only the system's package manager can bring (.ci/packages) come first: all at once where permitted, else named.
NEEDS := $(if $(filter test quick bench,$(MAKECMDGOALS)),test,$(if $(filter install lint manual dist check-dist fuzz torture cluster,$(MAKECMDGOALS)),install,make))
needs:
	@PYTHON="$(PYTHON)" .ci/need $(NEEDS)

$(INSTALLED): pyproject.toml penink_cli/__init__.py $(KERNELS) $(shell find penink_cli -path '*/_compiled/*.pxd' -o -path '*/_compiled/*.h') .build/compiling.py | needs
	@echo "setting up $(VENV): two to five minutes, most of them for the kernels"
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[test,lint]'
	touch $@

samples: $(INSTALLED)
	$(MAKE) -C samples PATH="$(BIN):$$PATH"

gallery: $(INSTALLED)
	PATH="$(BIN):$$PATH" $(BIN)/python samples/photographs.py samples/out
	PATH="$(BIN):$$PATH" $(BIN)/python samples/gallery.py samples/out samples/gallery samples/out

figures: $(INSTALLED)
	$(MAKE) -C samples figures PATH="$(BIN):$$PATH"
	PATH="$(BIN):$$PATH" $(BIN)/python -m tests.benchmarks.illustrations --table samples/out > samples/out/table1.md
	@cat samples/out/table1.md

test: $(INSTALLED)
	PATH="$(BIN):$$PATH" $(BIN)/python -m pytest -n auto --dist worksteal $(TESTS)

quick: $(INSTALLED)
	PATH="$(BIN):$$PATH" $(BIN)/python -m pytest -n auto --dist worksteal -m "not rendered and not slow" $(TESTS)

lint: $(INSTALLED)
	$(BIN)/ruff check .
	$(BIN)/mypy
	PATH="$(BIN):$$PATH" $(BIN)/cython-lint penink_cli

# Fuzz every reader for SECONDS in all. Inputs that break one stay in tests/data/found, and `make test` tries them.
SECONDS ?= 600
fuzz: $(INSTALLED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check '.[fuzz]'
	$(BIN)/python -m tests.fuzz $(SECONDS)

# 1000 runs killed at random moments, and 200 photographs through the whole chain: half an hour each.
torture: $(INSTALLED)
	$(BIN)/python -m tests.faults.kills 1000
	$(BIN)/python -m tests.faults.batch 200

manual: $(INSTALLED)
	$(BIN)/python -m penink_cli.manual

bench: $(INSTALLED)
	@for bench in $(BENCHES); do echo "== $$bench"; PATH="$(BIN):$$PATH" $(BIN)/python -m $$bench || exit 1; done

dist: $(INSTALLED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check build
	$(BIN)/python -m build --outdir dist .

check-dist: needs
	.ci/check-dist $(PYTHON)

# The nine samples, every texture and every style under each CPython that is to be had, byte for byte: some five minutes each.
check-pythons:
	.ci/check-pythons $(PYTHONS)

# `make` and `make test` in new roots of Debian 12 and 13 that hold nothing but python3, gcc, make and git: an hour, as root.
check-roots:
	.ci/check-roots $(ROOTS)

# Every dependency by wheel or source for CPython 3.11 to 3.14, on Intel and ARM, glibc and musl: some minutes, most of them waiting.
check-resolver:
	.ci/check-resolver

# The Snakefile on a real Slurm, which is started for it and stopped again: as root, with Debian's slurm-wlm and munge.
cluster: $(INSTALLED)
	PATH="$(BIN):$$PATH" .ci/cluster

clean:
	rm -rf $(VENV) build dist *.egg-info .pytest_cache .hypothesis .mypy_cache .ruff_cache
	rm -f $(addsuffix .c,$(basename $(KERNELS))) $(wildcard $(addsuffix .*.so,$(basename $(KERNELS)))) penink_cli/_shared.*
	find penink_cli tests -name __pycache__ -prune -exec rm -rf {} +
	$(MAKE) -C samples clean
