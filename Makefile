# Two commands do all the set-up: `make demo` and `make test`. Both reuse .venv once it is there.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: demo test validate test-peers bench bench-gear bench-million bench-peers bench-see bench-water gallery format clean

demo: $(VENV)/.installed
	@echo "== running examples/panel.toml (the first run compiles, about 20 s)"
	@$(BIN)/fyke run examples/panel.toml -o examples/panel --overwrite

test: $(VENV)/.installed-test
	@echo "== formatter" && $(BIN)/ruff format --check .
	@echo "== linter" && $(BIN)/ruff check .
	@echo "== types" && $(BIN)/mypy
	@echo "== import layers" && $(BIN)/lint-imports
	@echo "== tests" && $(BIN)/python -m pytest

validate: $(VENV)/.installed-test
	@$(BIN)/fyke validate

test-peers: $(VENV)/.installed-peers
	@$(BIN)/python -m pytest -m peers -rs

bench: $(VENV)/.installed-test
	@$(BIN)/python benchmarks/run.py

bench-million: $(VENV)/.installed-test
	@$(BIN)/python benchmarks/million.py

bench-peers: $(VENV)/.installed-peers
	@$(BIN)/python benchmarks/peers.py

bench-see: $(VENV)/.installed-test
	@$(BIN)/python benchmarks/see.py

bench-gear: $(VENV)/.installed-test
	@$(BIN)/python benchmarks/gear.py

bench-water: $(VENV)/.installed-test
	@$(BIN)/python benchmarks/water.py

gallery: $(VENV)/.installed-test
	@$(BIN)/python docs/gallery.py

format: $(VENV)/.installed-test
	@$(BIN)/ruff format . && $(BIN)/ruff check --fix .

clean:
	rm -rf $(VENV) .pytest_cache .mypy_cache .ruff_cache .hypothesis

$(VENV)/bin/python:
	@echo "== making $(VENV)"
	@$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: $(VENV)/bin/python pyproject.toml
	@echo "== installing fyke and what it needs into $(VENV) (a minute on the first call)"
	@$(BIN)/python -m pip install --disable-pip-version-check --quiet --progress-bar on -e .
	@touch $@

$(VENV)/.installed-test: $(VENV)/bin/python pyproject.toml
	@echo "== installing fyke and its test tools into $(VENV) (some minutes on the first call)"
	@$(BIN)/python -m pip install --disable-pip-version-check --quiet --progress-bar on -e ".[test,view,vtk,movie,notebook]"
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-peers: $(VENV)/.installed-test
	@echo "== installing the tools to compare with into $(VENV) (a minute on the first call)"
	@$(BIN)/python -m pip install --disable-pip-version-check --quiet --progress-bar on -e ".[peers]" && touch $@ \
	  || echo "== not all could be installed; the table says which are missing"
