# Two commands matter: `make run` and `make test`. Both install what is missing and are quick the second time.
#   make run ARGS="--lan --scene scenes/dark.toml"    ARGS go to `tapreach run`
#   make test ARGS="tests/geometry -x"                ARGS go to pytest
MAKEFLAGS += --no-print-directory
ARGS ?=

.PHONY: help run test lint format clean

help:
	@echo "make run      start the simulated rover and the operator page (ARGS=... for tapreach run)"
	@echo "make test     check format, lint and types, then run every test (ARGS=... for pytest)"
	@echo "make lint     the checks of make test without the tests"
	@echo "make format   put the Python code into the house format"
	@echo "make clean    remove what the two commands installed and cached here"

run:
	@exec sh tools/run.sh $(ARGS)

test:
	@exec sh tools/test.sh $(ARGS)

lint:
	@TAPREACH_LINT_ONLY=1 exec sh tools/test.sh

format:
	@.venv/bin/ruff check --fix --quiet . ; .venv/bin/ruff format .

clean:
	rm -rf .venv node_modules .mypy_cache .ruff_cache .pytest_cache .hypothesis build dist
