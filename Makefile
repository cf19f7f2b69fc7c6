# Every command of this project; `make help` lists them. JOBS bounds what runs at once.
JOBS ?= $(shell nproc)
# Seconds that each fuzz target gets.
FUZZ_SECONDS ?= 60
# Handed on to Google Benchmark.
ARGS ?=

# ccache, where there is one, makes the second build cheap; nothing depends on it.
launcher := $(if $(shell command -v ccache),-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
# $(call build_preset,NAME,TARGET): configures quietly and builds in build/NAME.
build_preset = mkdir -p build && \
  { cmake --preset $(1) $(launcher) >build/$(1).log 2>&1 || { cat build/$(1).log >&2; exit 1; }; } && \
  cmake --build --preset $(1) --parallel $(JOBS) --target $(2) -- --quiet && echo "built build/$(1)"
ctest := ctest --output-on-failure --no-tests=error --parallel $(JOBS)
sources = git ls-files --cached --others --exclude-standard '*.h' '*.cpp'

.DEFAULT_GOAL := build
.NOTPARALLEL:
.PHONY: build viewer play demo test test-viewer e2e check-floors check-format format fuzz asan tsan tidy bench rivals clean help

build: ## the program: build/release/bin/rhexis
	@tools/install build
	@$(call build_preset,release,rhexis)

# Node's packages, as the lock file has them.
viewer/node_modules/.package-lock.json: viewer/package-lock.json viewer/package.json
	@cd viewer && npm ci --loglevel=error && touch node_modules/.package-lock.json

page := build/release/share/rhexis/page/index.html
page_sources := $(shell find viewer schema -name node_modules -prune -o -type f -print)
$(page): viewer/node_modules/.package-lock.json $(page_sources)
	@cd viewer && npm run --silent build && touch ../$(page) && echo "built build/release/share/rhexis/page"

viewer: ## the page of play and replay, and the script of reports: build/release/share/rhexis
	@tools/install viewer
	@$(MAKE) --no-print-directory --silent $(page)

play: build viewer ## hold the plate in a browser, and tear it
	@build/release/bin/rhexis play scenes/plate-tear.toml

demo: build ## the vessel of the paper with all six models: a table, and files for ParaView in out/demo
	@tools/demo out/demo

# ctest comes last, so that its summary closes the output.
test: ## all that must hold before a change lands: floors, format, fuzzing under sanitizers, the page in Chromium, tests
	@tools/install test
	@$(MAKE) --no-print-directory check-floors check-format fuzz
	@$(call build_preset,release,all)
	@$(MAKE) --no-print-directory test-viewer e2e
	@$(ctest) --test-dir build/release

test-viewer: viewer ## the units of the page
	@cd viewer && npm test --silent

e2e: build viewer ## the page in Chromium, alone and against the program; screenshots in build/e2e
	@cd viewer && npm run --silent e2e

check-floors: ## no include climbs the floors of ARCHITECTURE.md
	@tools/check_floors

check-format: ## the sources are as clang-format leaves them
	@$(sources) | xargs clang-format-16 --dry-run --Werror && echo "format: clean"

format: ## lay out the sources with clang-format
	@$(sources) | xargs clang-format-16 -i

fuzz: ## every reader of foreign files for FUZZ_SECONDS under libFuzzer and sanitizers
	@$(call build_preset,fuzz,fuzz_programs)
	@tools/run_fuzz.sh $(FUZZ_SECONDS)

asan: ## the tests under AddressSanitizer and UndefinedBehaviorSanitizer
	@$(call build_preset,asan,all)
	@$(ctest) --test-dir build/asan

tsan: ## the tests under ThreadSanitizer
	@$(call build_preset,tsan,all)
	@TSAN_OPTIONS='suppressions=$(CURDIR)/tools/tsan.supp history_size=7' $(ctest) --test-dir build/tsan

tidy: ## clang-tidy with the naming rules over src
	@$(call build_preset,release,rhexis)
	@run-clang-tidy-16 -quiet -p build/release -j $(JOBS) '$(CURDIR)/src/' && echo "tidy: clean"

bench: ## the benchmarks; ARGS='--benchmark_filter=...' chooses
	@$(call build_preset,release,rhexis_bench)
	@build/release/bin/rhexis_bench $(ARGS)

rivals: ## bars beside Bullet and CalculiX, which it installs: tables, and out/rivals.json; ARGS=--help says what can be chosen, and that part goes to out/rivals-part.json
	@tools/install rivals
	@$(call build_preset,release,rhexis_rivals)
	@mkdir -p out && build/release/bin/rhexis_rivals --out out/rivals$(if $(ARGS),-part).json $(ARGS)

clean: ## remove what was built and made
	@rm -rf build out

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-14s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))
