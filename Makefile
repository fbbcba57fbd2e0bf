# ssdo-filter. `make demo` and `make check` are all a newcomer needs; `make help` lists the rest.
VERSION  := $(shell sh tests/version.sh)
PREFIX   ?= /usr/local
DESTDIR  ?=
BINDIR   := $(PREFIX)/bin
LIBDIR   := $(PREFIX)/lib/ssdo-filter
MANDIR   := $(PREFIX)/share/man/man1
BASHDIR  := $(PREFIX)/share/bash-completion/completions
ZSHDIR   := $(PREFIX)/share/zsh/vendor-completions
DOCDIR   := $(PREFIX)/share/doc/ssdo-filter
INCDIR   := $(PREFIX)/include
SODIR    := $(PREFIX)/lib
PCDIR    := $(SODIR)/pkgconfig
SANITIZE ?=
BUILD    ?= build$(if $(SANITIZE),/$(subst $(comma),-,$(SANITIZE)))# each sanitizer has a folder of its own
JOBS      = $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc)) # of the inner make, when the user gave none; make adds -j to MAKEFLAGS late
Q        := $(if $(V),,@)# make V=1 shows the commands
ifeq ($(origin CC),default)
CC       := gcc
endif

# Debian packages (tests/deps.sh): what the build needs, what `make check` needs on top.
DEPS_BUILD := gcc g++ pkg-config libopenexr-dev libopenimageio-dev libopencolorio-dev libembree-dev libegl-dev libegl-mesa0 libgl1-mesa-dri \
              libepoxy-dev libdeflate-dev libjson-c-dev libxxhash-dev
DEPS_CHECK := patchelf libcmocka-dev glslang-tools openimageio-tools openexr clang-format blender man-db parallel python3 python3-numpy
DEPS_BENCH := gnuplot-nox
DEPS_HOSTS := blender openimageio-tools openexr imagemagick libmagickcore-6.q16-6-extra/libmagickcore-6.q16-7-extra/libmagickcore-7.q16-10-extra
DEPS_FARM  := blender slurm-wlm munge parallel python3-yaml openimageio-tools

PKGS       := OpenEXR epoxy egl libdeflate json-c
# Looked up only when something is compiled, so that `make deps` works on a machine that has none of it.
PKG_CFLAGS  = $(shell pkg-config --cflags $(PKGS) | sed 's/-I/-isystem /g')
# Headers and libraries come from the same place: pkg-config names both, and a library outside the system's folders is found there at
# run time too. OpenEXR's C++ libraries, which the program does not use, are not linked.
RPATHS      = $(patsubst -L%,-Wl$(comma)-rpath$(comma)%,$(shell pkg-config --libs-only-L $(1)))
comma      := ,
LIBS        = -Wl,--as-needed $(shell pkg-config --libs $(PKGS)) $(call RPATHS,$(PKGS)) -lpthread -ldl -lm
PKG_LIBS    = $(SANOBJ) $(LIBS)
# Embree has no pkg-config file; the header that src/plugin/embree.h finds tells the version.
EMBREE      = -lembree$(shell echo RTC_VERSION_MAJOR | $(CXX) $(CXXFLAGS) -include src/plugin/embree.h -E -P -x c++ - | tail -1)

SANFLAGS := $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer)
SANOBJ   := $(if $(SANITIZE),$(BUILD)/tests/sanitize/options.o)# how the sanitizers behave
# Integer constants are named by enums here, which clang 19 finds odd beside floats.
WARN     := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wno-enum-float-conversion
CFLAGS   ?= -O2 -g
# No contraction of a*b+c and no fast-math: results must be the same bytes on every machine of the same architecture.
ALL_CFLAGS = -std=c17 -D_GNU_SOURCE -DSSDO_LIBDIR='"$(LIBDIR)"' -Isrc -Itests/lib -I$(BUILD) $(PKG_CFLAGS) $(WARN) \
             $(CFLAGS) -ffp-contract=off -fPIC -fvisibility=hidden $(SANFLAGS) $(EXTRA_CFLAGS)
CXXFLAGS ?= -O2 -g
ALL_CXXFLAGS = -std=c++17 -fPIC -fvisibility=hidden -Isrc $(CXXFLAGS) -Wall -Wextra -Wpedantic $(SANFLAGS)

