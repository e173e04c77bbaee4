# `make` alone lists the targets. Each sets up what it needs: a .venv from the pinned constraints.
PYTHON ?= python3
BIN := .venv/bin
KINDS := behavior body arbiter architecture world scenario project
SOURCES := spec_schema compiler verifier runtime lcs specc tests

.PHONY: help demo test check format bless study study-verify study-book study-arbiters study-exclusion study-agents study-senses study-world study-paradigms study-errand study-learned study-principles study-lcs bench bench-train bench-large schema gallery clean
.DEFAULT_GOAL := help

help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  make \1\t/' | expand -t 22

.venv/ready: pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	@touch $@

demo: .venv/ready ## set up, then verify a real robot's drive and draw a phase portrait
	mkdir -p out
	$(BIN)/specc portrait specs/van_der_pol.yaml -o out/van_der_pol.svg
	$(BIN)/specc verify specs/recordings/husky/husky.mcap -o out/husky.html

test: .venv/ready ## set up, then run the tests
	$(BIN)/pytest -n auto

check: .venv/ready ## format, lint, types, import contracts, tests
	$(BIN)/ruff format --check $(SOURCES)
	$(BIN)/ruff check $(SOURCES)
	$(BIN)/mypy
	$(BIN)/mypy tests/typing/api.py
	$(BIN)/lint-imports
	$(BIN)/pytest -n auto

format: .venv/ready ## format the code and sort the imports
	$(BIN)/ruff format $(SOURCES)
	$(BIN)/ruff check --fix $(SOURCES)

bless: .venv/ready ## rewrite the golden files from what comes out; read the diff
	$(BIN)/pytest -q --bless

schema: .venv/ready ## rewrite the JSON Schemas in docs/schema
	for kind in $(KINDS); do $(BIN)/specc schema $$kind > docs/schema/$$kind.schema.json; done

gallery: .venv/ready ## draw docs/img and docs/gallery.md
	$(BIN)/python docs/draw_gallery.py

study: study-verify ## error rates, which departures the diagnosis names, refitted gains
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.diagnosis 4
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.gains 30

study-verify: .venv/ready ## error rates of the verdict: 24,000 recordings with planted departures
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.verdicts
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.scores

study-book: .venv/ready ## each behavior of an architecture sabotaged in turn: does the book's verification name it?
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.sabotage

study-principles: .venv/ready ## the thesis's principles with figures, and an hour under artificial load
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.principles

study-world: .venv/ready study-senses ## pushing, speed and hours of the simulated world, beside what was measured before
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.speed
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.physics

study-agents: .venv/ready ## the thesis's two agents with a bumper: 8 worlds, an hour each
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.agents

study-exclusion: .venv/ready ## the law of exclusion: 3,000 random architectures, proved or refuted, in the scheduler
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.exclusion

study-arbiters: .venv/ready ## error rates of the verdict on arbiters: 12,000 logs
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.arbiters

study-senses: .venv/ready ## how fast rays, light meters and maps of light are
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.senses

study-paradigms: .venv/ready ## three tasks by three paradigms of the same behaviors, beside chance
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.paradigms light --first 1120 --worlds 50
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.paradigms patrol --first 1070 --worlds 50
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.paradigms tidy --first 1040 --worlds 50

study-errand: .venv/ready ## the errand in 100 held-out worlds: by rules, and by chance
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.errand

study-learned: .venv/ready ## the errand by arbiters that ALCSR and XCSR learn, five seeds each (hours)
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.learned_errand

study-lcs: .venv/ready ## ALCSR beside section 4.4 of the thesis, and in each of its readings
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs experiments
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs figures
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs readings
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs nearest
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs idle
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs beyond --at-once 1
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs switches
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs numbers
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs.xcsr
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs.classifier
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs.scitos
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs.steps
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.study.lcs.twenty --until 20000

bench: .venv/ready ## table lookup, the decoding of logs and learning beside their peers, in one run
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[bench]'
	$(BIN)/python tests/bench/lookup.py
	$(BIN)/python tests/bench/decode.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.bench.lcs --seeds 1

bench-train: .venv/ready ## how fast an arbiter is trained, beside the world alone, and which part takes what
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.bench.training

bench-large: .venv/ready ## memory and time on a log of 2 GB, which is made in out/
	$(BIN)/python tests/study/large_log.py

clean: ## remove what the targets made
	rm -rf .venv out .pytest_cache .mypy_cache .ruff_cache .hypothesis
