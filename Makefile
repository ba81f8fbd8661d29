# libstickslip.
#
#   make                    libraries and tools, under build/
#   make check              all tests; installs first what is missing for them
#                           (ONLY='test_store cli/features/rows': these alone)
#   make check-all          these, the long ones, with sanitizers, with gcc and clang, and bench-errors
#   make bench              error and cost, measured here, simulation against CVODE and SciPy too;
#                           fails if an error exceeds its bound
#   make lint               gcc -fanalyzer, clang-tidy, cppcheck, shellcheck, mandoc: silent
#   make coverage           the share of src/ that the tests run
#   make fuzz               every reader on made-up input for FUZZ_SECONDS=60 each; needs clang
#   make paper              the paper's figures, under build/paper; installs first what is missing
#                           (MEASURED=FILE COLUMN=NAME FROM=S TO=S: figure 7 from a recording)
#   make maps               maps of periodic states, under build/maps
#   make check-cluster      sweeps by GNU parallel over ssh and by Slurm, on this machine, for real
#   make install uninstall  PREFIX=/usr/local DESTDIR=
#   make site               the manual as HTML, under build/site; needs mandoc
#   make dist               libstickslip-VERSION.tar.gz of what is committed, under build/
#   make version NEW=1.1.0  writes another version wherever it stands (CONTRIBUTING.md: A release)
#   make deps               install what all of this needs; INSTALL_DEPS=0: say what is missing only
#   make clean
#
# SAN=1 builds and checks with sanitizers in a tree of its own.  CC, AR, CPPFLAGS, CFLAGS, LDFLAGS
# and BUILD are honoured; flags that changed rebuild what they concern.  Written for GNU make 3.81.
PREFIX     ?= /usr/local
BINDIR     ?= $(PREFIX)/bin
LIBDIR     ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
SCENEDIR   ?= $(PREFIX)/share/stickslip/scenes
EXAMPLEDIR ?= $(PREFIX)/share/doc/stickslip/examples
MANDIR     ?= $(PREFIX)/share/man
BASHDIR    ?= $(PREFIX)/share/bash-completion/completions
ZSHDIR     ?= $(PREFIX)/share/zsh/site-functions
CFLAGS     ?= -O2 -g
BUILD      ?= build$(if $(SAN),-san)
INSTALL    ?= install
PKG_CONFIG ?= pkg-config
PYTHON     ?= python3

VERSION   := $(shell sed -n 's/^.define SS_VERSION "\(.*\)"/\1/p' include/stickslip/status.h)
SOVERSION := 1

# --- flags -----------------------------------------------------------------------------------
# HDF5 has no pkg-config file where it was built with autotools (Fedora, older Homebrew): there it
# lies in the compiler's own directories, or in Homebrew's.
pc        = $(shell $(PKG_CONFIG) --$1 $2 2>/dev/null)
HDF5_PC  := $(firstword $(foreach p,hdf5-serial hdf5,$(if $(call pc,modversion,$p),$p)))
HOMEBREW := $(if $(HDF5_PC),,$(shell brew --prefix 2>/dev/null))
INCLUDES := $(call pc,cflags,gsl) $(call pc,cflags,fftw3) $(call pc,cflags,$(HDF5_PC)) \
	$(HOMEBREW:%=-I%/include)
NUMERICS := $(call pc,libs,gsl) $(call pc,libs,fftw3) -lpthread -lm
LIBS     := $(call pc,libs-only-L,$(HDF5_PC)) $(HOMEBREW:%=-L%/lib) -lhdf5_hl -lhdf5 $(NUMERICS)
CMOCKA_INCLUDES := $(call pc,cflags,cmocka)
CMOCKA_LIBS     := $(or $(call pc,libs,cmocka),-lcmocka)

