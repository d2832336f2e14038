# Triptych's build: `make help` lists the targets.
#
# Sources are found, never listed: those in src/tool, src/stream and src/fuzz are the command; every other src/**/*.c,
# emu/*.c and asm/**/*.asm is the library; every tests/**/*.c outside tests/support/ and tests/fuzz/targets/ is one
# Unity program with its own main.
# Everything built goes to $(BUILD). What is fetched or linked in from the system (the Unity sources, the glmark2
# and Assimp assets) goes to build/ whatever BUILD is, because draw streams name their assets through build/glmark2.
# `make test` runs this file again for each variant: plain, clang (CC=clang), sanitize (SANITIZE=address), thread
# (SANITIZE=thread); `make matrix` and `make coverage` do for theirs.

VERSION := $(shell sed -n 's/^#define TRIPTYCH_VERSION "\(.*\)"/\1/p' src/triptych.h)
SONAME  := libtriptych.so.$(firstword $(subst ., ,$(VERSION)))

ifeq ($(origin CC),default)
CC := gcc
endif
NASM      ?= nasm
AR        ?= ar
PREFIX    ?= /usr/local
BUILD     ?= build
UNITY_DIR ?= build/unity

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules --no-print-directory

# --- Sources -------------------------------------------------------------------------------------------------

find = $(sort $(shell find $(1) -name '$(2)' 2>/dev/null))

C_SOURCES       := $(call find,src emu,*.c)
TOOL_SOURCES    := $(filter src/tool/% src/stream/% src/fuzz/%,$(C_SOURCES))
LIBRARY_SOURCES := $(filter-out $(TOOL_SOURCES),$(C_SOURCES)) $(call find,asm,*.asm)
TEST_SOURCES    := $(call find,tests,*.c)
SUPPORT_SOURCES := $(filter tests/support/%,$(TEST_SOURCES))
TARGET_SOURCES  := $(filter tests/fuzz/targets/%,$(TEST_SOURCES))
PROGRAM_SOURCES := $(filter-out $(SUPPORT_SOURCES) $(TARGET_SOURCES),$(TEST_SOURCES))
UNITY_SOURCE    := $(or $(firstword $(wildcard $(UNITY_DIR)/unity.c)),$(UNITY_DIR)/src/unity.c)

object = $(patsubst %,$(BUILD)/object/%.o,$(basename $(1)))

LIBRARY_OBJECTS := $(call object,$(LIBRARY_SOURCES))
TOOL_OBJECTS    := $(call object,$(TOOL_SOURCES))
SUPPORT_OBJECTS := $(call object,$(SUPPORT_SOURCES))
TARGET_OBJECTS  := $(call object,$(TARGET_SOURCES))
PROGRAM_OBJECTS := $(call object,$(PROGRAM_SOURCES))
BENCH_OBJECTS   := $(call object,$(call find,bench,*.c))
OBJECTS         := $(LIBRARY_OBJECTS) $(TOOL_OBJECTS) $(SUPPORT_OBJECTS) $(TARGET_OBJECTS) $(PROGRAM_OBJECTS) $(BENCH_OBJECTS)

# ONLY=text keeps the tests whose path contains the text.
only = $(if $(ONLY),$(foreach t,$(1),$(if $(findstring $(ONLY),$(t)),$(t))),$(1))

