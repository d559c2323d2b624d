# The front door. `make run` solves the paper's mixed-regime problem and draws it; `make test` checks everything.
SHELL  := /bin/bash
PYTHON ?= /usr/bin/python3
CORES  := $(shell nproc)
APSIS  := build/release/app/apsis
export CMAKE_CXX_COMPILER_LAUNCHER ?= $(shell command -v ccache)
export CTEST_PARALLEL_LEVEL ?= $(CORES)

FORMATTED = $(shell find src app tests bench examples python -name '*.[ch]pp' 2>/dev/null)

.DEFAULT_GOAL := help
.PHONY: help run reproduce study program figures test test-all test-slow clang asan tsan bench packages format format-check tidy docs docs-links clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-13s %s\n", $$1, $$2 }' Makefile

run: program ## packages, program, the mixed-regime problem by both methods and the reference, pictures
	$(APSIS) run paper/bgk-mixed --out results/bgk-mixed
	$(APSIS) run paper/bgk-mixed time.method=md-imex-3-2 --out results/bgk-mixed-second-order
	$(APSIS) run paper/bgk-mixed-reference --out results/bgk-mixed-reference
	$(MAKE) --no-print-directory figures

reproduce: program ## every claim of the paper checked, its figures redrawn: results/reproduce/report.html
	$(APSIS) reproduce --out results/reproduce

study: program ## which methods exist and which to take: designs, work and precision (hours; goes on after an interrupt)
	$(PYTHON) studies/run.py --apsis $(APSIS) --out results/study
	$(PYTHON) studies/report.py --apsis $(APSIS) --results results/study

figures: ## the pictures again, from the results that are there
	$(APSIS) plot --compare bgk-mixed --out results "second order=results/bgk-mixed-second-order" \
	  "third order=results/bgk-mixed" "explicit reference=results/bgk-mixed-reference"
	$(APSIS) report results/bgk-mixed

program: ## the program only, in build/release/app
	@scripts/install-packages.sh run
	cmake --preset release -DAPSIS_TESTS=OFF -DAPSIS_PCH=ON >/dev/null
	cmake --build build/release --target app/apsis

test: ## packages, everything built, every test but the slow ones
	@scripts/install-packages.sh test
	cmake --preset release -DAPSIS_TESTS=ON -DAPSIS_BENCH=ON -DAPSIS_PYTHON_PACKAGE=ON -DPython3_EXECUTABLE=$(PYTHON) -DAPSIS_PCH=ON >/dev/null
	cmake --build build/release
	ctest --preset release -LE slow

test-slow:
	ctest --preset release -L slow --no-tests=ignore

test-all: test ## test, and: slow tests, clang, sanitizers, clang-tidy, format
	@scripts/install-packages.sh dev
	$(MAKE) --no-print-directory test-slow format-check clang tidy asan tsan

clang: ## everything built by clang-19, without a warning
	cmake --preset clang -DAPSIS_PCH=ON >/dev/null
	cmake --build build/clang

asan: ## tests under the address and undefined-behaviour sanitizers
	cmake --preset asan -DAPSIS_PCH=ON >/dev/null
	cmake --build build/asan
	ctest --preset asan -LE slow

tsan: ## tests of the threads and of all that uses them under the thread sanitizer
	cmake --preset tsan >/dev/null
	cmake --build build/tsan --target tests/all
	ctest --preset tsan -LE slow

tidy: ## clang-tidy over the library, the program and the Python package
	cmake --preset clang -DAPSIS_PYTHON_PACKAGE=ON -DPython3_EXECUTABLE=$(PYTHON) >/dev/null
	cmake --build build/clang --target app/apsis
	run-clang-tidy-19 -quiet -p build/clang -j $(CORES) '$(CURDIR)/(src|app|python)/.*'

bench: ## speed, measured: every table of docs/speed.md, in results/bench/speed.json (half an hour, on an idle machine)
	@scripts/install-packages.sh test
	cmake --preset release -DAPSIS_BENCH=ON -DAPSIS_PCH=ON >/dev/null
	cmake --build build/release --target apsis_measure
	build/release/bench/apsis_measure --out results/bench/speed.json

packages: program ## Debian packages in build/release, installed and run in a bare Debian 12 (as root, with a network)
	@scripts/install-packages.sh dev
	cd build/release && cpack
	tests/install/on_a_bare_system.sh build/release

format: ## clang-format over all sources
	clang-format-19 -i $(FORMATTED)

format-check:
	clang-format-19 --dry-run --Werror $(FORMATTED)

docs: ## packages, program, Python package, every block of the pages run, and the site: build/docs/html/index.html
	@scripts/install-packages.sh docs
	cmake --preset release -DAPSIS_TESTS=OFF -DAPSIS_BENCH=OFF -DAPSIS_PYTHON_PACKAGE=ON -DPython3_EXECUTABLE=$(PYTHON) -DAPSIS_PCH=ON >/dev/null
	cmake --build build/release
	$(PYTHON) docs/execute.py
	$(PYTHON) docs/build.py

docs-links: docs ## and every address outside that the site names is asked for (needs a network)
	$(PYTHON) docs/links.py

clean: ## remove what was built and computed
	rm -rf build results