ifneq ($(SAN),)
SANFLAGS := -fsanitize=address -fsanitize=undefined -fno-sanitize-recover=all # any report fails
endif
# What stops an overrun that is left, where compiler and linker have it: asked once, of both, and not
# where sanitizers look closer.  FORTIFY needs optimisation, and some compilers define it themselves.
HARDEN_CFLAGS  := -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 -fstack-protector-strong
HARDEN_LDFLAGS := -Wl,-z,relro,-z,now
ifneq ($(SANFLAGS)$(filter -O0,$(CFLAGS) $(CPPFLAGS)),)
HARDEN_CFLAGS  :=
HARDEN_LDFLAGS :=
else ifneq ($(shell echo 'int main(void) { return 0; }' | $(CC) -O2 -Werror $(HARDEN_CFLAGS) $(HARDEN_LDFLAGS) \
	-x c -o /dev/null - 2>&1 || echo failed),)
HARDEN_CFLAGS  :=
HARDEN_LDFLAGS :=
endif
# No path of the build tree stays in what is built, where the compiler can leave it out.
PREFIX_MAP := -ffile-prefix-map=$(CURDIR)=.
ifneq ($(shell $(CC) -Werror $(PREFIX_MAP) -x c -fsyntax-only /dev/null 2>&1 || echo failed),)
PREFIX_MAP :=
endif
ALL_CFLAGS := -std=c11 -D_XOPEN_SOURCE=700 -fno-math-errno -Wall -Wextra -Wpedantic -Wshadow -Iinclude -Isrc \
	$(INCLUDES) -fPIC -fvisibility=hidden $(HARDEN_CFLAGS) $(PREFIX_MAP) $(SANFLAGS) $(CPPFLAGS) $(CFLAGS)