PROGRAMS := $(patsubst %.c,$(BUILD)/%,$(call only,$(PROGRAM_SOURCES)))
SCRIPTS  := $(call only,$(wildcard tests/*.sh))
COMMAND  := $(if $(TOOL_SOURCES),$(BUILD)/triptych)

# --- Flags ---------------------------------------------------------------------------------------------------

# Asked of pkg-config on first use and not before: `make test` installs pkg-config itself.
LIBRARY_PACKAGES := libpng OpenEXR libxxhash libzstd
TOOL_PACKAGES    := libcjson assimp
package_includes = $(eval package_includes := $(patsubst -I%,-isystem %,$(filter -I%,\
  $(shell pkg-config --cflags $(LIBRARY_PACKAGES) $(TOOL_PACKAGES)))))$(package_includes)
library_packages = $(eval library_packages := $(shell pkg-config --libs $(LIBRARY_PACKAGES)))$(library_packages)
tool_packages    = $(eval tool_packages := $(shell pkg-config --libs $(TOOL_PACKAGES)))$(tool_packages)

# OpenEXR.pc names the C++ libraries too; only the C core is used. Zydis has no .pc file in Debian.
library_libraries = $(filter-out -lOpenEXR-% -lOpenEXRUtil% -lIex% -lIlmThread% -lImath%,$(library_packages)) \
  -lZydis -lZycore -pthread -lm
tool_libraries = $(tool_packages) $(library_libraries)

# Instrumented builds: SANITIZE=address (1 is the same), with undefined behaviour; SANITIZE=thread; SANITIZE=fuzzer, which
# is address for libFuzzer (CC=clang); COVERAGE=1, whose counters are atomic because gcc counts loops with them otherwise,
# and threads would change each other's. gcc's flow warnings are wrong about instrumented code; the plain, clang and
# matrix builds are the ones that warn.
instrument_address  = -fsanitize=address,undefined -fno-sanitize-recover=all
instrument_fuzzer   = $(instrument_address) -fsanitize=fuzzer-no-link
instrument_thread   = -fsanitize=thread
instrument_coverage = --coverage -fprofile-update=atomic

instrument := $(if $(SANITIZE),$(SANITIZE:1=address),$(if $(COVERAGE),coverage))
ifneq ($(instrument),)
$(if $(instrument_$(instrument)),,$(error SANITIZE is "$(SANITIZE)", expected address, thread or fuzzer))
CFLAGS     ?= -O1 -g1
INSTRUMENT := $(instrument_$(instrument)) -fno-omit-frame-pointer $(if $(findstring clang,$(CC)),,-Wno-maybe-uninitialized -Wno-restrict)
CHECK_IR   := 1
else
CFLAGS     ?= -O2 -g
endif

# Every recording and what every pass of the specializer leaves is verified before anything is made of it.
ifdef CHECK_IR
CHECKED := -DTRIPTYCH_CHECK_IR
endif

# With sanitizers a program has 25 MB of code and data besides debugging information. There are 150 programs, so most share
# it: $(BUILD)/tests/shared.so has all that is not a test, and lets tests see it.
SHARED := $(if $(SANITIZE),$(BUILD)/tests/shared.so)

compile = $(CC) -std=gnu17 $(CFLAGS) -Wall -Wextra -Werror -ffp-contract=off -fPIC $(if $(SHARED),,-fvisibility=hidden) -pthread \
  $(INSTRUMENT) $(CHECKED) -Isrc -I. $(package_includes) $(CPPFLAGS)
link = $(CC) $(CFLAGS) $(INSTRUMENT) -pthread -Wl,--as-needed,-z,relro,-z,now $(LDFLAGS)

# There are 150 test programs, and most of what they take on the disk is debugging information.
compressed = -Wl,--compress-debug-sections=zlib

# An object without this note makes the whole program's stack executable; every assembly file gets it from here.
assemble = $(NASM) -f elf64 -g -F dwarf -Werror -Iasm/ \
  --before 'section .note.GNU-stack noalloc noexec nowrite progbits' --before 'section .text'

# The command reports measurements with the commit they were made at; only one object depends on it.
COMMIT := $(or $(shell git describe --always --dirty 2>/dev/null),unknown)

# Unity has no double-precision assertions unless asked; flushing after each test keeps a crashing program's passes.
unity_flags = -isystem $(dir $(UNITY_SOURCE)) -DUNITY_INCLUDE_DOUBLE -DUNITY_USE_FLUSH_STDOUT

# --- What to build -------------------------------------------------------------------------------------------

.PHONY: all programs objects check test check-threads matrix coverage soak soak-faults soak-memory bench peers bench-shaders bench-draws mutations gallery verify-external fuzzers fuzz-input fuzz-input-smoke dependencies packages install clean format format-check help FORCE

all: $(BUILD)/libtriptych.a $(if $(SANITIZE),,$(BUILD)/libtriptych.so $(BUILD)/triptych.pc) $(COMMAND) build/glmark2 \
  build/assimp

programs: $(PROGRAMS) $(if $(filter tests/peers.sh,$(SCRIPTS)),$(BUILD)/peers/drive $(BUILD)/peers/triptych)

# All that is compiled for tests, which need no headers of GLES2.
objects: $(filter-out $(PROGRAM_OBJECTS) %/gles.o %/gles_library.o %/gles_shader.o,$(OBJECTS)) $(PROGRAMS:$(BUILD)/%=$(BUILD)/object/%.o)

# Starts a recipe line: a short note in place of the command, or the command itself with V=1.
say = $(if $(V),,@printf '  %-4s  %s\n' $(1) $(or $(2),$@);)

$(BUILD)/object/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC,$<)$(compile) -MMD -MP -c $< -o $@

# Dependencies by a run of their own: -MD of nasm 2.16 leaves out what is included.
$(BUILD)/object/%.o: %.asm $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,NASM,$<)$(assemble) -M -MP -MT $@ -MF $(@:.o=.d) $< && $(assemble) $< -o $@

$(BUILD)/object/src/tool/machine.o: private CPPFLAGS += -DTRIPTYCH_COMMIT='"$(COMMIT)"'
$(BUILD)/object/src/tool/machine.o: $(BUILD)/commit

# The whole specification once more, with a hook behind each operation; it runs for a few pixels of a case that failed.
$(BUILD)/object/src/fuzz/trace.o: private override CFLAGS += -O0

$(SUPPORT_OBJECTS) $(PROGRAM_OBJECTS): private CPPFLAGS += $(unity_flags)
$(SUPPORT_OBJECTS) $(PROGRAM_OBJECTS): | $(UNITY_SOURCE)

$(BUILD)/object/unity.o: $(UNITY_SOURCE) $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC,$<)$(compile) -w $(unity_flags) -c $< -o $@

# Archives are written anew, so that an object whose source is gone is gone too; the lists notice the removal.
$(BUILD)/libtriptych.a: $(LIBRARY_OBJECTS) $(BUILD)/library.list
$(BUILD)/command.a: $(TOOL_OBJECTS) $(BUILD)/command.list
$(BUILD)/support.a: $(SUPPORT_OBJECTS) $(BUILD)/support.list
$(BUILD)/libtriptych.a $(BUILD)/command.a $(BUILD)/support.a:
	$(call say,AR)rm -f $@ && $(AR) rcs $@ $(filter %.o,$^)

# The map keeps the assembly's symbols inside; -z,text refuses code that would have to be patched when loaded.
$(BUILD)/$(SONAME): $(LIBRARY_OBJECTS) $(BUILD)/library.list src/triptych.map
	$(call say,LD)$(link) -shared -Wl,-soname,$(SONAME),-z,defs,-z,text \
	  -Wl,--version-script=src/triptych.map $(LIBRARY_OBJECTS) $(library_libraries) -o $@

$(BUILD)/libtriptych.so: $(BUILD)/$(SONAME)
	@ln -sf $(SONAME) $@

# The archive of the command lets a test link the command's parts without its main.
$(BUILD)/triptych: $(TOOL_OBJECTS) $(BUILD)/libtriptych.a $(BUILD)/command.list
	$(call say,LD)$(link) $(TOOL_OBJECTS) $(BUILD)/libtriptych.a $(tool_libraries) -o $@

# From archives a test takes what it needs. Two kinds do so in every build: those that put functions in the place of the
# library's, as a shared object calls its own, and those that name symbols of assembly, which stay where they are linked.
apart    := $(addprefix $(BUILD)/tests/,draw/cache draw/convention draw/stack fuzz/bisect fuzz/inputs tool/verify stitch/%)
archives := $(addprefix $(BUILD)/,support.a command.a libtriptych.a)
found_beside = '-Wl,-rpath,$$ORIGIN/..'

$(if $(SHARED),$(filter $(apart),$(PROGRAMS)),$(PROGRAMS)): $(archives)
$(if $(SHARED),$(filter-out $(apart),$(PROGRAMS))): $(SHARED)

$(PROGRAMS): $(BUILD)/tests/%: $(BUILD)/object/tests/%.o $(BUILD)/object/unity.o
	@mkdir -p $(@D)
	$(call say,LD)$(link) $(compressed) $(filter %.o,$^) $(or $(filter %.so,$^),$(archives)) \
	  $(if $(filter %.so,$^),$(found_beside)) $(tool_libraries) -o $@

$(BUILD)/tests/shared.so: $(filter-out %/main.o,$(TOOL_OBJECTS)) $(LIBRARY_OBJECTS) $(SUPPORT_OBJECTS) \
  $(addprefix $(BUILD)/,library.list command.list support.list)
	@mkdir -p $(@D)
	$(call say,LD)$(link) $(compressed) -shared -Wl,-Bsymbolic $(filter %.o,$^) $(tool_libraries) -o $@

# Of `make peers`: the driver, a renderer that is Triptych, and one that is GLES2 of whichever library.
peer = $(foreach part,$(1) workload,$(BUILD)/object/bench/peers/$(part).o)

$(BUILD)/peers/drive: $(call peer,drive report limits) $(BUILD)/command.a $(BUILD)/libtriptych.a
$(BUILD)/peers/triptych: $(call peer,triptych peer) $(BUILD)/command.a $(BUILD)/libtriptych.a
$(BUILD)/peers/gles: $(call peer,gles gles_library gles_shader peer)
$(BUILD)/peers/drive $(BUILD)/peers/triptych $(BUILD)/peers/gles:
	@mkdir -p $(@D)
	$(call say,LD)$(link) $(filter %.o,$^) $(filter %.a,$^) $(if $(filter %.a,$^),$(tool_libraries),-ldl) -o $@

ifeq ($(instrument),coverage)
$(BUILD)/triptych: private override LDFLAGS += -Wl,--wrap=_exit $(BUILD)/object/tests/support/end.o
$(BUILD)/triptych: $(BUILD)/object/tests/support/end.o
endif

# This test plants differences between the engines' pictures, to see the verification fail.
$(BUILD)/tests/tool/verify: private override LDFLAGS += -Wl,--wrap=triptych_read_color,--wrap=triptych_read_depth,--wrap=triptych_read_stencil,--wrap=triptych_read_target_numbers

# And this one gives all keys one hash.
$(BUILD)/tests/draw/cache: private override LDFLAGS += -Wl,--wrap=key_hash

# And this one wrong operations, passes and fragments, to see them named.
$(BUILD)/tests/fuzz/bisect: private override LDFLAGS += -Wl,--wrap=plan_step_of,--wrap=pass_reduce,--wrap=pass_dead \
  -Wl,--wrap=vector_rrr,--wrap=plan_join,--wrap=external_compile

# Fuzz targets stay within limits of their own (tests/fuzz/targets/limit.c): as a test, and with libFuzzer's main and
# a link by the name of each target (CC=clang SANITIZE=fuzzer).
fuzz_wraps = -Wl,--wrap=build_account,--wrap=container_next,--wrap=mesh_make,--wrap=mesh_read_model,--wrap=file_read \
  -Wl,--wrap=aiImportFileExWithProperties,--wrap=aiReleaseImport

$(BUILD)/tests/fuzz/inputs: $(TARGET_OBJECTS)
$(BUILD)/tests/fuzz/inputs: private override LDFLAGS += $(fuzz_wraps)

FUZZERS := $(filter-out target limit frame fuzzer importer sound survive,$(basename $(notdir $(TARGET_SOURCES))))

fuzzers: $(addprefix $(BUILD)/fuzz/,$(FUZZERS))

$(BUILD)/fuzz/inputs: $(TARGET_OBJECTS) $(BUILD)/command.a $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) -fsanitize=fuzzer $(fuzz_wraps) $^ $(tool_libraries) -o $@

$(addprefix $(BUILD)/fuzz/,$(FUZZERS)): $(BUILD)/fuzz/inputs
	@ln -sf inputs $@

# Files that hold a text and are rewritten only when it changes: the same one however BUILD is spelled, for a test
# installs from the build that others run at the same time.
$(BUILD)/flags: text = $(compile) $(unity_flags) $(link) $(assemble)
$(BUILD)/library.list: text = $(LIBRARY_OBJECTS:$(BUILD)/%=%)
$(BUILD)/command.list: text = $(TOOL_OBJECTS:$(BUILD)/%=%)
$(BUILD)/support.list: text = $(SUPPORT_OBJECTS:$(BUILD)/%=%)
$(BUILD)/commit: text = $(COMMIT)
$(BUILD)/flags $(addprefix $(BUILD)/,library.list command.list support.list commit): FORCE
	@mkdir -p $(@D)
	@printf '%s\n' "$(text)" | cmp -s - $@ || printf '%s\n' "$(text)" >$@

define pkgconfig
prefix=$(PREFIX)
libdir=$${prefix}/lib
includedir=$${prefix}/include

Name: triptych
Description: one graphics pipeline run by interchangeable execution engines with identical results
Version: $(VERSION)
Libs: -L$${libdir} -ltriptych
Libs.private: $(library_libraries)
Cflags: -I$${includedir}/triptych
endef

# Make writes the file before it runs any of the recipe's lines.
$(BUILD)/triptych.pc: Makefile FORCE
	@$(shell mkdir -p $(@D))$(file >$@.new,$(pkgconfig))cmp -s $@.new $@ && rm $@.new || mv $@.new $@

# Models that draw streams name.
build/glmark2 build/assimp:
	@mkdir -p build
	@ln -sfn /usr/share/$(@F) $@

build/unity/src/unity.c:
	@tests/support/unity.sh build/unity

# --- What to do ----------------------------------------------------------------------------------------------

jobs = $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$(shell nproc))

dependencies:
	@tests/support/dependencies.sh build test bench peers format

packages:
	@tests/support/dependencies.sh --list

# The scripts need the command, which a selection without them does without.
check:
	@tests/support/dependencies.sh build test
	+@$(MAKE) $(jobs) programs $(if $(SCRIPTS),all)
	@tests/support/run.sh '$(ONLY)' $(BUILD)

test:
	@tests/support/dependencies.sh build test
	+@$(MAKE) $(jobs) all programs
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/clang CC=clang all objects
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/sanitize SANITIZE=address all programs
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/thread SANITIZE=thread all $(threaded)
	@tests/support/run.sh '$(ONLY)' $(BUILD) $(BUILD)/sanitize $(BUILD)/thread

# What runs under ThreadSanitizer besides tests/threads.sh: programs whose subject is threads or what they share.
threaded = $(patsubst %.c,$(BUILD)/thread/%,$(call only,$(patsubst %,tests/%.c,base/code draw/background draw/cache draw/pool \
  draw/shuffle stream/threads)))

# `make test` watches the threads of small streams; here it is all streams, with more threads.
check-threads:
	@tests/support/dependencies.sh build test
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/thread SANITIZE=thread all $(threaded)
	@THOROUGH=1 tests/support/run.sh '$(ONLY)' $(BUILD)/thread

# Compilers and levels, each with all features of this processor and without AVX-512: the same bytes, results/matrix.txt.
matrix:
	@tests/support/dependencies.sh build test
	+@tests/support/matrix.sh $(BUILD)/matrix

# Lines of src/ and emu/ that the tests execute, results/coverage.txt: fails below 90 %.
coverage:
	@tests/support/dependencies.sh build test
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/coverage COVERAGE=1 all programs
	@find $(BUILD)/coverage -name '*.gcda' -delete
	@COVERAGE=1 tests/support/run.sh '$(ONLY)' $(BUILD)/coverage
	@mkdir -p results
	@tests/support/coverage.sh $(BUILD)/coverage 90 >results/coverage.txt; status=$$?; tail -n 1 results/coverage.txt; exit $$status

bench:
	@tests/support/dependencies.sh build bench
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) bench/run.sh

# Other renderers and every engine on the same work, in turns: results/peers.txt. WORKLOAD=glob PEERS="name ..." PASSES=n
# QUICK=1: bench/peers.sh.
peers:
	@tests/support/dependencies.sh build bench peers
	+@$(MAKE) $(jobs) all $(addprefix $(BUILD)/peers/,drive triptych gles)
	@BUILD=$(BUILD) bench/peers.sh

# Every shader of the corpus with every engine, and flow control by constants and by values: results/shaders.txt.
bench-shaders:
	@tests/support/dependencies.sh build bench
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) bench/shaders.sh

# Draws per second of one small triangle, one change of the state before each (bench/draws.c).
$(BUILD)/bench/draws: $(BUILD)/object/bench/draws.o $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) $^ $(library_libraries) -o $@

bench-draws:
	@tests/support/dependencies.sh build
	+@$(MAKE) $(jobs) $(BUILD)/bench/draws
	@$(BUILD)/bench/draws

# `make check` draws a few streams with the external engine; these are all of them, a compilation a routine.
verify-external: all
	@$(COMMAND) verify --engines external --frames 1 --threads 2 $(wildcard bench/streams/*.tri tests/streams/*.tri \
	  tests/scenes/*.tri tests/shading/*.tri)

# Random cases and random tests with seed after seed from SEED on, for DURATION seconds; part of it with sanitizers.
DURATION ?= 1800
SEED     ?= 1
soak:
	@tests/support/dependencies.sh build test
	+@$(MAKE) $(jobs) all
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/sanitize SANITIZE=address all programs
	@tests/support/soak.sh $(DURATION) $(BUILD) $(BUILD)/sanitize $(SEED)

# Readers of untrusted input with libFuzzer, a target after the other or JOBS at a time, each for DURATION seconds;
# TARGET=name: only that one. What is found is in $(BUILD)/fuzzer/findings.
JOBS ?= 1
fuzz-input:
	@tests/support/dependencies.sh build test fuzz
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/fuzzer CC=clang SANITIZE=fuzzer CFLAGS='-O2 -gline-tables-only' fuzzers
	+@$(MAKE) $(jobs) all
	@COMMAND=$(COMMAND) tests/fuzz/campaign.sh $(BUILD)/fuzzer $(DURATION) $(JOBS) $(or $(TARGET),$(FUZZERS))

# Ten minutes in all.
fuzz-input-smoke:
	+@$(MAKE) fuzz-input DURATION=$$((600 / $(words $(FUZZERS)))) JOBS=1

# Plants the bugs of tests/mutations/table.txt, one after the other, in a copy of the tree: results/mutations.md. About half
# an hour; ONLY="text..." keeps those whose name contains one of the texts.
mutations:
	@tests/support/dependencies.sh build test
	+@$(MAKE) $(jobs) $(UNITY_SOURCE) build/glmark2 build/assimp
	@BUILD=$(BUILD) tests/mutations/run.sh '$(ONLY)'

# Everything that the system can refuse, at every request and every call, and every place that asks for memory.
soak-faults:
	@tests/support/dependencies.sh build test
	+@$(MAKE) $(jobs) all programs
	@tests/support/faults.sh $(BUILD)

# Memory on streams of 10 million triangles, 100,000 states, 100,000 shaders, a million constants.
soak-memory: $(BUILD)/tests/fault/memory
	@TRIPTYCH_SOAK=1 $<

# The pictures of docs/gallery.md and docs/shader-gallery.md, which are goldens: look at them before they are committed.
gallery: all
	@GOLDENS=write TRIPTYCH=$(COMMAND) tests/goldens.sh $(wildcard tests/scenes/*.tri tests/shading/*.tri)

# The public header reads these tables.
PUBLIC_TABLES = $(addprefix src/,$(shell sed -n 's/^#include "\(.*\)"/\1/p' src/triptych.h))

installed = $(DESTDIR)$(PREFIX)

install: all
	install -d $(installed)/bin $(installed)/include/triptych/def $(installed)/lib/pkgconfig
	install -m 755 $(COMMAND) $(installed)/bin/
	install -m 644 src/triptych.h $(installed)/include/triptych/
	install -m 644 $(PUBLIC_TABLES) $(installed)/include/triptych/def/
	install -m 644 $(BUILD)/libtriptych.a $(installed)/lib/
	install -m 755 $(BUILD)/$(SONAME) $(installed)/lib/
	ln -sf $(SONAME) $(installed)/lib/libtriptych.so
	install -m 644 $(BUILD)/triptych.pc $(installed)/lib/pkgconfig/

clean:
	rm -rf $(BUILD)

FORMATTED = $(call find,src emu tests bench,*.[ch])

format:
	@tests/support/dependencies.sh format
	clang-format -i $(FORMATTED)

format-check:
	@tests/support/dependencies.sh format
	clang-format --dry-run --Werror $(FORMATTED)

define help
make                 the library (static and shared) and the command, in $(BUILD)/
make test            everything that is tested, from a bare Debian on; ends with "N passed, N failed"
make check           the same tests on the plain build only
make bench           the measurements, from a bare Debian on; writes results/
make soak-faults     everything that the system can refuse, refused at every request: half an hour
make soak-memory     what 10 million triangles and 100,000 states take: minutes
make peers           Mesa's softpipe and llvmpipe, SwiftShader and every engine on the same work: results/peers.txt
                     (WORKLOAD=glob PEERS="name..." PASSES=n QUICK=1 CLOCK=time)
make bench-shaders   the same of every shader in tests/shading, by shader and by length
make bench-draws     draws per second of one small triangle, one change of the state before each
make soak            random cases and tests with new seeds, half an hour (DURATION=1800 SEED=1), then a summary
make fuzz-input      untrusted input with libFuzzer, half an hour (DURATION=1800) each TARGET, JOBS at a time
make fuzz-input-smoke  the same in ten minutes
make matrix          gcc and clang at -O0, -O2, -O3, with and without AVX-512: the same bytes, results/matrix.txt
make check-threads   all streams with several threads in random orders, ThreadSanitizer watching
make coverage        lines that the tests execute, results/coverage.txt; fails below 90 %
make mutations       plants bugs in a copy of the tree and sees that the tests find them: results/mutations.md
make verify-external every stream with the external engine: minutes of compiling
make gallery         the pictures of docs/gallery.md and docs/shader-gallery.md anew
make install         PREFIX=$(PREFIX) DESTDIR=$(DESTDIR)
make dependencies    install every Debian package that any target needs
make packages        what those packages are and what each is for
make format          clang-format over the C sources; format-check only looks
make clean           remove $(BUILD)/

BUILD=dir  CC=clang  SANITIZE=address|thread  COVERAGE=1  CHECK_IR=1 (verify after each pass)
V=1 (show commands)  ONLY=text (tests whose path contains it)
CFLAGS=... (optimisation and debugging only)  UNITY_DIR=dir (a Unity checkout instead of the fetched one)
endef

help:
	@$(info $(help)):

-include $(OBJECTS:.o=.d)
