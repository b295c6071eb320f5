# make demo   one screen: five goals, the searches beside the optimum; more of it is left in demo/
# make docs   the documentation as a site, in site/html, with a reference made from the program
# make test   the tests, in two minutes; make test-slow and make test-nightly for the long ones
# make test-lowest   the tests with the lowest versions of our dependencies that pyproject.toml allows
# make coverage  which lines of the package the tests reach: from Python 3.12 little slower than the tests
# make mutants   changes the code on purpose, to see whether a test notices: hours, or with SAMPLE=600 ten minutes;
#                with SINCE=REVISION only the files that differ from it, with the tests of their rooms
# make lint   style, types, and names and docstrings that hide a meaning
# make bench  the benchmarks, in a few minutes; make bench-full the large ones into docs/dev/performance.md, which
#             take about an hour and a half (with DATA=DIR also on the network in a folder)
# make verified  the checker of certificates that is proved in Coq (docs/proofs.md), where Coq and OCaml are installed
# Each makes .venv and installs what it needs when run first. With PYTHON=python3.13 VENV=.venv-3.13 it is another
# Python in a folder of its own.

PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
VENV ?= .venv
BIN := $(VENV)/bin
CORES := -n auto --dist worksteal
PAGE := --page docs/dev/performance.md
# hundreds of processes are started by the tests: each would compile everything anew
export PYTHONDONTWRITEBYTECODE :=

.PHONY: demo docs man test test-slow test-nightly test-lowest coverage mutants verified lint bench bench-full clean

demo: $(VENV)/installed
	@mkdir -p demo
	@$(BIN)/foon-asp compare --chart demo/searches.svg --chart demo/searches.png > demo/compare.txt 2>&1
	@$(BIN)/foon-asp solve --all-goals --objective units --objective inputs --objective success > demo/optima.txt
	@$(BIN)/foon-asp view --goal macaroni -o demo/macaroni.svg
	@$(BIN)/foon-asp view --goal macaroni -o demo/macaroni.html
	@$(BIN)/python benchmarks/one_screen.py

docs: $(VENV)/installed-docs
	$(BIN)/python docs/build.py
	@echo "built: site/html/index.html"

man: $(VENV)/installed
	$(BIN)/python docs/man.py
	@echo "written: build/man; man -M build/man foon-asp"

test: $(VENV)/installed-dev
	$(BIN)/python -m pytest $(CORES)

test-slow: $(VENV)/installed-dev
	$(BIN)/python -m pytest $(CORES) -m 'slow and not nightly'

test-nightly: $(VENV)/installed-dev
	$(BIN)/python -m pytest $(CORES) -m nightly

coverage: $(VENV)/installed-dev
	COVERAGE_CORE=sysmon $(BIN)/python -m pytest $(CORES) --cov --cov-report=term:skip-covered

mutants: $(VENV)/installed-dev
	$(BIN)/python -m tests.mutation $(if $(SAMPLE),--seconds $(SAMPLE)) $(if $(SINCE),--changed-since $(SINCE))

test-lowest:
	PYTHON="$(PYTHON)" .ci/lowest $(CORES)

verified:
	@$(MAKE) --no-print-directory -C verified

lint: $(VENV)/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m tests.docs.words

bench: $(VENV)/installed-bench
	$(BIN)/python benchmarks/solve_phases.py
	$(BIN)/python benchmarks/opponents.py --limit 10
	$(BIN)/python benchmarks/scaling.py

bench-full: $(VENV)/installed-bench
	for family in recipe-like deep; do \
	  $(BIN)/python benchmarks/opponents.py --family $$family --units 100000 --rows $$family.jsonl \
	    $(PAGE) --section $$family || exit 1; done
	cat recipe-like.jsonl deep.jsonl > large.jsonl
	$(BIN)/python benchmarks/opponents.py --from-rows large.jsonl --plot docs/pictures/opponents.svg
	$(BIN)/python benchmarks/scaling.py --units 1000 --units 10000 --units 100000 --units 1000000 \
	  --runs 1 $(PAGE) --plot docs/pictures/scaling.svg
	test -z "$(DATA)" || $(BIN)/python benchmarks/opponents.py --data "$(DATA)" --goals 20 \
	  --objective units --objective success $(PAGE) --section real
	rm -f recipe-like.jsonl deep.jsonl large.jsonl

clean:
	rm -rf .venv .venv-* site build verified/build .mypy_cache .pytest_cache .ruff_cache .hypothesis dist

$(VENV)/bin/python:
	@test -n "$(PYTHON)" || { echo "foon-asp needs Python 3.11 or newer"; exit 1; }
	"$(PYTHON)" -m venv $(VENV)

$(VENV)/installed: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[pictures]'
	@touch $@

$(VENV)/installed-dev: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,pictures]'
	@touch $(VENV)/installed $@

$(VENV)/installed-docs: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[docs,pictures]'
	@touch $(VENV)/installed $@

$(VENV)/installed-bench: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,pictures,bench]'
	@touch $(VENV)/installed $(VENV)/installed-dev $@