ALL_LDFLAGS := $(HARDEN_LDFLAGS) $(SANFLAGS) $(LDFLAGS)
COMPILE     = $(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@

# --- what is built ---------------------------------------------------------------------------
# Sorted: GNU make 3.82 to 4.2 give names as they lie in the directory.
LIB_SRC := $(sort $(wildcard src/*.c src/*/*.c src/*/*/*.c))
LIB_OBJ := $(LIB_SRC:%.c=$(BUILD)/%.o) $(BUILD)/scenes.o
PAPER   := $(sort $(wildcard data/scenes/*.scene))
PUBLISHED := $(sort $(wildcard data/catalogue/*.scene))
SCENES  := $(PAPER) $(PUBLISHED)
HEADERS := $(sort $(wildcard include/stickslip/*.h))
EXAMPLES := $(sort $(wildcard tests/examples/*.c))
# stickslip(3) has the text of the headers.
MANUAL  := $(filter-out man/stickslip.3,$(sort $(wildcard man/*.[1-9]))) $(BUILD)/stickslip.3
TOOLS   := $(patsubst tools/%.c,%,$(sort $(wildcard tools/ss-*.c)))
SCRIPTS := $(patsubst tools/%.sh,%,$(sort $(wildcard tools/ss-*.sh)))
TESTS   := $(patsubst tests/%.c,%,$(sort $(wildcard tests/test_*.c)))
BENCHES := $(patsubst tests/%.c,%,$(sort $(wildcard tests/bench/bench_*.c)))
FUZZERS := $(patsubst tests/%.c,%,$(sort $(wildcard tests/fuzz/fuzz_*.c)))
REPLAYS := $(FUZZERS:fuzz/fuzz_%=fuzz/replay_%)
TOOL_PARTS := common files input jobs options output reading
TOOL_OBJ := $(TOOL_PARTS:%=$(BUILD)/tools/%.o)

STATIC  := $(BUILD)/libstickslip.a
ifeq ($(shell uname),Darwin)
SHARED  := libstickslip.$(SOVERSION).dylib
LINKS   := libstickslip.dylib
SOFLAGS  = -dynamiclib -install_name $(LIBDIR)/$(SHARED) -current_version $(VERSION)
TOOL_LIBS = $(LIBS)
else
SHARED  := libstickslip.so.$(VERSION)
LINKS   := libstickslip.so.$(SOVERSION) libstickslip.so
SOFLAGS  = -shared -Wl,-soname,libstickslip.so.$(SOVERSION) -Wl,--version-script=$(EXPORTS)
EXPORTS := $(BUILD)/stickslip.map
# HDF5 comes with the shared library, which tools open when a file needs it (tools/hdf5.c): in the
# build tree, or where it is installed, before any other that is found.
TOOL_OBJ += $(BUILD)/tools/hdf5.o
libdir   := $(LIBDIR)
TOOL_LIBS = $(NUMERICS) -ldl
endif
OBJECTS := $(LIB_OBJ) $(TOOL_OBJ) $(TOOLS:%=$(BUILD)/tools/%.o) \
	$(TESTS:%=$(BUILD)/tests/%.o) $(BENCHES:%=$(BUILD)/tests/%.o) $(BUILD)/tests/oracle.o $(BUILD)/tests/clock.o $(BUILD)/tests/rig.o $(BUILD)/tests/decay.o \
	$(BUILD)/tests/random_scene.o \
	$(FUZZERS:%=$(BUILD)/tests/%.o) $(BUILD)/tests/fuzz/common.o $(BUILD)/tests/fuzz/replay.o

all: $(STATIC) $(BUILD)/$(SHARED) $(BUILD)/stickslip.3 $(TOOLS:%=$(BUILD)/bin/%) $(SCRIPTS:%=$(BUILD)/bin/%)

$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(COMPILE) $<

$(BUILD)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(COMPILE) $(CMOCKA_INCLUDES) $<

$(BUILD)/scenes.o: $(BUILD)/scenes.c
	$(COMPILE) $<

$(BUILD)/scenes.c: data/embed.sh $(SCENES)
	@mkdir -p $(@D)
	sh data/embed.sh ss_shipped_scenes $(PAPER) -- ss_catalogue_scenes $(PUBLISHED) > $@.new && mv $@.new $@

$(BUILD)/tools/hdf5.o: ALL_CFLAGS += -DLIBDIR=$(call quote,"$(LIBDIR)")
$(BUILD)/tools/hdf5.o: $(BUILD)/libdir

$(BUILD)/src/base/number.o: ALL_CFLAGS += -I$(BUILD)
$(BUILD)/src/base/number.o: $(BUILD)/number_pow10.h

$(BUILD)/number_pow10.h: data/number_pow10.sh
	@mkdir -p $(@D)
	sh data/number_pow10.sh > $@.new && mv $@.new $@

$(BUILD)/stickslip.map: data/version_script.sh include/stickslip.h $(HEADERS)
	@mkdir -p $(@D)
	sh data/version_script.sh include/stickslip.h $(CC) -Iinclude > $@.new && mv $@.new $@

$(BUILD)/stickslip.3: data/manual_headers.sh man/stickslip.3 $(HEADERS)
	@mkdir -p $(@D)
	sh data/manual_headers.sh man/stickslip.3 $(HEADERS) > $@.new && mv $@.new $@

$(STATIC): $(LIB_OBJ)
	rm -f $@ && $(AR) rcs $@ $^

$(BUILD)/$(SHARED): $(LIB_OBJ) $(EXPORTS)
	$(CC) $(SOFLAGS) $(ALL_LDFLAGS) -o $@ $(filter %.o,$^) $(LIBS)
	cd $(@D) && for l in $(LINKS); do ln -sf $(@F) $$l; done

$(BUILD)/bin/%: $(BUILD)/tools/%.o $(TOOL_OBJ) $(STATIC) | $(BUILD)/$(SHARED)
	@mkdir -p $(@D)
	$(CC) $(ALL_LDFLAGS) -o $@ $^ $(TOOL_LIBS)

# A script has the style of its pages within.
$(BUILD)/bin/%: tools/%.sh data/report.css include/stickslip/status.h
	@mkdir -p $(@D)
	sed -e 's/@VERSION@/$(VERSION)/' -e '/^@CSS@$$/{' -e 'r data/report.css' -e d -e '}' $< > $@.new && \
		chmod 755 $@.new && mv $@.new $@

$(BUILD)/tests/%: $(BUILD)/tests/%.o $(STATIC)
	$(CC) $(ALL_LDFLAGS) -o $@ $(filter %.o,$^) $(STATIC) $(CMOCKA_LIBS) $(LIBS)

# The library's allocations in this test go through it, and what it asks GSL for.  Only the linkers of ELF have that.
OF_GSL := vector matrix interp rng qrng multimin_fminimizer multilarge_nlinear multifit_linear \
    odeiv2_step eigen_nonsymm integration_fixed
WRAPPED := malloc calloc realloc free strdup strndup open_memstream fftw_malloc fftw_free \
    $(foreach of,$(OF_GSL),gsl_$(of)_alloc gsl_$(of)_free) H5Fclose
$(BUILD)/tests/test_memory: ALL_LDFLAGS += $(WRAPPED:%=-Wl,--wrap=%)

$(BUILD)/tests/test_sim $(BUILD)/tests/test_sim_truth $(BUILD)/tests/test_taylor $(BUILD)/tests/test_trade \
	$(BUILD)/tests/test_rigs $(BUILD)/tests/test_chaos: $(BUILD)/tests/oracle.o
$(BUILD)/tests/test_random $(BUILD)/tests/test_rigs $(BUILD)/tests/test_taylor $(BUILD)/tests/test_laws $(BUILD)/tests/test_trade \
	$(BUILD)/tests/proof/prove_events: $(BUILD)/tests/random_scene.o
$(BUILD)/tests/test_trade: $(BUILD)/tests/clock.o
$(BUILD)/tests/test_rig $(BUILD)/tests/test_transitions: $(BUILD)/tests/rig.o
$(BUILD)/tests/test_backbone: $(BUILD)/tests/decay.o

# The harness of a reader: with libFuzzer, and over files that are named.
$(BUILD)/tests/fuzz/fuzz_%: $(BUILD)/tests/fuzz/fuzz_%.o $(BUILD)/tests/fuzz/common.o $(STATIC)
	$(CC) -fsanitize=fuzzer $(ALL_LDFLAGS) -o $@ $^ $(LIBS)

$(BUILD)/tests/fuzz/replay_%: $(BUILD)/tests/fuzz/fuzz_%.o $(BUILD)/tests/fuzz/common.o \
		$(BUILD)/tests/fuzz/replay.o $(STATIC)
	$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)

# Objects are made again when the Makefile or the flags change, and not before the packages that
# they need are there.
$(OBJECTS): Makefile $(BUILD)/flags | needs

quote = '$(subst ','\'',$1)'
flags := $(CC) $(ALL_CFLAGS) : $(ALL_LDFLAGS) $(LIBS)
$(BUILD)/flags $(BUILD)/libdir: $(BUILD)/%: always
	@mkdir -p $(@D)
	@printf '%s\n' $(call quote,$($*)) | cmp -s - $@ || \
		printf '%s\n' $(call quote,$($*)) > $@

# --- what it needs ---------------------------------------------------------------------------
# The packages are looked for when make starts, so what comes after an installation is done by a
# second make.
DEPS = CC=$(call quote,$(CC)) PKG_CONFIG=$(call quote,$(PKG_CONFIG)) INSTALL_DEPS=$(INSTALL_DEPS) \
	sh tools/install-deps.sh

needs:
	@$(DEPS) --report build

deps:
	@$(DEPS) build check paper

check:
	@$(DEPS) build check
	@$(MAKE) --no-print-directory run-tests

check-all:
	@$(DEPS) build check
	@$(MAKE) --no-print-directory run-tests LONG=1
	@$(MAKE) --no-print-directory run-tests SAN=1 BUILD=$(BUILD)-san
	@for cc in gcc clang; do \
		if command -v $$cc > /dev/null; then \
			$(MAKE) --no-print-directory run-tests CC=$$cc BUILD=$(BUILD)-$$cc || exit 1; \
		fi; \
	done
	@$(MAKE) --no-print-directory bench-errors

bench-errors: $(BENCHES:%=$(BUILD)/tests/%)
	@failed=0; for b in $^; do $$b || failed=1; done; exit $$failed

# Objects instrumented for libFuzzer are a tree of their own.
FUZZ_SECONDS ?= 60
FUZZ_CC      ?= clang
FUZZ_FLAGS   := -fsanitize=fuzzer-no-link -fsanitize=address -fsanitize=undefined -fno-sanitize-recover=all
fuzz:
	@$(MAKE) --no-print-directory fuzzers CC=$(FUZZ_CC) SANFLAGS='$(FUZZ_FLAGS)' CFLAGS='-O1 -g' \
		BUILD=$(BUILD)-fuzz
	@FUZZ_SECONDS=$(FUZZ_SECONDS) BUILD=$(BUILD)-fuzz sh tests/fuzz/run.sh $(FUZZERS)

fuzzers: $(FUZZERS:%=$(BUILD)/tests/%)

lint: $(BUILD)/number_pow10.h
	@CC=gcc FLAGS=$(call quote,-std=c11 -D_XOPEN_SOURCE=700 -Iinclude -Isrc -I$(BUILD) $(INCLUDES)) sh tests/lint.sh

# Lines of src/ that the tests run, with gcc's gcov; what they do not is in $(BUILD)-coverage/report.
coverage:
	-@GCOV_ERROR_FILE=/dev/null $(MAKE) --no-print-directory run-tests BUILD=$(BUILD)-coverage CC=gcc \
		CFLAGS='-O1 -g --coverage -include $(CURDIR)/tests/coverage.h' LDFLAGS=--coverage
	@BUILD=$(BUILD)-coverage sh tests/coverage.sh

paper:
	@$(DEPS) build paper
	@$(MAKE) --no-print-directory draw-paper

# make -n runs lines that name MAKE, so the tests get it by another name.
THIS_MAKE = $(MAKE)
run-tests: all $(TESTS:%=$(BUILD)/tests/%) $(REPLAYS:%=$(BUILD)/tests/%)
	@CC=$(call quote,$(CC)) CCLD=$(call quote,$(CC) $(SANFLAGS) $(CFLAGS) $(LDFLAGS)) \
		MAKE=$(call quote,$(THIS_MAKE)) BUILD=$(call quote,$(BUILD)) SAN=$(SAN) LONG=$(LONG) \
		ONLY=$(call quote,$(ONLY)) TOOL_PARTS='$(TOOL_PARTS)' \
		LIBS=$(call quote,$(LIBS)) INCLUDES=$(call quote,$(INCLUDES)) sh tests/run.sh $(TESTS)

draw-paper: all
	@PATH="$$(cd $(BUILD)/bin && pwd):$$PATH" OUT=$(BUILD)/paper MEASURED=$(call quote,$(MEASURED)) \
		COLUMN=$(call quote,$(COLUMN)) sh tools/paper.sh

maps:
	@$(DEPS) build paper
	@$(MAKE) --no-print-directory draw-maps

draw-maps: all
	@PATH="$$(cd $(BUILD)/bin && pwd):$$PATH" OUT=$(BUILD)/maps sh tools/maps.sh

site: $(BUILD)/stickslip.3
	@OUT=$(BUILD)/site VERSION=$(VERSION) sh tools/site.sh $(MANUAL)

check-cluster: all
	@PATH="$$(cd $(BUILD)/bin && pwd):$$PATH" sh tests/cluster/run.sh

bench: all
	@CCLD=$(call quote,$(CC) $(ALL_CFLAGS) $(ALL_LDFLAGS)) LIBS=$(call quote,$(LIBS)) \
		BUILD=$(call quote,$(BUILD)) PYTHON=$(call quote,$(PYTHON)) sh tests/bench/run.sh
	@! command -v $(PYTHON) > /dev/null || \
		$(PYTHON) tests/bench/compare_morlet.py $(BUILD)/$(SHARED)
	@$(MAKE) --no-print-directory bench-errors

# --- install ---------------------------------------------------------------------------------
# DESTDIR may have blanks; PREFIX may not, tools have it within.
to     = $(call quote,$(DESTDIR)$($1))
remove = ! cd $(call to,$1) 2> /dev/null || rm -f $2

# An archive does not name what it needs: these may be what HDF5's does, where they are there.
archives = for l in -lsz -laec -lz -lcrypto -ldl -lm; do \
	echo 'int main(void) { return 0; }' | $(CC) -x c -o /dev/null - $$l 2> /dev/null && printf ' %s' $$l; done

install: all
	$(INSTALL) -d $(call to,BINDIR) $(call to,LIBDIR)/pkgconfig $(call to,SCENEDIR) $(call to,EXAMPLEDIR) \
		$(call to,INCLUDEDIR)/stickslip
	$(INSTALL) -m 644 include/stickslip.h $(call to,INCLUDEDIR)
	$(INSTALL) -m 644 $(HEADERS) $(call to,INCLUDEDIR)/stickslip
	$(INSTALL) -m 644 $(STATIC) $(call to,LIBDIR)
	$(INSTALL) -m 755 $(BUILD)/$(SHARED) $(call to,LIBDIR)
	cd $(call to,LIBDIR) && for l in $(LINKS); do ln -sf $(SHARED) $$l; done
	sed -e 's|@LIBDIR@|$(LIBDIR)|' -e 's|@INCLUDEDIR@|$(INCLUDEDIR)|' -e 's|@VERSION@|$(VERSION)|' \
		-e "s|@LIBS@|$(LIBS)$$($(archives))|" stickslip.pc.in > $(call to,LIBDIR)/pkgconfig/stickslip.pc
	$(INSTALL) -m 644 $(SCENES) $(call to,SCENEDIR)
	$(INSTALL) -m 644 $(EXAMPLES) $(call to,EXAMPLEDIR)
	for t in $(TOOLS) $(SCRIPTS); do $(INSTALL) -m 755 $(BUILD)/bin/$$t $(call to,BINDIR) || exit 1; done
	for m in $(MANUAL); do d=$(call to,MANDIR)/man$${m##*.}; \
		$(INSTALL) -d "$$d" && $(INSTALL) -m 644 $$m "$$d" || exit 1; done
	$(INSTALL) -d $(call to,BASHDIR) $(call to,ZSHDIR)
	for t in $(TOOLS) $(SCRIPTS); do $(INSTALL) -m 644 data/completion/stickslip.bash $(call to,BASHDIR)/$$t || \
		exit 1; done
	$(INSTALL) -m 644 data/completion/_stickslip $(call to,ZSHDIR)

# Directories that only we use go too.
uninstall:
	$(call remove,LIBDIR,$(notdir $(STATIC)) $(SHARED) $(LINKS) pkgconfig/stickslip.pc)
	$(call remove,INCLUDEDIR,stickslip.h $(HEADERS:include/%=%))
	$(call remove,SCENEDIR,$(notdir $(SCENES)))
	$(call remove,EXAMPLEDIR,$(notdir $(EXAMPLES)))
	$(call remove,BINDIR,$(TOOLS) $(SCRIPTS))
	$(call remove,BASHDIR,$(TOOLS) $(SCRIPTS))
	$(call remove,ZSHDIR,_stickslip)
	$(call remove,MANDIR,$(foreach m,$(MANUAL),man$(subst .,,$(suffix $m))/$(notdir $m)))
	for d in $(call to,INCLUDEDIR)/stickslip $(call to,SCENEDIR) $(call to,PREFIX)/share/stickslip \
		$(call to,EXAMPLEDIR) $(call to,PREFIX)/share/doc/stickslip; do \
		rmdir "$$d" 2> /dev/null || :; done

# The same commit gives the same bytes.
dist:
	@mkdir -p $(BUILD)
	git archive --prefix=libstickslip-$(VERSION)/ HEAD | gzip -n9 > $(BUILD)/libstickslip-$(VERSION).tar.gz

# Every place that names the version, but for changelogs and symbols, which keep the version that first had them.
VERSIONED := include/stickslip/status.h CITATION.cff $(wildcard tools/packaging/*)
version:
	for f in $(VERSIONED); do sed 's/$(subst .,[.],$(VERSION))/$(NEW)/g' $$f > version.new && cat version.new > $$f || exit 1; done
	rm version.new

clean:
	rm -rf $(BUILD) build build-*

.PHONY: all always bench bench-errors check check-all check-cluster clean coverage deps dist \
	draw-maps draw-paper fuzz fuzzers install lint maps needs paper run-tests site uninstall version
.SECONDARY:
-include $(OBJECTS:.o=.d)
