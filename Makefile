# libstickslip.  Targets: all check check-all paper install uninstall clean; see README.md.
PREFIX  ?= /usr/local
CFLAGS  ?= -O2 -g
BUILD   ?= build$(if $(SAN),-san)
VERSION := $(shell sed -n 's/^.define SS_VERSION "\(.*\)"/\1/p' include/stickslip/status.h)
SOVERSION = 0

PKG_CONFIG ?= pkg-config
HDF5    := $(firstword $(foreach p,hdf5-serial hdf5,$(shell $(PKG_CONFIG) --exists $p 2>/dev/null && echo $p)))
PC       = gsl $(HDF5)
SANFLAGS = -fsanitize=address,undefined -fno-sanitize-recover=all   # any report fails the test
ALL_CFLAGS = -std=c11 -D_XOPEN_SOURCE=700 -Wall -Wextra -Wpedantic -Wshadow -Iinclude -Isrc \
	-fPIC $(shell $(PKG_CONFIG) --cflags $(PC)) $(CFLAGS) $(if $(SAN),$(SANFLAGS))
ALL_LDFLAGS = $(if $(SAN),$(SANFLAGS)) $(LDFLAGS)
LIBS     = $(shell $(PKG_CONFIG) --libs-only-L $(PC)) -lhdf5_hl $(shell $(PKG_CONFIG) --libs $(PC)) -lm

LIB_SRC := $(wildcard src/*.c src/*/*.c)
LIB_OBJ := $(LIB_SRC:%.c=$(BUILD)/%.o) $(BUILD)/scenes.o
TOOLS   := $(patsubst tools/%.c,%,$(wildcard tools/ss-*.c))
TESTS   := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c))
STATIC  := $(BUILD)/libstickslip.a
SHARED  := $(BUILD)/libstickslip.so.$(VERSION)

all: $(STATIC) $(SHARED) $(TOOLS:%=$(BUILD)/bin/%)

$(BUILD)/%.o: %.c Makefile
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/scenes.c: data/embed.sh $(wildcard data/scenes/*.scene)
	@mkdir -p $(@D)
	sh data/embed.sh data/scenes/*.scene > $@.new && mv $@.new $@

$(BUILD)/scenes.o: $(BUILD)/scenes.c
	$(CC) $(ALL_CFLAGS) -c -o $@ $<

$(STATIC): $(LIB_OBJ)
	rm -f $@ && $(AR) rcs $@ $^

$(SHARED): $(LIB_OBJ)
	$(CC) -shared -Wl,-soname,libstickslip.so.$(SOVERSION) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)
	ln -sf $(@F) $(BUILD)/libstickslip.so.$(SOVERSION)
	ln -sf $(@F) $(BUILD)/libstickslip.so

$(BUILD)/bin/ss-%: $(BUILD)/tools/ss-%.o $(BUILD)/tools/common.o $(STATIC)
	@mkdir -p $(@D)
	$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)

$(BUILD)/tests/test_%: $(BUILD)/tests/test_%.o $(STATIC)
	$(CC) $(ALL_LDFLAGS) -o $@ $^ -lcmocka $(LIBS)

check: all $(TESTS:%=$(BUILD)/tests/%)
	@for t in $(TESTS); do $(BUILD)/tests/$$t || exit 1; done

clean:
	rm -rf build build-san

.PHONY: all check clean
.SECONDARY:
-include $(LIB_OBJ:.o=.d) $(TOOLS:%=$(BUILD)/tools/%.d) $(BUILD)/tools/common.d $(TESTS:%=$(BUILD)/tests/%.d)
