# Entry points: `make run` solves the paper's mixed-regime problem and draws it; `make test` checks everything.
SHELL  := /bin/bash
PYTHON ?= /usr/bin/python3
CORES  := $(shell nproc)
APSIS  := build/release/app/apsis
export CMAKE_CXX_COMPILER_LAUNCHER ?= $(shell command -v ccache)
# One more test than processors: some wait for other processes or for time.
export CTEST_PARALLEL_LEVEL ?= $(shell echo $$(($(CORES) + 1)))
# NO_INSTALL=1 installs no Debian package: scripts/install-packages.sh then lists the missing ones and continues.
export NO_INSTALL

# For whole builds: several files are compiled as one, with precompiled headers.
WHOLE := -DAPSIS_PCH=ON -DCMAKE_UNITY_BUILD=ON

FORMATTED = $(shell find src app paper validation tests bench examples python -name '*.[ch]pp' -o -name '*.[ch]' 2>/dev/null)

.DEFAULT_GOAL := help
.PHONY: help run validate reproduce study program figures test test-all test-slow device-check clang asan tsan bench packages format format-check tidy changed docs docs-links clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-13s %s\n", $$1, $$2 }' Makefile

run: program ## install packages (NO_INSTALL=1: none), build the program, solve the paper's mixed-regime problem, draw it
	$(APSIS) run paper/bgk-mixed --out results/bgk-mixed
	$(APSIS) run paper/bgk-mixed time.method=md-imex-3-2 --out results/bgk-mixed-second-order
	$(APSIS) run paper/bgk-mixed-reference --out results/bgk-mixed-reference
	$(MAKE) --no-print-directory figures

validate: program ## compare the solver with reference values of gas flows: results/validate/report.html
	$(APSIS) validate --out results/validate

reproduce: program ## check every claim of the paper and redraw its figures: results/reproduce/report.html
	$(APSIS) reproduce --out results/reproduce

study: program ## repeat the study of methods: designs, work and precision (hours; resumes after an interrupt)
	$(PYTHON) studies/run.py --apsis $(APSIS) --out results/study
	$(PYTHON) studies/report.py --apsis $(APSIS) --results results/study

figures: ## redraw the pictures from existing results
	$(APSIS) plot --compare bgk-mixed --out results "second order=results/bgk-mixed-second-order" \
	  "third order=results/bgk-mixed" "explicit reference=results/bgk-mixed-reference"
	$(APSIS) report results/bgk-mixed

# With all libraries, since `cmake --install build/release` installs them.
program: ## install packages (NO_INSTALL=1: none), build only the program, in build/release/app
	@scripts/install-packages.sh run
	cmake --preset release -DAPSIS_TESTS=OFF $(WHOLE) >/dev/null
	cmake --build build/release --target app/apsis src/apsis/all

test: ## install packages, build all but benchmarks, run all tests except the slow ones
	@scripts/install-packages.sh test
	cmake --preset release -DAPSIS_TESTS=ON -DAPSIS_BENCH=OFF -DAPSIS_PYTHON_PACKAGE=ON -DPython3_EXECUTABLE=$(PYTHON) $(WHOLE) >/dev/null
	cmake --build build/release
	ctest --preset release -LE slow --test-output-size-passed 1000000 --output-junit $(CURDIR)/build/release/quick-tests.xml
	$(PYTHON) tests/summary.py build/release/quick-tests.xml

# Benchmarks take a tenth of the time of a whole build, so that they are built here.
test-slow:
	cmake --preset release -DAPSIS_BENCH=ON >/dev/null
	cmake --build build/release
	ctest --preset release -L slow --no-tests=ignore

test-all: test ## test, slow tests, clang, sanitizers, clang-tidy, format
	@scripts/install-packages.sh dev
	$(MAKE) --no-print-directory test-slow format-check clang tidy asan tsan

