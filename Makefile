# The front door. Every target checks what it needs first, skips what is done, and may be run again.
.DEFAULT_GOAL := help
.PHONY: help demo build install uninstall package test fuzz hostile sanitize bench results extremes robustness reliability soak clean dependencies-build dependencies-test dependencies-bench dependencies-package

PRESET ?= release
WITH ?=
export PRESET WITH
export DESTDIR
BIN := build/$(PRESET)/bin
PREFIX ?= /usr/local

help:
	@echo "make demo    two bars collide, one process each; result table and a page that shows them"
	@echo "make build   the two programs, in $(BIN)"
	@echo "make install PREFIX=/usr/local   programs, tools, man pages, completion, scenes; DESTDIR as usual"
	@echo "make uninstall PREFIX=/usr/local   removes what make install has put there"
	@echo "make package  Debian packages, in build/$(PRESET)/packages"
	@echo "make test    every test"
	@echo "make fuzz SECONDS=600   random scenes of new seeds; what fails is told (docs/ROBUSTNESS.md)"
	@echo "make hostile SECONDS=60   bytes that mean harm, for every reader of files and messages (clang)"
	@echo "make sanitize  the tests with sanitizers of addresses, undefined behaviour and threads (hours)"
	@echo "make bench   the measured figures"
	@echo "make results   docs/RESULTS.md, measured anew (minutes)"
	@echo "make extremes  docs/EXTREMES.md, measured anew"
	@echo "make robustness  the tables of docs/ROBUSTNESS.md, measured anew (minutes)"
	@echo "make reliability KILLS=200  docs/RELIABILITY.md: runs killed at random moments and resumed"
	@echo "make soak EXCHANGES=1000000 WINDOWS=1000000   long runs: memory, open files, rest (an hour)"
	@echo "make clean   removes build/ (runs/ is yours and stays)"
	@echo "Optional libraries are used when they are named: make build WITH=\"cholmod exodus\""
	@echo "Missing Debian packages are installed first, with sudo when you are not root."

dependencies-build:
	@sh scripts/install_dependencies.sh build $(WITH)
dependencies-test:
	@sh scripts/install_dependencies.sh build test $(WITH)
dependencies-bench:
	@sh scripts/install_dependencies.sh build bench $(WITH)

build: dependencies-build
	@sh scripts/build.sh programs

# realpath and not abspath: a PREFIX may contain blanks.
install: build
	@prefix=$$(realpath -m -- "$(PREFIX)") && \
	  cmake --install build/$(PRESET) --prefix "$$prefix" >build/$(PRESET)/install.log && \
	  echo "installed in $(DESTDIR)$$prefix"

uninstall:
	@prefix=$$(realpath -m -- "$(PREFIX)") && \
	  cmake -Dprefix="$$prefix" -P packaging/uninstall.cmake

package: build
	@sh scripts/install_dependencies.sh package
	@rm -f build/$(PRESET)/packages/*.deb
	@cd build/$(PRESET) && cpack >package.log || { cat package.log; exit 1; }
	@ls build/$(PRESET)/packages/*.deb

demo: dependencies-build
	@sh scripts/build.sh demo
	$(BIN)/abut run configs/two_bars.yaml --out runs/two_bars --force --set output.fields.every=1
	@$(BIN)/abut report runs/two_bars >/dev/null
	@echo "page   file://$(CURDIR)/runs/two_bars/report.html"

# One more at once than there are processors: some tests wait most of their time.
test: dependencies-test
	@sh scripts/build.sh tests
	ctest --preset $(PRESET) --parallel $$(($$(nproc) + 1)) $(TESTS)

SECONDS ?= 600
fuzz: dependencies-test
	@sh scripts/build.sh tests
	$(BIN)/abut_fuzz --quiet --table --keep runs/fuzz --seconds $(SECONDS) $$(date +%s)

# Its own preset, by clang, whatever PRESET says.
hostile:
	@sh scripts/install_dependencies.sh build hostile
	@[ -f build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
	@cmake --build build/fuzz --target hostile
	@sh tests/fuzz/run.sh build/fuzz/bin $(SECONDS)

# Their own presets, whatever PRESET says. By threads, what has threads.
sanitize: dependencies-test
	@PRESET=asan sh scripts/build.sh tests
	ctest --preset asan --parallel 2 $(TESTS)
	@[ -f build/tsan/build.ninja ] || cmake --preset tsan >/dev/null
	@cmake --build --preset tsan
	ctest --preset tsan

bench: dependencies-bench
	@sh scripts/build.sh bench
	@sh bench/run.sh $(BIN)

results extremes: build
	/usr/bin/python3 scripts/study_documents.py $(BIN) $@

robustness: dependencies-test
	@sh scripts/build.sh tests
	/usr/bin/python3 scripts/robustness_document.py $(BIN)

KILLS ?= 200
reliability: build
	/usr/bin/python3 bench/reliability.py $(BIN) $(KILLS) >build/RELIABILITY.md; code=$$?; \
	  echo >>build/RELIABILITY.md; sed -n '/^## Under sanitizers/,$$p' docs/RELIABILITY.md >>build/RELIABILITY.md; \
	  mv build/RELIABILITY.md docs/; exit $$code

EXCHANGES ?= 1000000
WINDOWS ?= 1000000
soak: build
	/usr/bin/python3 bench/soak.py $(BIN) $(EXCHANGES) $(WINDOWS)

clean:
	rm -rf build
