# One command each: `make demo`, `make serve`, `make test`, `make test-more`, `make test-all`, `make lint`, `make fuzz`,
# `make soak`, `make bench`, `make drivers`.
# A new machine needs only make and Python >= 3.11 with its venv module.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
DEMO ?= .demo
SHELL := /bin/bash
.NOTPARALLEL:
# Files in the order in which conftest.py puts them, the longest first: pytest-xdist would go by numbers of tests.
# Compiled modules are kept, for the many processes that tests start.
PYTEST := env -u PYTHONDONTWRITEBYTECODE $(BIN)/python -m pytest --numprocesses=auto --maxprocesses=8 --dist=loadfile --no-loadscope-reorder

.PHONY: demo serve test test-more test-programs test-all lint fuzz soak bench docs check-wheel drivers drivers-part wheel client environment gl shaders browser display proxy clean

demo: $(VENV)/.ready-user gl
	$(BIN)/pvfiblets demo --output $(DEMO)

serve: $(VENV)/.ready-web demo
	$(BIN)/pvfiblets serve $(DEMO)/*.fiblets --root $(DEMO)

# Mesa's software OpenGL compiles a shader's machine code anew on every new machine, which takes longer than to draw
# small pictures: here without optimising it, by `make test-all` as users have it.
test test-more: export GALLIVM_PERF = nopt
test test-more test-all: export LEAST = 4.3
test: environment lint gl shaders
	$(PYTEST)

# What `make test` leaves out: browsers, windows, proxies, workflows, the docs' pages and the examples as programs, soak, the
# wheel and other drivers.
test-more: $(VENV)/.ready-more gl shaders browser display proxy
	$(PYTEST) -m 'more and not exhaustive and not programs'
	@$(MAKE) check-wheel drivers-part test-programs

# Beside MRtrix3, ParaView, DIPY, trx-python and SimpleITK; `PVFIBLETS_PAGE=1 make test-programs` writes what was found to
# docs/reference/programs.md.
test-programs: environment
	@PYTHON=$(BIN)/python scripts/programs.sh
	$(BIN)/python -m pytest -m programs tests/programs

test-all: $(VENV)/.ready-more lint gl shaders browser display proxy
	PVFIBLETS_FUZZ=1000 $(PYTEST) -m '' --hypothesis-profile=exhaustive --timeout=3600

lint: environment
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	$(BIN)/python scripts/prose.py

fuzz: environment
	$(BIN)/python -m pytest -m hypothesis --hypothesis-profile=fuzz --timeout=3600
	PVFIBLETS_FUZZ=10000 $(BIN)/python -m pytest tests/formats/test_fuzz.py tests/web/test_session_damage.py --timeout=14400

soak: environment gl
	PVFIBLETS_SOAK=2000 $(BIN)/python -m pytest -m '' -s --timeout=14400 tests/soak

bench: environment gl
	$(BIN)/pvfiblets report --only lines -o $(DEMO)/lines

docs: environment gl
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	$(BIN)/python -m sphinx -W --keep-going -b html docs docs/_build/html

check-wheel: environment gl
	@PYTHON=$(BIN)/python scripts/wheel_check.sh

drivers: environment gl
	@PYTHON=$(BIN)/python scripts/drivers.sh

drivers-part: environment
	@scripts/drivers.sh --part

# The script of pages, for which node is needed; what it makes is part of the repository.
client: environment
	$(BIN)/python scripts/page_client.py

wheel: environment
	$(BIN)/python -m pip wheel --no-deps --wheel-dir dist .

environment: $(VENV)/.ready-dev

# For whom: a user, one who serves pages, who runs `make test`, and who runs the rest.
$(VENV)/.ready-%: pyproject.toml scripts/environment.sh
	@PYTHON=$(PYTHON) VENV=$(VENV) scripts/environment.sh $*

gl:
	@PYTHON=$(BIN)/python scripts/gl_libraries.sh

browser:
	@scripts/browser.sh
	@scripts/firefox.sh
	@scripts/axe.sh

display:
	@scripts/display.sh

proxy:
	@VENV=$(VENV) scripts/proxy.sh

shaders:
	@scripts/shader_tools.sh

clean:
	rm -rf $(VENV) $(DEMO) dist build .pytest_cache .mypy_cache .ruff_cache .hypothesis .failed