device-check: ## compare kernels, methods and runs on a graphics processor with the host, bit for bit (77: no device)
	@scripts/install-packages.sh test
	cmake --preset release -DAPSIS_TESTS=ON $(WHOLE) >/dev/null
	cmake --build build/release --target tests/test_device tests/test_device_runs
	tests/device/check.sh build/release

clang: ## build everything with clang-19 without warnings
	cmake --preset clang $(WHOLE) >/dev/null
	cmake --build build/clang

asan: ## run the tests under the address and undefined-behaviour sanitizers
	cmake --preset asan $(WHOLE) >/dev/null
	cmake --build build/asan
	ctest --preset asan -LE slow

tsan: ## run the tests of threads and of their users under the thread sanitizer
	cmake --preset tsan $(WHOLE) >/dev/null
	cmake --build build/tsan --target tests/all
	ctest --preset tsan -LE slow

# Lists of compile commands and one generated file suffice. Checks of the syntax visit every
# included header again for each file, and therefore run over a file that includes all sources of a room. Two of them do not expect
# that. The analyzer follows only functions of the file itself: it gets the text of all sources.
CONFIGURE_TIDY = cmake --preset clang -B build/tidy -DAPSIS_PYTHON_PACKAGE=ON -DPython3_EXECUTABLE=$(PYTHON) \
	  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=1000 >/dev/null && cmake --build build/tidy --target apsis_commit

tidy: ## run clang-tidy over the library, the program and the Python package
	$(CONFIGURE_TIDY)
	run-clang-tidy-19 -quiet -p build/tidy -j $(CORES) \
	  -checks='-clang-analyzer-*,-bugprone-suspicious-include,-readability-redundant-declaration' \
	  '$(CURDIR)/(build/tidy/)?(src|app|paper|validation|python)/.*[.]c(pp|xx)$$'
	scripts/join_sources.py build/tidy
	run-clang-tidy-19 -quiet -p build/tidy/joined -j $(CORES) \
	  -checks='-bugprone-*,-misc-*,-modernize-*,-performance-*,-readability-*' \
	  '$(CURDIR)/(build/tidy/joined/)?(src|app|paper|validation|python)/.*[.]cpp$$'

changed: ## clang-format, clang and clang-tidy for changed files alone (SINCE=COMMIT, UNTIL=SECONDS as date +%s)
	@scripts/install-packages.sh ci
	$(CONFIGURE_TIDY)
	scripts/check_changed.py build/tidy $(if $(SINCE),--since $(SINCE)) $(if $(UNTIL),--until $(UNTIL))

bench: ## measure every table of docs/speed.md into results/bench/speed.json (two hours, on an idle machine)
	@scripts/install-packages.sh test
	cmake --preset release -DAPSIS_BENCH=ON $(WHOLE) >/dev/null
	cmake --build build/release --target apsis_measure
	build/release/bench/apsis_measure --out results/bench/speed.json
	if command -v mpirun >/dev/null; then OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
	  mpirun -n 2 build/release/bench/apsis_measure --out results/bench/speed.json; fi

packages: program ## build Debian packages and the image, and test both in a bare Debian 12 (as root, with a network)
	@scripts/install-packages.sh dev
	cd build/release && cpack
	tests/install/on_a_bare_system.sh build/release
	tests/install/image.sh

format: ## run clang-format over all sources
	clang-format-19 -i $(FORMATTED)

format-check:
	clang-format-19 --dry-run --Werror $(FORMATTED)

docs: ## build the documentation and execute every code block: build/docs/html/index.html
	@scripts/install-packages.sh docs
	cmake --preset release -DAPSIS_TESTS=OFF -DAPSIS_BENCH=OFF -DAPSIS_PYTHON_PACKAGE=ON -DPython3_EXECUTABLE=$(PYTHON) $(WHOLE) >/dev/null
	cmake --build build/release
	$(PYTHON) docs/execute.py
	$(PYTHON) docs/build.py

docs-links: docs ## docs, and check all external links (needs a network)
	$(PYTHON) docs/links.py

clean: ## remove build and results
	rm -rf build results
