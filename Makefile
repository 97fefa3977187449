# `make help` lists the targets. PYTHON may name another interpreter (3.11 or newer).
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.ready
export OMP_NUM_THREADS = 1
# Every service process would compile the same modules again.
unexport PYTHONDONTWRITEBYTECODE
PIP := $(BIN)/python -m pip --disable-pip-version-check
ARGS ?=
BENCHES ?= physics bus processes grasp speech

.PHONY: help setup demo test test-slow test-all mutants check test-compose bench lock image wheels clean

help: ## this list
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | expand -t 16

setup: $(STAMP) ## .venv from requirements.lock, with `.venv/bin/tidybot` in it

$(STAMP): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	    { echo "Python 3.11 or newer is needed; $(PYTHON) is `$(PYTHON) --version`. Try: make setup PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || \
	    { echo "this Python cannot make virtual environments; on Debian or Ubuntu: apt-get install python3-venv"; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(PIP) install --quiet -r requirements.lock
	$(PIP) install --quiet --no-deps --no-build-isolation -e .
	$(BIN)/python -m common.speech_weights >/dev/null
	$(BIN)/python -m services.speech.prepared >/dev/null
	$(BIN)/python -m compileall -q -j 0 common services cli judge evaluation
	@touch $(STAMP)
	@echo "ready: $(BIN)/tidybot"

demo: setup ## "bring me the red mug", from a recording to the delivery; ARGS='--speed max --seed 3'
	$(BIN)/tidybot demo $(ARGS)

# More workers than cores, since tests that start processes (a router port and a namespace each) mostly wait.
# tests/conftest.py says what is begun first and what stays together.
PYTEST := $(BIN)/python -m pytest -q -n 4 --dist loadfile --no-loadscope-reorder

test: setup ## every layer in some minutes: all tests but the slow ones
	$(PYTEST) -m 'not slow' $(ARGS)

test-slow: setup ## the others: whole missions, matrices, machines in network namespaces
	$(PYTEST) -m slow $(ARGS)

test-all: test test-slow ## everything

check: setup ## lint, format, types, imports, and the lock file on every platform
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python -m tests.platforms

mutants: setup ## what the tests of the pure modules do not notice; ARGS='validate access' for some
	$(BIN)/python -m tests.mutants $(ARGS)

test-compose: setup ## the compose file under a Docker engine of its own (root, Debian)
	$(BIN)/python -m tests.compose.run $(ARGS)

bench: setup ## every benchmark, each prints a table; fails when one of them does
	@failed=; for name in $(BENCHES); do echo "== bench.$$name"; $(BIN)/python -m bench.$$name || failed="$$failed $$name"; done; \
	test -z "$$failed" || { echo "failed:$$failed"; exit 1; }

# --universal: one file for every platform; the environment markers say what belongs where.
LOCK := $(BIN)/uv --quiet pip compile pyproject.toml --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
    --no-annotate --custom-compile-command "make lock"
# All but `things`, 620 MB that only one suite of the evaluation needs.
EXTRAS = $(shell $(BIN)/python -c "import tomllib; print(*('--extra ' + e for e in tomllib.load(open('pyproject.toml', 'rb'))['project']['optional-dependencies'] if e != 'things'))")
lock: setup ## both lock files anew from pyproject.toml; ARGS='-P mujoco' for one package alone
	echo hatchling | $(LOCK) - $(EXTRAS) $(or $(ARGS),--upgrade) --output-file requirements.lock
	echo hatchling | $(LOCK) - --extra llm --extra ros2 --extra foxglove --extra mapping --constraint requirements.lock --upgrade --output-file requirements.image.lock

image: ## one image for x86-64 and one for aarch64, see docker-bake.hcl; ARGS='--push' with a registry in TIDYBOT_IMAGE
	docker buildx bake $(ARGS)

wheels: setup ## build/wheels: everything the image needs, so that it builds without a network
	$(PIP) download --quiet --dest build/wheels -r requirements.image.lock

clean: ## what was made here
	rm -rf $(VENV) build out run .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis *.egg-info
	find . -name __pycache__ -not -path './.git/*' -exec rm -rf {} +
