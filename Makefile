# make demo   solve every goal of the bundled kitchen, compare the searches with the optimum, draw a tree
# make test   the tests, in less than three minutes; make test-slow for the long ones
# make lint   style and types
# make bench  the benchmarks, in a few minutes, into docs/performance.md; make bench-full the large ones, which
#             take about an hour and a half (with DATA=DIR also on the network in a folder)
# Each makes .venv and installs what it needs when run first.

PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
BIN := .venv/bin
CORES := -n auto --dist worksteal
PAGE := --page docs/performance.md

.PHONY: demo test test-slow lint bench bench-full clean

demo: .venv/installed
	@mkdir -p demo
	@$(BIN)/foon-asp compare --chart demo/searches.svg --chart demo/searches.png
	@echo
	@$(BIN)/foon-asp optima
	@echo
	@$(BIN)/foon-asp draw --goal macaroni -o demo/macaroni.svg

test: .venv/installed-dev
	$(BIN)/python -m pytest $(CORES)

test-slow: .venv/installed-dev
	$(BIN)/python -m pytest $(CORES) -m slow

lint: .venv/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: .venv/installed-bench
	$(BIN)/python benchmarks/solve_phases.py
	$(BIN)/python benchmarks/opponents.py --limit 10 $(PAGE) --section quick-opponents
	$(BIN)/python benchmarks/scaling.py $(PAGE) --section quick-scaling

bench-full: .venv/installed-bench
	for family in recipe-like deep; do \
	  $(BIN)/python benchmarks/opponents.py --family $$family --units 100000 --rows $$family.jsonl \
	    $(PAGE) --section $$family || exit 1; done
	cat recipe-like.jsonl deep.jsonl > large.jsonl
	$(BIN)/python benchmarks/opponents.py --from-rows large.jsonl --plot docs/pictures/opponents.svg
	$(BIN)/python benchmarks/scaling.py --units 1000 --units 10000 --units 100000 --units 1000000 \
	  --runs 1 $(PAGE) --plot docs/pictures/scaling.svg
	test -z "$(DATA)" || $(BIN)/python benchmarks/opponents.py --data "$(DATA)" --goals 20 $(PAGE) --section real
	rm -f recipe-like.jsonl deep.jsonl large.jsonl

clean:
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .hypothesis dist

.venv/bin/python:
	@test -n "$(PYTHON)" || { echo "foon-asp needs Python 3.11 or newer"; exit 1; }
	$(PYTHON) -m venv .venv

.venv/installed: pyproject.toml | .venv/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[pictures]'
	@touch $@

.venv/installed-dev: pyproject.toml | .venv/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,pictures]'
	@touch .venv/installed $@

.venv/installed-bench: pyproject.toml | .venv/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,pictures,bench]'
	@touch .venv/installed .venv/installed-dev $@
