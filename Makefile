# make run      start the walk viewer          make test    every test (CHROMIUM=skip: without a browser)
# make setup    .venv and nothing else         make bench   performance and accuracy     make soak   the long runs
# make demo     recordings/ and assets/ anew   make lock    requirements.txt anew
BIN := .venv/bin

# Tests run three at a time: many only wait. make test WORKERS=0 runs them one by one
WORKERS := 3

# make soak PARTS=network   only the parts whose titles have that word
.PHONY: run mover setup test chromium bench soak demo lock

run: setup
	@$(BIN)/stridescope walk

mover: setup
	@$(BIN)/stridescope mover

setup:
	@tools/setup.sh

chromium: setup
	@tools/chromium.sh

test: chromium
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/python tools/warm.py & $(BIN)/mypy app tests tools $(wildcard benchmarks) && wait
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal

bench: setup
	@$(BIN)/python benchmarks/bench.py

soak: setup
	@$(BIN)/python benchmarks/soak.py $(PARTS)

demo: setup
	$(BIN)/python tools/make_recordings.py
	$(BIN)/python tools/make_shoe.py
	$(BIN)/python tools/make_town.py

# requirements.txt is all; requirements-run.txt the part of it that the program needs without its tests
LOCK := $(BIN)/uv pip compile --quiet --universal --generate-hashes --no-emit-index-url \
	--custom-compile-command "make lock" pyproject.toml --extra install

lock: setup
	$(BIN)/python -m pip --disable-pip-version-check install --quiet "uv>=0.5,<1"
	$(LOCK) --upgrade --extra dev --output-file requirements.txt
	$(LOCK) --constraint requirements.txt --no-annotate --output-file requirements-run.txt