SRC      := $(filter-out src/main.c,$(wildcard src/*/*.c))
OBJ      := $(SRC:%.c=$(BUILD)/%.o) $(BUILD)/shaders.o $(BUILD)/methods.o $(BUILD)/decides.o
SHADERS  := $(wildcard shaders/*.comp)
GLSL     := $(SHADERS) $(wildcard shaders/include/*.glsl shaders/params/*.glsl)
# What decides pixels, beside the settings and the inputs: a change of it makes --skip-existing make frames again.
DECIDES  := $(sort $(GLSL) $(wildcard src/exr/*.[ch] src/gbuffer/*.[ch] src/light/*.[ch] src/passes/*.[ch] src/plugin/*_shim.cpp) \
              src/base/half.c src/base/half.h src/base/sort.c src/base/vec.h src/base/words.c src/base/words.h src/gpu/program.c \
              $(foreach f,filter frame job layers output output_names output_view plan prepare read read_back relight result settings steps views,src/pipeline/$(f).c src/pipeline/$(f).h))
BIN      := $(BUILD)/ssdo-filter
# The library, src/ssdo.h: the rooms as one object that shows nothing but ssdo_*.
SONAME   := libssdo.so.$(shell sed -n 's/^.define SSDO_INTERFACE //p' src/ssdo.h)
LIBRARY_FILES := $(BUILD)/lib/$(SONAME) $(BUILD)/lib/libssdo.so $(BUILD)/lib/libssdo.a
PLUGIN   := $(BUILD)/ssdo-dwa.so $(BUILD)/ssdo-images.so $(BUILD)/ssdo-colour.so $(BUILD)/ssdo-trace.so
UNIT     := $(patsubst tests/unit/%.c,$(BUILD)/tests/%,$(wildcard tests/unit/test_*.c))
REPLAY   := $(patsubst tests/fuzz/%.c,$(BUILD)/tests/%,$(wildcard tests/fuzz/fuzz_*.c))
TESTLIB  := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/lib/*.c))
HARD     := $(patsubst tests/hard/%.c,$(BUILD)/tests/%,$(wildcard tests/hard/hard_*.c))

.SECONDARY: # keep test objects
.PHONY: all deps deps-check deps-bench demo check lint format clean install uninstall help
all: $(BIN) $(PLUGIN) $(LIBRARY_FILES)

help:
	@echo 'make demo     install what is missing, build, filter a sample, make a contact sheet'
	@echo 'make check    install what is missing, build, run all tests (make check T=arc: those whose name holds arc)'
	@echo 'make check-fast    the build without a warning and the tests that take a moment'
	@echo 'make check-farm    a sequence by Slurm, Open Job Description and GNU parallel against one command'
	@echo 'make check-hosts   our output in Blender, oiiotool, exrmultipart and ImageMagick'
	@echo 'make check-hard    the hard cases, all of them; check-threads: the batch under the thread sanitizer'
	@echo 'make check-wild DIR=folder   a folder of EXR files: read how, fit, time, exit, verdict'
	@echo 'make check SANITIZE=address,undefined   all tests under the sanitizers; check-valgrind: a frame under valgrind'
	@echo 'make fuzz FUZZ_SECONDS=60   random files and frame ranges, by libFuzzer; fuzz-all MINUTES=60: all that is read'
	@echo 'make gpu-bundle   one archive for a machine with a GPU and nothing of ours: tests, layers beside ours, times'
	@echo 'make bench    error against time of every method (bench-unseen: on scenes rendered afresh)'
	@echo 'make bench-error   --error: its estimate, and its time beside fixed budgets'
	@echo 'make bench-paper   cost of ssdo'\''s light and bounce beside the paper, of s3ho beside hemisphere'
	@echo 'make bench-sampling   error by the sequence that slices, steps and sectors draw from, and by the spacing of steps'
	@echo 'make bench-motion  noise over a shot and on flat patches (bench-motion-readme: into tests/bench/RESULTS.md)'
	@echo 'make bench-shot    what pops in a rendered shot that a curtain leaves, without and with --surround shot'
	@echo 'make bench-flat    what is left of the noise on flat patches of the samples (bench-flat-readme: into tests/bench/RESULTS.md)'
	@echo 'make bench-front OLD=program   error against the cost of a whole job, beside an older program'
	@echo 'make bench-frame   cost of a whole frame beside copying its file (bench-frame-readme: into tests/bench/RESULTS.md)'
	@echo 'make dist     an archive that runs where it is unpacked; make check-dist: in fresh Debian roots, as root'
	@echo 'make dist-oldest OPENEXR=folder IMATH=folder   the same built in Debian 11, from sources of OpenEXR 3 and Imath, as root'
	@echo 'make deb      Debian packages of the committed source: ssdo-filter, libssdo0, libssdo-dev'
	@echo 'make check-systems SYSTEMS="bookworm trixie noble"   both commands of README in fresh roots, as root; an hour'
	@echo 'make check-compilers COMPILERS="gcc-14 clang-19"   the tree by each of them, without a warning'
	@echo 'make check-openexr VERSIONS="folder ..."   tests against other versions of OpenEXR, and which reads which compression'
	@echo 'make all | lint | format | install PREFIX= DESTDIR= | uninstall | clean'

$(BIN): $(BUILD)/src/main.o $(BUILD)/rooms.a
	@echo "  link $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)

$(BUILD)/rooms.a: $(OBJ) | $(SANOBJ)
	@rm -f $@
	@ar rcsD $@ $^

$(BUILD)/lib/$(SONAME): $(OBJ)
	@mkdir -p $(@D)
	@echo "  link $@"
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -shared -Wl,-soname,$(SONAME) $(if $(SANITIZE),,-Wl$(comma)-z$(comma)defs) -o $@ $^ $(LIBS)
$(BUILD)/lib/libssdo.so: $(BUILD)/lib/$(SONAME)
	@ln -sf $(SONAME) $@
$(BUILD)/lib/libssdo.a: $(OBJ)
	@mkdir -p $(@D) && rm -f $@
	@ld -r -o $(@D)/ssdo.o $^ && objcopy --localize-hidden $(@D)/ssdo.o && ar rcsD $@ $(@D)/ssdo.o && rm $(@D)/ssdo.o

# A compiler's warnings stay in a file beside what it made, so that one build serves the program, the tests and `make lint`.
KEEP_WARNINGS = 2>$@.warnings; code=$$?; cat $@.warnings >&2; exit $$code
NO_WARNINGS = ! find $(BUILD)/src $(BUILD)/tests $(BUILD)/*.warnings -name '*.warnings' -size +0 -exec cat {} + 2>/dev/null | grep .

# Objects are made again when the compiler or its flags change.
FLAGS     = $(CC) -fPIC $(CFLAGS) $(SANFLAGS) $(EXTRA_CFLAGS)
$(BUILD)/flags: always
	@mkdir -p $(@D) && { [ "$$(cat $@ 2>/dev/null)" = '$(subst ','\'',$(FLAGS))' ] || echo '$(subst ','\'',$(FLAGS))' >$@; }

$(BUILD)/%.o: %.c $(BUILD)/flags | deps-stamp
	@mkdir -p $(@D)
	@echo "  cc   $<"
	$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $< $(KEEP_WARNINGS)

# What names the version is compiled again when it changes, and nothing else is.
VERSIONED := $(patsubst %.c,$(BUILD)/%.o,$(shell grep -l SSDO_VERSION src/*.c src/*/*.c))
$(VERSIONED): ALL_CFLAGS += -DSSDO_VERSION='"$(VERSION)"'
$(VERSIONED): $(BUILD)/version
$(BUILD)/version: always
	@mkdir -p $(@D) && { [ "$$(cat $@ 2>/dev/null)" = '$(VERSION)' ] || echo '$(VERSION)' >$@; }
.PHONY: always

# Shaders travel inside the binary; SSDO_SHADER_DIR reads them from a folder instead.
$(BUILD)/shaders.c: $(GLSL) shaders/embed.sh
	@mkdir -p $(@D)
	$(Q)sh shaders/embed.sh shaders $(GLSL) >$@.tmp && mv $@.tmp $@
$(BUILD)/shaders.o: $(BUILD)/shaders.c src/gpu/shaders.h $(BUILD)/flags
	$(Q)$(CC) $(ALL_CFLAGS) -c -o $@ $< $(KEEP_WARNINGS)

# The rows of all methods, of which the default one is named here.
METHODS  := $(wildcard src/passes/*.c)
$(BUILD)/methods.c: $(METHODS) src/passes/methods.sh
	@mkdir -p $(@D)
	$(Q)LC_ALL=C sh src/passes/methods.sh arc $(sort $(METHODS)) >$@.tmp && mv $@.tmp $@
$(BUILD)/methods.o: $(BUILD)/methods.c src/passes/method.h
	$(Q)$(CC) $(ALL_CFLAGS) -c -o $@ $< $(KEEP_WARNINGS)

$(BUILD)/decides.c: $(DECIDES) src/pipeline/decides.sh Makefile
	@mkdir -p $(@D)
	$(Q)LC_ALL=C sh src/pipeline/decides.sh $(DECIDES) >$@.tmp && mv $@.tmp $@
$(BUILD)/decides.o: $(BUILD)/decides.c src/pipeline/decides.h $(BUILD)/flags
	$(Q)$(CC) $(ALL_CFLAGS) -c -o $@ $< $(KEEP_WARNINGS)

# The C++ libraries live in modules of their own, opened on demand: linking OpenImageIO costs every run 290 ms.
$(BUILD)/ssdo-dwa.so: LIBRARY = -Wl,--as-needed $$(pkg-config --cflags --libs OpenEXR | sed 's/-I/-isystem /g') $(call RPATHS,OpenEXR)
$(BUILD)/ssdo-images.so: LIBRARY = $$(pkg-config --cflags --libs OpenImageIO) $(call RPATHS,OpenImageIO)
$(BUILD)/ssdo-colour.so: LIBRARY = $$(pkg-config --cflags --libs OpenColorIO) $(call RPATHS,OpenColorIO)
$(BUILD)/ssdo-trace.so: LIBRARY = $(EMBREE)
$(BUILD)/ssdo-trace.so: src/plugin/embree.h
$(BUILD)/ssdo-%.so: src/plugin/%_shim.cpp src/plugin/%_abi.h | deps-stamp
	@mkdir -p $(@D)
	@echo "  c++  $@"
	$(Q)$(CXX) $(ALL_CXXFLAGS) -shared -o $@ $< $(LIBRARY) $(LDFLAGS) $(KEEP_WARNINGS)

$(BUILD)/tests/%: $(BUILD)/tests/unit/%.o $(TESTLIB) $(BUILD)/rooms.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ -lcmocka $(PKG_LIBS)

$(BUILD)/tests/hard_%: $(BUILD)/tests/hard/hard_%.o $(BUILD)/tests/hard/hard.o $(TESTLIB) $(BUILD)/rooms.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ -lcmocka $(PKG_LIBS)

$(BUILD)/tests/fuzz_%: $(BUILD)/tests/fuzz/fuzz_%.o $(BUILD)/tests/fuzz/replay.o $(BUILD)/rooms.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)

# What makes system calls fail, for tests/hard/table.sh; never sanitized, for it is loaded before everything else. Every function in it
# comes from dlsym, whose object pointer ISO C does not convert.
FAULT    := $(BUILD)/tests/fault.so
$(FAULT): tests/hard/fault.c
	@mkdir -p $(@D)
	$(Q)$(CC) -std=gnu17 -D_GNU_SOURCE $(WARN) -Wno-pedantic -O1 -g -shared -fPIC -o $@ $< -ldl $(KEEP_WARNINGS)

# Order-only: checks once per make run that the packages of the build are there.
.PHONY: deps-stamp
deps-stamp: ; @sh tests/deps.sh --quiet $(DEPS_BUILD)
deps:       ; @sh tests/deps.sh $(DEPS_BUILD)
deps-check: ; @sh tests/deps.sh $(DEPS_BUILD) $(DEPS_CHECK)
deps-bench: ; @sh tests/deps.sh $(DEPS_BUILD) $(DEPS_CHECK) $(DEPS_BENCH)

demo: deps
	@$(MAKE) $(JOBS) --no-print-directory all
	@sh samples/demo.sh $(BIN) $(BUILD)

# The lint is one of the tests, so that it fills what the others leave idle.
check: deps-check
	@$(MAKE) $(JOBS) --no-print-directory all unit
	@SANFLAGS='$(SANFLAGS)' sh tests/run.sh $(BUILD) tests/lint.sh $(UNIT) $(HARD) $(REPLAY)

# The build without a warning and the unit tests that take a moment: tests/fast.txt.
FAST     := $(addprefix $(BUILD)/tests/,$(shell grep -v '^\#' tests/fast.txt))
.PHONY: check-fast
check-fast: deps-check
	@$(MAKE) $(JOBS) --no-print-directory all $(FAST)
	@$(NO_WARNINGS)
	@SSDO_SCRIPTS= sh tests/run.sh $(BUILD) $(FAST)

# The hard cases, all of them (tests/hard): `make check` runs a subset.
.PHONY: unit hard check-hard
check-hard: deps-check
	@$(MAKE) $(JOBS) --no-print-directory all hard
	@SSDO_HARD=whole SSDO_SCRIPTS='tests/hard/*.sh' sh tests/run.sh $(BUILD) $(HARD)
hard: $(HARD) $(FAULT)

# A folder of anybody's EXR files: make check-wild DIR=folder [WILD='--fov 45'] (tests/wild/check.py).
.PHONY: check-wild
check-wild:
	@sh tests/deps.sh $(DEPS_BUILD) python3
	@$(MAKE) $(JOBS) --no-print-directory all
	@[ -n "$(DIR)" ] || { echo "make check-wild DIR=folder: which folder of EXR files?" >&2; exit 2; }
	@python3 tests/wild/check.py $(BIN) "$(DIR)" $(WILD)

# The measured tables of the hard cases: tests/hard/RESULTS.md.
.PHONY: hard-tables
hard-tables: all hard
	@rm -rf $(BUILD)/tables && mkdir -p $(BUILD)/tables
	@for t in $(HARD); do SSDO_TABLES=$(BUILD)/tables $$t >/dev/null 2>&1 || echo "failed: $$t"; done
	@SSDO_HARD=whole SSDO_TABLES=$(BUILD)/tables SSDO=$(abspath $(BIN)) sh tests/hard/table.sh
	@cat tests/hard/results-head.md $(BUILD)/tables/*.md >tests/hard/RESULTS.md

# The batch path under the thread sanitizer.
.PHONY: check-threads
check-threads: deps-check
	@$(MAKE) $(JOBS) --no-print-directory BUILD=$(BUILD)/tsan SANITIZE=thread all
	@sh tests/sanitize/threads.sh $(BUILD)/tsan

# One frame under valgrind.
.PHONY: check-valgrind
check-valgrind: deps-check
	@sh tests/deps.sh valgrind
	@$(MAKE) $(JOBS) --no-print-directory all
	@sh tests/sanitize/valgrind.sh $(BUILD)

# Random input to the readers, by libFuzzer (tests/fuzz): make fuzz FUZZ_SECONDS=3600; to everything that reads: fuzz-all MINUTES=60.
FUZZ_SECONDS ?= 60
MINUTES  ?= 60
.PHONY: fuzz fuzz-all
fuzz-all: deps
	@sh tests/deps.sh clang libclang-rt-dev openimageio-tools python3
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/tests/make_corpus
	@$(MAKE) $(JOBS) --no-print-directory BUILD=$(BUILD)/asan SANITIZE=address,undefined all
	@sh tests/fuzz/run.sh $(BUILD) $$((60 * $(MINUTES))) exr mesh json args attributes frames program
fuzz: deps
	@sh tests/deps.sh clang libclang-rt-dev/libclang-rt-14-dev openimageio-tools
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/tests/make_corpus
	@sh tests/fuzz/run.sh $(BUILD) $(FUZZ_SECONDS)
$(BUILD)/tests/make_corpus: $(BUILD)/tests/fuzz/make_corpus.o $(TESTLIB) $(BUILD)/rooms.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)
# What is tried on a machine with a GPU (tests/gpu): one archive that needs nothing there but a driver.
GPU_TOOLS := $(BUILD)/tests/gpu/compare $(BUILD)/tests/bench/make_input
$(BUILD)/tests/gpu/%: $(BUILD)/tests/gpu/%.o $(BUILD)/rooms.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)
.PHONY: gpu-bundle
gpu-bundle: deps-check
	@$(MAKE) $(JOBS) --no-print-directory all unit
	@sh tests/gpu/make.sh $(BUILD)

# The archive in bare Debian roots with Mesa's driver.
.PHONY: check-gpu-bundle
check-gpu-bundle: gpu-bundle
	@sh tests/deps.sh debootstrap
	@sh tests/gpu/check.sh $(BUILD)/gpu-bundle.tar.xz bookworm trixie

LISTS     := $(BUILD)/tests/list_variants
$(LISTS): $(BUILD)/tests/limits/list_variants.o $(BUILD)/rooms.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)
# The benches are compiled, so that they still do.
unit: $(UNIT) $(HARD) $(REPLAY) $(FAULT) $(LISTS) $(GPU_TOOLS) $(BUILD)/tests/bench/motion $(BUILD)/tests/bench/score $(BUILD)/tests/bench/follow $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/bench/*.c))

# Real schedulers on this machine (tests/farm/check.sh); what it starts, it stops.
.PHONY: check-farm
check-farm:
	@sh tests/deps.sh $(DEPS_BUILD) $(DEPS_FARM)
	@$(MAKE) $(JOBS) --no-print-directory all
	@sh tests/farm/check.sh $(BUILD)

# Our output in the programs it is for (tests/hosts/check.sh).
.PHONY: check-hosts
check-hosts:
	@sh tests/deps.sh $(DEPS_BUILD) $(DEPS_HOSTS)
	@$(MAKE) $(JOBS) --no-print-directory all
	@sh tests/hosts/check.sh $(BUILD)

# Error against time of every method (tests/bench/bench.h): a table, a plot, all figures as CSV, in $(BUILD)/bench.
BENCH     := bench cache embree generated middle plot references rows run scenes summary table yardstick
BENCH_OBJ := $(BENCH:%=$(BUILD)/tests/bench/%.o)
UNSEEN    ?= 101# the variant of the scenes that bench-unseen renders
UNSEEN_SPP ?= 48
# Renders and references, kept outside the tree: they survive `make clean`, and every clone shares them.
BENCH_CACHE ?= $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/ssdo-bench
$(BUILD)/bench-program: $(BENCH_OBJ) $(TESTLIB) $(BUILD)/rooms.a
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(EMBREE) $(PKG_LIBS)

# What ssdo's light and bounce cost over its occlusion, beside the paper's figures; s3ho over hemisphere.
$(BUILD)/bench-paper: $(filter-out %/bench.o,$(BENCH_OBJ)) $(BUILD)/tests/bench/paper.o $(TESTLIB) $(BUILD)/rooms.a
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(EMBREE) $(PKG_LIBS)
# The errors of arc's budgets, for bench-frame.
$(BUILD)/bench-curve: $(filter-out %/bench.o,$(BENCH_OBJ)) $(BUILD)/tests/bench/curve.o $(TESTLIB) $(BUILD)/rooms.a
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(EMBREE) $(PKG_LIBS)
# Sequences and step spacings that `arc` could draw from.
$(BUILD)/bench-sequences: $(filter-out %/bench.o,$(BENCH_OBJ)) $(BUILD)/tests/bench/sequences.o $(TESTLIB) $(BUILD)/rooms.a
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(EMBREE) $(PKG_LIBS)
# The rendered samples of the folder SAMPLES, with SEEDS seeds.
SAMPLES  ?= samples
SEEDS    ?= 3
.PHONY: bench-sampling
bench-sampling: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/bench-sequences
	@sh tests/bench/sequences.sh $(BUILD) $(SAMPLES) $(SEEDS) $(WORD)

# --error: its estimate, and its time beside fixed budgets.
$(BUILD)/bench-error: $(filter-out %/bench.o,$(BENCH_OBJ)) $(BUILD)/tests/bench/error.o $(TESTLIB) $(BUILD)/rooms.a
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(EMBREE) $(PKG_LIBS)
.PHONY: bench-error
bench-error: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/bench-error
	@mkdir -p $(BUILD)/bench
	@$(BUILD)/bench-error $(SAMPLES) | tee $(BUILD)/bench/error.md
.PHONY: bench-error-readme
bench-error-readme:
	@sh tests/bench/paste.sh $(BUILD)/bench/error.md bench-error tests/bench/RESULTS.md
.PHONY: bench-paper
bench-paper: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/bench-paper
	@$(BUILD)/bench-paper

.PHONY: bench bench-unseen bench-readme mutate truth
bench: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/bench-program
	@sh tests/bench/meshes.sh $(BENCH_CACHE)/meshes 0
	@$(BUILD)/bench-program --out $(BUILD)/bench --cache $(BENCH_CACHE)/references --meshes $(BENCH_CACHE)/meshes

# Scenes that nothing was tuned on: rendered once for each UNSEEN.
bench-unseen: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/bench-program
	@$(MAKE) --no-print-directory $(BENCH_CACHE)/unseen/$(UNSEEN)/rendered
	@sh tests/bench/meshes.sh $(BENCH_CACHE)/unseen/$(UNSEEN) $(UNSEEN)
	@$(BUILD)/bench-program --rendered-only --samples $(BENCH_CACHE)/unseen/$(UNSEEN) --out $(BUILD)/bench-unseen \
	    --meshes $(BENCH_CACHE)/unseen/$(UNSEEN) --cache $(BENCH_CACHE)/references --title 'Bench of unseen scenes, variant $(UNSEEN)' --command 'make bench-unseen UNSEEN=$(UNSEEN)'

$(BENCH_CACHE)/unseen/%/rendered:
	@mkdir -p $(@D)
	blender -b --factory-startup -P samples/render.py -- --all --out $(@D) --variant $* --size 480x270 --spp $(UNSEEN_SPP) >$(@D)/log
	@touch $@

# Places whose light comes from where the frame does not look: the committed scenes of samples/covered, and with COVERED_ALL=1 all
# six kinds, rendered once for each UNSEEN variant (0: the committed layout). OPTIONS: of the program.
.PHONY: bench-covered
bench-covered: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory all $(BUILD)/tests/bench/score
	@$(if $(COVERED_ALL),$(MAKE) --no-print-directory $(BENCH_CACHE)/covered/$(UNSEEN)/rendered)
	@sh tests/bench/covered.sh $(BUILD) $(if $(COVERED_ALL),$(BENCH_CACHE)/covered/$(UNSEEN),samples/covered) $(BUILD)/covered $(OPTIONS)

$(BENCH_CACHE)/covered/%/rendered:
	@mkdir -p $(@D) && cp samples/sky_*.exr $(@D)
	blender -b --factory-startup -P samples/render.py -- --covered --out $(@D) --variant $* --spp $(UNSEEN_SPP) >$(@D)/log
	@touch $@

# A rendered shot that a curtain leaves, rendered once (12 minutes).
.PHONY: bench-shot
bench-shot: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory all $(BUILD)/tests/bench/follow $(BENCH_CACHE)/shot/rendered
	@sh tests/bench/shot.sh $(BUILD) $(BENCH_CACHE)/shot $(BUILD)/shot $(OPTIONS)

$(BENCH_CACHE)/shot/rendered:
	@mkdir -p $(@D)
	blender -b --factory-startup -P samples/render.py -- --scene drape --shot 8 --pan 2 --out $(@D) --size 240x135 >$(@D)/log
	@touch $@

# The tables and the plot of the last bench and bench-unseen, pasted into tests/bench/RESULTS.md.
bench-readme: ; @sh tests/bench/readme.sh $(BUILD)

# Renders the truth of SCENE again with the committed script and compares: TRUTH_SPP=384 gives the committed pixels, fewer are faster.
SCENE     ?= ortho
TRUTH_SPP ?= 384
truth: deps-check
	@$(MAKE) $(JOBS) --no-print-directory $(BUILD)/tests/bench/truth_check
	@rm -rf $(BUILD)/truth && mkdir -p $(BUILD)/truth && cp samples/sky_*.exr $(BUILD)/truth
	blender -b --factory-startup -P samples/render.py -- --scene $(SCENE) --out $(BUILD)/truth --spp $(TRUTH_SPP) >$(BUILD)/truth/log
	@$(BUILD)/tests/bench/truth_check samples $(BUILD)/truth $(TRUTH_SPP)

# What a whole frame costs beside copying its file: BUILD/bench/frame.md.
.PHONY: bench-frame
bench-frame: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory all $(BUILD)/tests/bench/make_input $(BUILD)/tests/bench/measure $(BUILD)/tests/bench/core_copy \
	    $(BUILD)/tests/bench/own_copy $(BUILD)/bench-curve
	@sh tests/bench/frame.sh $(BUILD) $(ROUNDS)

# What noise does over a shot and on flat patches: BUILD/bench/motion.md.
.PHONY: bench-motion bench-motion-readme
bench-motion: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory all $(BUILD)/tests/bench/motion
	@sh tests/bench/motion.sh $(BUILD) $(OPTIONS)
bench-motion-readme:
	@sh tests/bench/paste.sh $(BUILD)/bench/motion.md bench-motion tests/bench/RESULTS.md

# The same on the flat patches of the rendered samples: BUILD/bench/flat.md.
.PHONY: bench-flat bench-flat-readme
bench-flat: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory all $(BUILD)/tests/bench/motion $(BUILD)/tests/bench/score
	@sh tests/bench/flat.sh $(BUILD) $(OPTIONS)
bench-flat-readme:
	@sh tests/bench/paste.sh $(BUILD)/bench/flat.md bench-flat tests/bench/RESULTS.md

# Error against the time of a whole job, beside that of an older program OLD: BUILD/bench/front.md, front.png.
.PHONY: bench-front bench-front-readme
bench-front: deps-bench
	@$(MAKE) $(JOBS) --no-print-directory all $(BUILD)/tests/bench/make_input $(BUILD)/tests/bench/measure $(BUILD)/tests/bench/score
	@sh tests/bench/front.sh $(BUILD) $(OLD)
bench-front-readme:
	@sh tests/bench/paste.sh $(BUILD)/bench/front.md bench-front tests/bench/RESULTS.md
	@cp $(BUILD)/bench/front.png samples/pictures/front.png

# Puts the last bench-frame's tables into tests/bench/RESULTS.md, between the marks.
.PHONY: bench-frame-readme
bench-frame-readme:
	@sh tests/bench/paste.sh $(BUILD)/bench/frame.md bench-frame tests/bench/RESULTS.md
$(BUILD)/tests/bench/%: $(BUILD)/tests/bench/%.o $(TESTLIB) $(BUILD)/rooms.a
	$(Q)$(CC) $(SANFLAGS) $(LDFLAGS) -o $@ $^ $(PKG_LIBS)

# Which errors of 5 % in the shaders the tests see.
mutate: $(patsubst %,$(BUILD)/tests/test_%,bias convergence arc s3ho)
	@sh tests/bench/mutate.sh $(BUILD) $(WORD)

lint: deps-check
	@$(MAKE) $(JOBS) --no-print-directory all unit
	@sh tests/lint.sh $(BUILD)

.PHONY: lint-warnings lint-clang tidy
lint-warnings: ; @$(NO_WARNINGS)
# The same warnings by clang, where there is one: it reads the sources and makes nothing.
lint-clang tidy: ALL_CFLAGS += -DSSDO_VERSION='"$(VERSION)"'
lint-clang: $(BUILD)/shaders.c
	@! command -v clang >/dev/null || printf '%s\n' src/main.c $(SRC) | xargs -n 8 -P $$(nproc) clang -fsyntax-only -Werror $(ALL_CFLAGS)

# What clang-tidy has to say (.clang-tidy): to be read, not to be obeyed.
tidy: $(BUILD)/shaders.c
	@clang-tidy --quiet src/main.c $(SRC) -- $(ALL_CFLAGS)

format: ; clang-format -i $$(git ls-files 'src/*.[ch]' 'src/*.cpp' 'tests/*.[ch]')

# Completions come from the option table inside the program; shaders are inside it too.
$(BUILD)/completion.%: $(BIN)
	$(Q)$(BIN) --completion $* >$@.tmp && mv $@.tmp $@

# The manual, with its table of methods.
$(BUILD)/ssdo-filter.1: man/ssdo-filter.1 $(BUILD)/completion.methods.1
	$(Q)sed '/BEGIN METHODS/r $(BUILD)/completion.methods.1' $< >$@

# Everything where Debian's policy puts it (below PREFIX). FARM: the templates to start from.
FARM     := samples/farm/slurm.sh samples/farm/openjd.yaml
install: all $(BUILD)/completion.bash $(BUILD)/completion.zsh $(BUILD)/ssdo-filter.1
	install -d $(addprefix $(DESTDIR),$(BINDIR) $(LIBDIR) $(MANDIR) $(BASHDIR) $(ZSHDIR) $(DOCDIR)/examples $(INCDIR) $(PCDIR))
	install -m 755 $(BIN) $(DESTDIR)$(BINDIR)/ssdo-filter
	install -m 644 $(PLUGIN) $(DESTDIR)$(LIBDIR)
	install -m 644 $(BUILD)/ssdo-filter.1 $(DESTDIR)$(MANDIR)/ssdo-filter.1
	install -m 644 $(BUILD)/completion.bash $(DESTDIR)$(BASHDIR)/ssdo-filter
	install -m 644 $(BUILD)/completion.zsh $(DESTDIR)$(ZSHDIR)/_ssdo-filter
	install -m 644 $(BUILD)/lib/$(SONAME) $(BUILD)/lib/libssdo.a $(DESTDIR)$(SODIR)
	ln -sf $(SONAME) $(DESTDIR)$(SODIR)/libssdo.so
	install -m 644 src/ssdo.h $(DESTDIR)$(INCDIR)
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(SODIR:$(PREFIX)/%=$${prefix}/%)|' -e 's|@VERSION@|$(VERSION)|' -e 's|@PACKAGES@|$(PKGS)|' src/library/ssdo.pc.in >$(DESTDIR)$(PCDIR)/ssdo.pc
	install -m 644 README.md $(DESTDIR)$(DOCDIR)
	install -m 644 $(FARM) $(DESTDIR)$(DOCDIR)/examples

# What install put there, and the folders that nobody else uses.
uninstall:
	rm -f $(addprefix $(DESTDIR),$(BINDIR)/ssdo-filter $(PLUGIN:$(BUILD)/%=$(LIBDIR)/%) $(MANDIR)/ssdo-filter.1 $(BASHDIR)/ssdo-filter \
	    $(ZSHDIR)/_ssdo-filter $(DOCDIR)/README.md $(FARM:samples/farm/%=$(DOCDIR)/examples/%) \
	    $(SODIR)/$(SONAME) $(SODIR)/libssdo.so $(SODIR)/libssdo.a $(INCDIR)/ssdo.h $(PCDIR)/ssdo.pc)
	-rmdir $(DESTDIR)$(LIBDIR) $(DESTDIR)$(DOCDIR)/examples $(DESTDIR)$(DOCDIR)

# Program, modules and the libraries they need in one archive (tests/dist/make.sh).
DEPS_DIST := patchelf xz-utils binutils
SYSTEMS   ?= bookworm trixie
.PHONY: dist dist-oldest check-dist check-systems check-openexr
dist:
	@sh tests/deps.sh $(DEPS_BUILD) $(DEPS_DIST)
	@$(MAKE) $(JOBS) --no-print-directory all
	@sh tests/dist/make.sh $(BUILD) $(VERSION)
# The same in a fresh Debian 11, for systems as old as that: make dist-oldest OPENEXR=folder IMATH=folder, of sources.
dist-oldest:
	@sh tests/deps.sh debootstrap openimageio-tools
	@sh tests/dist/oldest.sh $(VERSION) "$(OPENEXR)" "$(IMATH)"
check-dist:
	@sh tests/deps.sh debootstrap openimageio-tools
	@sh tests/dist/check.sh $(or $(ARCHIVE),$(BUILD)/ssdo-filter-$(VERSION)-linux-$(shell uname -m).tar.xz) $(SYSTEMS)
check-systems:
	@sh tests/deps.sh debootstrap
	@sh tests/systems/check.sh $(SYSTEMS)
# The tree by other compilers, all of which are there: without a warning.
.PHONY: check-compilers
check-compilers: deps-check
	@sh tests/systems/compilers.sh $(COMPILERS)
check-openexr: deps-check
	@sh tests/deps.sh cmake
	@sh tests/systems/openexr.sh $(VERSIONS)

# Debian packages of the committed source (tests/deb/make.sh).
DEPS_DEB  := debhelper dpkg-dev lintian
.PHONY: deb
deb:
	@sh tests/deps.sh $(DEPS_BUILD) $(DEPS_DEB)
	@mkdir -p $(BUILD)
	@sh tests/deb/make.sh $(BUILD) $(VERSION)

clean: ; rm -rf $(BUILD) demo

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
