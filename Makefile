# Triptych's build: `make help` lists the targets.
#
# Sources are found, never listed. src/command and src/image are the command, src/front has the front ends,
# and all other sources in src, emu and asm are the library. Each tests/**/*.c outside tests/support/ and
# tests/command/fuzz/targets/ is a Unity program with its own main. Everything built is in $(BUILD). The
# Unity sources and links to the models of glmark2 and Assimp are always in build/, because draw streams name
# their models by paths that begin with build/glmark2.
# `make test` runs this file again for each variant: plain, sanitize (SANITIZE=address) and thread
# (SANITIZE=thread), and tests/extend.sh runs it for clang. `make matrix` and `make coverage` run it for their
# own variants.

VERSION := $(shell sed -n 's/^\#define TRIPTYCH_VERSION  *"\(.*\)"/\1/p' src/triptych.h)
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

# --- Sources ------------------------------------------------------------------------------------------------

find = $(sort $(shell find $(1) -name '$(2)' 2>/dev/null))

C_SOURCES       := $(call find,src emu,*.c)
TOOL_SOURCES    := $(filter src/command/% src/image/%,$(C_SOURCES)) $(call find,src/command,*.asm)
# The Linux side of the front ends. Their Windows side has another compiler.
FRONT_SOURCES   := $(filter-out $(addprefix src/front/d3d9/,pe/% unix32/% server/%),$(filter src/front/%,$(C_SOURCES)))
LIBRARY_SOURCES := $(filter-out $(TOOL_SOURCES) src/front/%,$(C_SOURCES)) $(call find,asm,*.asm)
TEST_SOURCES    := $(filter-out tests/support/portable/%,$(call find,tests,*.c))
SUPPORT_SOURCES := $(filter tests/support/%,$(TEST_SOURCES))
TARGET_SOURCES  := $(filter tests/command/fuzz/targets/%,$(TEST_SOURCES))
PROGRAM_SOURCES := $(filter-out $(SUPPORT_SOURCES) $(TARGET_SOURCES) tests/front/d3d9/pe/% tests/front/egl/program/%,$(TEST_SOURCES))
UNITY_SOURCE    := $(or $(firstword $(wildcard $(UNITY_DIR)/unity.c)),$(UNITY_DIR)/src/unity.c)

object = $(patsubst %,$(BUILD)/object/%.o,$(basename $(1)))

# The sources that Flex and Bison write for the grammar of shaders.
GLSL_GENERATED  := $(addprefix $(BUILD)/front/glsl_,token.c grammar.c)
D3D9_OBJECTS    := $(call object,$(filter src/front/d3d9/% src/front/common/%,$(FRONT_SOURCES)))
LIBRARY_OBJECTS := $(call object,$(LIBRARY_SOURCES))
TOOL_OBJECTS    := $(call object,$(TOOL_SOURCES))
GLSL_OBJECTS    := $(call object,$(filter src/front/glsl/%,$(FRONT_SOURCES))) $(GLSL_GENERATED:$(BUILD)/%.c=$(BUILD)/object/%.o)
GL_OBJECTS      := $(call object,$(filter src/front/gl/% src/front/egl/%,$(FRONT_SOURCES)))
FRONT_OBJECTS   := $(D3D9_OBJECTS) $(GLSL_OBJECTS) $(GL_OBJECTS)
SUPPORT_OBJECTS := $(call object,$(SUPPORT_SOURCES))
TARGET_OBJECTS  := $(call object,$(TARGET_SOURCES))
PROGRAM_OBJECTS := $(call object,$(PROGRAM_SOURCES))
# Programs for Windows are built by the scripts of bench/d3d9.
BENCH_SOURCES   := $(filter-out bench/d3d9/%,$(call find,bench,*.c))
BENCH_OBJECTS   := $(call object,$(BENCH_SOURCES))
# The kernels of docs/clients.md, without the libraries that they are measured against.
CLIENT_OBJECTS  := $(call object,$(filter-out bench/clients/run/%,$(call find,bench/clients,*.c)))
OBJECTS         := $(LIBRARY_OBJECTS) $(TOOL_OBJECTS) $(FRONT_OBJECTS) $(SUPPORT_OBJECTS) $(TARGET_OBJECTS) $(PROGRAM_OBJECTS) $(BENCH_OBJECTS)

# ONLY=text selects the tests whose path contains the text.
only = $(if $(ONLY),$(foreach t,$(1),$(if $(findstring $(ONLY),$(t)),$(t))),$(1))

PROGRAMS := $(patsubst %.c,$(BUILD)/%,$(call only,$(PROGRAM_SOURCES)))
SCRIPTS  := $(call only,$(wildcard tests/*.sh))
COMMAND  := $(if $(TOOL_SOURCES),$(BUILD)/triptych)

# Compiler flags for the library: triptych.pc for the shared one, or for the only one that is installed, and
# triptych-static.pc for the archive where both are installed.
PKGCONFIG := $(BUILD)/triptych.pc $(BUILD)/triptych-static.pc

# The sources of tests by their names. A name without a source is an error.
tests = $(foreach t,$(1),$(or $(wildcard tests/$(t).c),$(error there is no test tests/$(t).c)))

# --- Flags --------------------------------------------------------------------------------------------------

# pkg-config runs at the first use of these variables, because `make test` installs pkg-config.
LIBRARY_PACKAGES := libxxhash libzstd
TOOL_PACKAGES    := libpng OpenEXR libcjson
LOADED_PACKAGES  := assimp
package_includes = $(eval package_includes := $(patsubst -I%,-isystem %,$(filter -I%,\
  $(shell pkg-config --cflags $(LIBRARY_PACKAGES) $(TOOL_PACKAGES) $(LOADED_PACKAGES)))))$(package_includes)
library_packages = $(eval library_packages := $(shell pkg-config --libs $(LIBRARY_PACKAGES)))$(library_packages)
tool_packages    = $(eval tool_packages := $(shell pkg-config --libs $(TOOL_PACKAGES)))$(tool_packages)

# OpenEXR.pc also names the C++ libraries, and only the C core is used. Zydis has no .pc file in Debian.
other_libraries   := -lZydis -lZycore -pthread -lm
library_libraries = $(library_packages) $(other_libraries)
tool_libraries = $(filter-out -lOpenEXR-% -lOpenEXRUtil% -lIex% -lIlmThread% -lImath%,$(tool_packages)) $(library_libraries)

# Windows of X11, for the front end of EGL.
front_libraries := -lX11-xcb -lX11 -lxcb-shm -lxcb

# The command loads Assimp when it imports a model, by the name that programs linked with it have.
assimp_library = $(shell readelf -d "$$(pkg-config --variable=libdir assimp)/libassimp.so" | \
  sed -n 's/.*(SONAME).*\[\(.*\)\]$$/\1/p')

# Instrumented builds: SANITIZE=address (or 1) finds bad memory accesses and undefined behaviour.
# SANITIZE=thread finds data races. SANITIZE=fuzzer is address for libFuzzer (CC=clang). COVERAGE=1 counts
# lines; its counters are atomic, because several threads increment them. gcc's flow warnings are wrong for
# instrumented code, so only the plain, clang and matrix builds enable them.
# A check of undefined behaviour that fails executes an illegal instruction, and AddressSanitizer reports its
# line. Messages would need data for each check, 16 MB that every process relocates when it starts. A build
# with UNDEFINED= has them.
UNDEFINED          ?= -fsanitize-undefined-trap-on-error
instrument_checks   = -fsanitize=address,undefined -fno-sanitize-recover=all
instrument_address  = $(instrument_checks) $(UNDEFINED)
instrument_fuzzer   = $(instrument_checks) -fsanitize=fuzzer-no-link
instrument_thread   = -fsanitize=thread
instrument_coverage = --coverage -fprofile-update=atomic

instrument := $(if $(SANITIZE),$(SANITIZE:1=address),$(if $(COVERAGE),coverage))
ifneq ($(instrument),)
$(if $(instrument_$(instrument)),,$(error SANITIZE is "$(SANITIZE)", expected address, thread or fuzzer))
CFLAGS     ?= -O1 -g1
INSTRUMENT := $(instrument_$(instrument)) -fno-omit-frame-pointer $(if $(findstring clang,$(CC)),,-Wno-maybe-uninitialized -Wno-restrict)
CHECK_IR   := 1
else
# -g1 describes functions and lines. Descriptions of variables would make compilation a sixth longer, and the
# optimizer removes most variables. CFLAGS='-O0 -g' is a build for a debugger.
CFLAGS     ?= -O2 -g1
endif

# Verifies every recording, and the IR after every pass of the specializer.
ifdef CHECK_IR
CHECKED := -DTRIPTYCH_CHECK_IR
endif

# With sanitizers, a program has 15 MB of code and data without its debugging information. There are 330 test
# programs, so most of them share $(BUILD)/tests/shared.so, which contains everything that is not a test.
SHARED := $(if $(SANITIZE),$(BUILD)/tests/shared.so)

compile = $(CC) -std=gnu17 $(CFLAGS) -Wall -Wextra -Werror -ffp-contract=off -fPIC $(if $(SHARED),,-fvisibility=hidden) -pthread \
  $(INSTRUMENT) $(CHECKED) -Isrc -I. -I$(BUILD)/include $(package_includes) $(CPPFLAGS)
link = $(CC) $(CFLAGS) $(INSTRUMENT) -pthread -Wl,--as-needed,--build-id,-z,relro,-z,now $(link_$(instrument)) $(LDFLAGS)

# Assimp throws exceptions of C++. AddressSanitizer intercepts them only if a program starts with their
# library.
link_address = -Wl,--undefined=__asan_default_options -Wl,--no-as-needed -l:libstdc++.so.6 -Wl,--as-needed

# Debugging information is four fifths of the size of the 330 test programs, and half of the time of their
# links. TEST_DEBUG=1 compiles and links it, for a debugger. The linker gold, part of Debian 12's binutils,
# needs half of the time of ld.
compressed = -Wl,--compress-debug-sections=zlib
test_link  = $(if $(TEST_DEBUG),$(compressed),-Wl,--strip-debug) $(if $(gold),-fuse-ld=gold)
test_debug = $(if $(TEST_DEBUG),-g1,-g0)
gold      := $(shell command -v ld.gold)

# An object without this note makes the stack of the whole program executable.
assemble = $(NASM) -f elf64 -g -F dwarf -Werror -Iasm/stitch/ -I$(BUILD)/asm/ \
  --before 'section .note.GNU-stack noalloc noexec nowrite progbits' --before 'section .text'

# Reports of measurements contain the commit. Only one object depends on it.
COMMIT := $(or $(shell git describe --always --dirty 2>/dev/null),unknown)

# Unity disables double-precision assertions by default. Flushing after each test keeps the results of a
# program that crashes.
unity_flags = -isystem $(dir $(UNITY_SOURCE)) -DUNITY_INCLUDE_DOUBLE -DUNITY_USE_FLUSH_STDOUT

# --- What to build ------------------------------------------------------------------------------------------

.PHONY: gles all programs objects check test check-cross check-threads check-explore matrix coverage soak soak-faults soak-memory bench peers bench-shaders bench-passes bench-clients bench-draws bench-targets bench-scroll claims conformance-d3d9 conformance-gles conformance-piglit programs-d3d9 programs-gles profile-gles mutations campaign-slurm-test gallery verify-external docs fuzzers fuzz-input fuzz-input-smoke dependencies packages install clean format format-check compile_commands.json d3d9 lab labs help FORCE

all: $(BUILD)/libtriptych.a $(if $(SANITIZE),,$(BUILD)/libtriptych.so $(PKGCONFIG) \
  $(BUILD)/include/triptych/triptych.h) $(COMMAND) build/glmark2 \
  build/assimp

programs: $(PROGRAMS) $(if $(filter tests/peers.sh,$(SCRIPTS)),$(BUILD)/peers/drive $(BUILD)/peers/triptych $(BUILD)/peers/scroll)

# Every object but those of test programs. The objects left out need libraries that the tests do not install.
objects: $(filter-out $(PROGRAM_OBJECTS) $(BUILD)/object/bench/clients/run/%,$(OBJECTS))

# Starts a recipe line: prints a short note instead of the command, or the command itself with V=1.
say = $(if $(V),,@printf '  %-4s  %s\n' $(1) $(or $(2),$@);)

$(BUILD)/object/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC,$<)$(compile) -MMD -MP -c $< -o $@

# A run of its own for the dependencies: -MD of nasm 2.16 omits included files.
$(BUILD)/object/%.o: %.asm $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,NASM,$<)$(assemble) -M -MP -MT $@ -MF $(@:.o=.d) $< && $(assemble) $< -o $@

# The enumerations of the public header that follow from tables.
WORDS       := $(BUILD)/include/triptych_words.h
WORD_TABLES := $(patsubst %,src/def/state/%.def,kind state sampler_state stage_state value fvf attribute vertex_type \
  format depth_format primitive)

$(WORDS): src/words.awk $(WORD_TABLES)
	@mkdir -p $(@D)
	$(call say,GEN)awk -f $< $(WORD_TABLES) >$@

$(OBJECTS): | $(WORDS)

$(BUILD)/front/glsl_grammar.c: src/front/glsl/compile/grammar.y
	@mkdir -p $(@D) $(BUILD)/include
	$(call say,GEN)bison -Wall -Werror --header=$(BUILD)/include/glsl_grammar.h -o $@ $<

$(BUILD)/front/glsl_token.c: src/front/glsl/preprocess/token.l
	@mkdir -p $(@D)
	$(call say,GEN)flex -o $@ $<

$(GLSL_OBJECTS): | $(GLSL_GENERATED)

# Flex writes functions that a scanner without input functions does not call.
$(GLSL_GENERATED:$(BUILD)/%.c=$(BUILD)/object/%.o): $(BUILD)/object/%.o: $(BUILD)/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC,$<)$(compile) -Wno-unused-function -Wno-sign-compare -MMD -MP -c $< -o $@

# The header as it is installed: one file.
$(BUILD)/include/triptych/triptych.h: src/triptych.h $(WORDS)
	@mkdir -p $(@D)
	$(call say,GEN)sed -e '/^#include "triptych_words.h"$$/ { r $(WORDS)' -e 'd; }' $< >$@

# Offsets of C structures for assembly: asm/*/offset.c prints "@NAME value" into its own assembly text.
ASM_INCLUDES := $(patsubst %.c,$(BUILD)/%.inc,$(call find,asm,offset.c)) $(BUILD)/asm/stitch/argument.inc

$(BUILD)/asm/%.inc: asm/%.c $(BUILD)/flags | $(WORDS)
	@mkdir -p $(@D)
	$(call say,GEN)$(CC) -std=gnu17 -O1 -Wall -Wextra -Werror -Isrc -I. -I$(BUILD)/include $(CPPFLAGS) -MMD -MP -MT $@ -MF $(@:.inc=.d) -S $< -o $(@:.inc=.s)
	@sed -n 's/.*"@\([A-Z_]*\) \(-\{0,1\}[0-9]*\)".*/%define \1 \2/p' $(@:.inc=.s) >$@

# The arguments of the stitcher's fragments by name: argument_FRAGMENT.NAME is the argument's number.
$(BUILD)/asm/stitch/argument.inc: src/def/engine/fragment.def
	@mkdir -p $(@D)
	$(call say,GEN)awk -F '[(), ]+' '/^FRAGMENT/ { for (i = 3; i <= NF && $$i !~ /^"/; i++) \
	  print "%define argument_" $$2 "." $$i " " i - 3 }' $< >$@

$(filter $(BUILD)/object/asm/%,$(LIBRARY_OBJECTS)): | $(ASM_INCLUDES)

$(BUILD)/object/src/command/bench/machine.o: private CPPFLAGS += -DTRIPTYCH_COMMIT='"$(COMMIT)"'
$(BUILD)/object/src/command/bench/machine.o: $(BUILD)/commit

$(BUILD)/object/src/command/import/assimp.o: private CPPFLAGS += -DASSIMP_LIBRARY='"$(assimp_library)"'

# The whole specification with a hook after each operation. It runs only for a few pixels of a failing case.
$(BUILD)/object/src/command/fuzz/bisect/trace.o: private override CFLAGS += -O0

# The specification with a hook that finds its callers, so that no function may be inlined.
$(BUILD)/object/src/command/explore/record.o: private override CFLAGS += -O0

# The specification as text, for the pages of the command explore.
SPEC_SOURCES := $(call find,src/spec,*.h)
$(BUILD)/asm/spec.texts: $(SPEC_SOURCES) $(BUILD)/spec.list
	@mkdir -p $(@D)
	$(call say,GEN)for f in $(SPEC_SOURCES:src/%=%); do printf '%s\0' $$f && cat src/$$f && printf '\0'; done >$@

$(BUILD)/object/src/command/explore/embed.o: $(BUILD)/asm/spec.texts $(wildcard $(addprefix src/command/explore/,*.html *.css *.js))

$(SUPPORT_OBJECTS) $(PROGRAM_OBJECTS): private CPPFLAGS += $(unity_flags)

# Tests themselves are small loops. Optimization costs more time than it saves, and so do checks of undefined
# behaviour, which the library needs. Both compilers must accept them: gcc compiles them with sanitizers, and
# clang, where it is installed, in the plain build. clang's warnings of variables without a value do not need
# optimization, gcc's do. The sources that tests share have -O1, and tests/extend.sh compiles them with clang.
# So have a few tests that compute for seconds.
computing := $(call object,$(addprefix tests/,engines/specialize/encode.c spec/pixel/output.c spec/pixel/picture.c \
  render/raster/raster.c))
TEST_CC := $(if $(instrument)$(filter-out gcc,$(CC)),$(CC),$(if $(shell command -v clang),clang,$(CC)))
ifneq ($(SANITIZE),)
$(PROGRAM_OBJECTS): private override CFLAGS += -O0 $(test_debug)
$(PROGRAM_OBJECTS): private override INSTRUMENT += -fno-sanitize=undefined
else ifneq ($(filter -O2 -O3,$(CFLAGS)),)
$(PROGRAM_OBJECTS): private override CC = $(TEST_CC)
$(PROGRAM_OBJECTS): private override CFLAGS += -O0 $(test_debug)
$(SUPPORT_OBJECTS) $(computing): private override CFLAGS += -O1 $(test_debug)
endif

# Files in which a table or the specification becomes one very large function, or thousands of small ones.
# A fifth of their compilation follows variables through optimization, for a debugger.
READINGS := $(filter emu/%,$(C_SOURCES)) $(addprefix src/,ir/record.c engines/stitch/operations.c \
  command/inspect/observe.c command/fuzz/bisect/probe_stitch.c front/d3d9/remote/packing.c front/d3d9/remote/form.c) \
  $(addprefix tests/support/,picture/quad.c trial/trial_interpret.c trial/trial_emulate.c control/nest_record.c) \
  $(filter bench/clients/%,$(BENCH_SOURCES))

ifneq ($(SANITIZE),)
# With checks, inlining makes their compilation two to three times as long. It does not make the emulator
# faster: at -O1 gcc calls its operations anyway.
$(call object,$(READINGS)): private override CFLAGS += -fno-inline

# Most of the time of a test is that of engines and the renderer. The command and the front ends are a third
# of the sources. Of the others, these need twice as long with -O1.
$(call object,$(filter-out $(READINGS),$(filter src/command/% src/front/%,$(C_SOURCES))) emu/emulate/array_each.c \
  $(addprefix src/,engines/stitch/operations.c command/inspect/observe.c) \
  $(addprefix tests/support/,picture/quad.c trial/trial_interpret.c trial/trial_emulate.c) \
  tests/command/fuzz/targets/gl/gles.c): private override CFLAGS += -O0
else ifeq ($(findstring clang,$(CC)),)
$(call object,$(READINGS)): private override CFLAGS += -fno-var-tracking-assignments
endif

# At -O2 gcc compiles these for up to twice as long, and a recording takes 1 % fewer instructions. The speed
# of stitch's operations was not compared.
ifneq ($(filter -O2 -O3,$(CFLAGS)),)
$(call object,src/ir/record.c src/engines/stitch/operations.c): private override CFLAGS += -O1
endif

$(SUPPORT_OBJECTS) $(PROGRAM_OBJECTS): | $(UNITY_SOURCE)

$(BUILD)/object/unity.o: $(UNITY_SOURCE) $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC,$<)$(compile) -w $(unity_flags) -c $< -o $@

# Archives are rewritten, so that they contain no object of a removed source. The lists change when a source
# is removed.
$(BUILD)/libtriptych.a: $(LIBRARY_OBJECTS) $(BUILD)/library.list
$(BUILD)/command.a: $(TOOL_OBJECTS) $(BUILD)/command.list
$(BUILD)/front.a: $(FRONT_OBJECTS) $(BUILD)/front.list
$(BUILD)/support.a: $(SUPPORT_OBJECTS) $(BUILD)/support.list
$(BUILD)/libtriptych.a $(BUILD)/command.a $(BUILD)/front.a $(BUILD)/support.a:
	$(call say,AR)rm -f $@ && $(AR) rcs $@ $(filter %.o,$^)

# The version script hides the symbols of assembly. -z,text refuses code that needs relocation when loaded.
$(BUILD)/$(SONAME): $(LIBRARY_OBJECTS) $(BUILD)/library.list src/triptych.map
	$(call say,LD)$(link) -shared -Wl,-soname,$(SONAME),-z,defs,-z,text \
	  -Wl,--version-script=src/triptych.map $(LIBRARY_OBJECTS) $(library_libraries) -o $@

$(BUILD)/libtriptych.so: $(BUILD)/$(SONAME)
	@ln -sf $(SONAME) $@

# Tests link parts of the command, without its main, from this archive.
$(BUILD)/triptych: $(TOOL_OBJECTS) $(BUILD)/libtriptych.a $(BUILD)/command.list
	$(call say,LD)$(link) $(TOOL_OBJECTS) $(BUILD)/libtriptych.a $(tool_libraries) -o $@

# The kernels' tests contain the kernels.
$(filter $(BUILD)/tests/clients/%,$(PROGRAMS)): $(CLIENT_OBJECTS)

# Two kinds of tests link archives in every build: tests that replace functions of the library, because a
# shared object calls its own functions, and tests that use symbols of assembly, because a shared object hides
# these.
apart    := $(patsubst %.c,$(BUILD)/%,$(call tests,render/cache/cache render/device/label render/raster/tiny \
  contract/convention contract/stack command/explore/record command/fuzz/bisect command/fuzz/inputs command/tool/verify)) $(BUILD)/tests/engines/stitch/%
archives := $(addprefix $(BUILD)/,support.a front.a command.a libtriptych.a)
found_beside = '-Wl,-rpath,$$ORIGIN/..'

$(if $(SHARED),$(filter $(apart),$(PROGRAMS)),$(PROGRAMS)): $(archives)
$(if $(SHARED),$(filter-out $(apart),$(PROGRAMS))): $(SHARED)

$(PROGRAMS): $(BUILD)/tests/%: $(BUILD)/object/tests/%.o $(BUILD)/object/unity.o
	@mkdir -p $(@D)
	$(call say,LD)$(link) $(test_link) $(filter %.o,$^) $(or $(filter %.so,$^),$(archives)) \
	  $(if $(filter %.so,$^),$(found_beside)) $(front_libraries) $(tool_libraries) -o $@

$(BUILD)/tests/shared.so: $(filter-out %/main.o,$(TOOL_OBJECTS)) $(FRONT_OBJECTS) $(LIBRARY_OBJECTS) \
  $(SUPPORT_OBJECTS) $(addprefix $(BUILD)/,library.list command.list front.list support.list)
	@mkdir -p $(@D)
	$(call say,LD)$(link) $(compressed) -shared -Wl,-Bsymbolic $(filter %.o,$^) $(front_libraries) $(tool_libraries) -o $@

# The programs of `make peers`: the driver, Triptych as a renderer, and GLES2 of any library as a renderer.
peer = $(foreach part,$(1) workload,$(BUILD)/object/bench/peers/$(part).o)

$(BUILD)/peers/drive: $(call peer,drive limits ratio mean report report_json) $(BUILD)/command.a $(BUILD)/libtriptych.a
$(BUILD)/peers/triptych: $(call peer,triptych peer) $(BUILD)/command.a $(BUILD)/libtriptych.a
$(BUILD)/peers/gles: $(call peer,gles gles/gles_library gles/gles_page gles/page gles_shader gles_texel peer)
$(BUILD)/peers/drive $(BUILD)/peers/triptych $(BUILD)/peers/gles:
	@mkdir -p $(@D)
	$(call say,LD)$(link) $(filter %.o,$^) $(filter %.a,$^) $(if $(filter %.a,$^),$(tool_libraries),-ldl) -o $@

ifeq ($(instrument),coverage)
$(BUILD)/triptych: private override LDFLAGS += -Wl,--wrap=_exit $(BUILD)/object/tests/support/system/end.o
$(BUILD)/triptych: $(BUILD)/object/tests/support/system/end.o
else ifeq ($(instrument),address)
$(BUILD)/triptych: private override LDFLAGS += $(BUILD)/object/tests/support/system/sanitizer.o
$(BUILD)/triptych: $(BUILD)/object/tests/support/system/sanitizer.o
endif

# This test changes the pictures of engines, so that the verification must fail.
$(BUILD)/tests/command/tool/verify: private override LDFLAGS += -Wl,--wrap=triptych_read_color,--wrap=triptych_read_depth,--wrap=triptych_read_stencil,--wrap=triptych_read_target_numbers

# This test gives all keys the same hash.
$(BUILD)/tests/render/cache/cache: private override LDFLAGS += -Wl,--wrap=key_hash
$(BUILD)/tests/render/device/label: private override LDFLAGS += -Wl,--wrap=key_pack

# This test replaces operations, passes and fragments by wrong ones, which the bisector must name.
$(BUILD)/tests/command/fuzz/bisect: private override LDFLAGS += -Wl,--wrap=schedule_step_of,--wrap=pass_reduce,--wrap=pass_dead \
  -Wl,--wrap=encode_rrr,--wrap=plan_join,--wrap=external_compile

# Fuzz targets have limits of their own (tests/command/fuzz/targets/limit.c). They are linked into a test, and
# into a program with libFuzzer's main that has a link for each target (CC=clang SANITIZE=fuzzer).
fuzz_wraps = -Wl,--wrap=stream_build_account,--wrap=container_next,--wrap=mesh_make,--wrap=mesh_read_model,--wrap=file_read \
  -Wl,--wrap=assimp_import,--wrap=assimp_release

$(BUILD)/tests/command/fuzz/inputs: $(TARGET_OBJECTS)
$(BUILD)/tests/command/fuzz/inputs: private override LDFLAGS += $(fuzz_wraps)

FUZZERS := $(filter-out target limit frame fuzzer importer sound survive canvas gles_input gles_limit gles_memory,$(basename $(notdir $(TARGET_SOURCES))))

fuzzers: $(addprefix $(BUILD)/fuzz/,$(FUZZERS))

$(BUILD)/fuzz/inputs: $(TARGET_OBJECTS) $(BUILD)/front.a $(BUILD)/command.a $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) -fsanitize=fuzzer $(fuzz_wraps) $^ $(tool_libraries) -o $@

$(addprefix $(BUILD)/fuzz/,$(FUZZERS)): $(BUILD)/fuzz/inputs
	@ln -sf inputs $@

# Files with a text, rewritten only when the text changes. The text does not depend on the spelling of BUILD,
# because one test installs from the build that other tests use at that time.
$(BUILD)/flags: text = $(subst -I$(BUILD)/,-I,$(compile) $(TEST_CC) $(unity_flags) $(link) $(assemble))
$(BUILD)/library.list: text = $(LIBRARY_OBJECTS:$(BUILD)/%=%)
$(BUILD)/command.list: text = $(TOOL_OBJECTS:$(BUILD)/%=%)
$(BUILD)/front.list: text = $(FRONT_OBJECTS:$(BUILD)/%=%)
$(BUILD)/support.list: text = $(SUPPORT_OBJECTS:$(BUILD)/%=%)
$(BUILD)/spec.list: text = $(SPEC_SOURCES)
$(BUILD)/commit: text = $(COMMIT)
$(BUILD)/flags $(addprefix $(BUILD)/,library.list command.list front.list support.list spec.list commit): FORCE
	@mkdir -p $(@D)
	@printf '%s\n' "$(text)" | cmp -s - $@ || printf '%s\n' "$(text)" >$@

# --- Direct3D 9 for programs of Windows -------------------------------------------------------------------

# A DLL of Wine's builtin form: a Windows side, and a Unix library that Wine loads with it. d3d9.dll forwards
# to it.
# Windows' headers define what they declare, so that the Windows side has warnings of its own.
MINGW  ?= x86_64-w64-mingw32-gcc
WINE_IMPORTS = $(firstword $(wildcard $(addsuffix /libntdll.a,/usr/lib/x86_64-linux-gnu/wine/x86_64-windows)))
D3D9 := $(BUILD)/d3d9
PE_SOURCES := $(call find,src/front/d3d9/pe,*.c)
PE_PROGRAMS := $(patsubst tests/front/d3d9/pe/%.c,%,$(wildcard tests/front/d3d9/pe/*.c))
pe_flags = -std=gnu17 -O2 -g -Wall -Wextra -Werror -Wno-cast-function-type -Isrc -MMD -MP

# Programs of 32 bits, where Wine and the compilers for them are installed: the Unix library only passes
# calls on to a 64-bit process, so that there is one Linux side. It is built without a C library's folder of
# this width.
MINGW32 ?= i686-w64-mingw32-gcc
REMOTE   = $(addprefix src/front/d3d9/,remote/known.c remote/packing.c remote/narrow.c remote/queue.c size.c)
WIDE_OBJECTS   := $(patsubst %.c,$(BUILD)/object/%.obj,$(filter-out %/shared.c,$(PE_SOURCES)))
NARROW_OBJECTS := $(patsubst %.c,$(BUILD)/object/%.obj32,$(filter-out %/direct.c,$(PE_SOURCES)) $(REMOTE))
NARROW_UNIX    := $(addprefix src/front/d3d9/,unix32/entry.c remote/client.c remote/channel.c)

# Goals that need the command too build these files beside it: a make for each would write the same archives.
d3d9_files = $(D3D9)/x86_64-windows/d3d9.dll $(D3D9)/x86_64-unix/triptych9.so $(D3D9)/i386-windows/d3d9.dll \
  $(D3D9)/i386-unix/triptych9.so $(D3D9)/triptych-d3d9-server $(foreach p,$(PE_PROGRAMS),$(D3D9)/$(p).exe $(D3D9)/$(p)32.exe)

d3d9:
	@tests/support/scripts/dependencies.sh build d3d9
	+@$(MAKE) $(jobs) $(d3d9_files)

$(BUILD)/object/%.obj: %.c
	@mkdir -p $(@D)
	$(call say,MINGW,$<)$(MINGW) $(pe_flags) -c $< -o $@

$(BUILD)/object/%.obj32: %.c
	@mkdir -p $(@D)
	$(call say,MINGW32,$<)$(MINGW32) $(pe_flags) -MF $(@:.obj32=.32.d) -c $< -o $@

$(D3D9)/x86_64-windows/triptych9.dll: $(WIDE_OBJECTS) src/front/d3d9/pe/triptych9.def
	@mkdir -p $(@D)
	$(call say,LD)$(MINGW) -shared -static-libgcc -Wl,--build-id -o $@ $^ $(WINE_IMPORTS) -lgdi32 -luser32 && \
	  winebuild --builtin $@

# Names without @BYTES, as in Windows' d3d9.dll.
$(D3D9)/i386-windows/triptych9.dll: $(NARROW_OBJECTS) src/front/d3d9/pe/triptych9.def $(D3D9)/ntdll32.a
	@mkdir -p $(@D)
	$(call say,LD)$(MINGW32) -shared -static-libgcc -Wl,--build-id,--kill-at,--enable-stdcall-fixup -o $@ $^ -lgdi32 -luser32 && \
	  winebuild --builtin $@

$(D3D9)/ntdll32.a: src/front/d3d9/pe/ntdll32.def
	@mkdir -p $(@D)
	$(call say,LD)i686-w64-mingw32-dlltool --kill-at --input-def $< --output-lib $@

$(D3D9)/x86_64-windows/d3d9.dll: src/front/d3d9/pe/d3d9.def $(D3D9)/x86_64-windows/triptych9.dll
	@mkdir -p $(@D)
	$(call say,LD)$(MINGW) -shared -nostdlib -Wl,--entry=0 -o $@ $<

$(D3D9)/i386-windows/d3d9.dll: src/front/d3d9/pe/d3d9.def $(D3D9)/i386-windows/triptych9.dll
	@mkdir -p $(@D)
	$(call say,LD)$(MINGW32) -shared -nostdlib -Wl,--entry=0 -o $@ $<

$(D3D9)/x86_64-unix/triptych9.so: $(D3D9_OBJECTS) $(BUILD)/libtriptych.a $(BUILD)/front.list
	@mkdir -p $(@D)
	$(call say,LD)$(link) -shared -Wl,-z,defs,-z,text,--exclude-libs,ALL $(D3D9_OBJECTS) $(BUILD)/libtriptych.a \
	  $(library_libraries) -o $@

$(D3D9)/i386-unix/triptych9.so: $(NARROW_UNIX) $(wildcard src/front/d3d9/remote/*.h) src/front/d3d9/unix/entry.h
	@mkdir -p $(@D)
	$(call say,LD)$(CC) -m32 -std=gnu17 -O2 -g -Wall -Wextra -Werror -fPIC -fvisibility=hidden -Isrc -shared -Wl,-z,defs -o $@ \
	  $(NARROW_UNIX) -ldl

$(D3D9)/triptych-d3d9-server: $(BUILD)/object/src/front/d3d9/server/main.o $(D3D9_OBJECTS) $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) $< $(D3D9_OBJECTS) $(BUILD)/libtriptych.a $(library_libraries) -o $@

$(D3D9)/%32.exe: tests/front/d3d9/pe/%.c
	@mkdir -p $(@D)
	$(call say,MINGW32,$<)$(MINGW32) -std=gnu17 -O2 -g -Wall -Wextra -Werror -o $@ $< -ld3d9 -lgdi32 -luser32

$(D3D9)/%.exe: tests/front/d3d9/pe/%.c
	@mkdir -p $(@D)
	$(call say,MINGW,$<)$(MINGW) -std=gnu17 -O2 -g -Wall -Wextra -Werror -o $@ $< -ld3d9 -lgdi32 -luser32

# --- OpenGL ES for programs of Linux ------------------------------------------------------------------------

# A vendor library of libglvnd, and the file that names it: libglvnd looks in the file's folder.
EGL := $(BUILD)/egl
EGL_OBJECTS := $(GL_OBJECTS) $(GLSL_OBJECTS) $(call object,$(filter src/front/common/%,$(FRONT_SOURCES)))

gles_files = $(EGL)/libEGL_triptych.so.0 $(EGL)/10_triptych.json

gles:
	@tests/support/scripts/dependencies.sh build gles
	+@$(MAKE) $(jobs) $(gles_files)

$(EGL)/libEGL_triptych.so.0: $(EGL_OBJECTS) $(BUILD)/libtriptych.a $(BUILD)/front.list src/front/egl/egl.map
	@mkdir -p $(@D)
	$(call say,LD)$(link) -shared -Wl,-soname,$(@F),-z,defs,-z,text -Wl,--version-script=src/front/egl/egl.map \
	  $(EGL_OBJECTS) $(BUILD)/libtriptych.a $(front_libraries) $(library_libraries) -o $@

$(EGL)/10_triptych.json: src/front/egl/10_triptych.json
	@mkdir -p $(@D)
	@cp $< $@

define pkgconfig
prefix=$(PREFIX)
libdir=$${prefix}/lib
includedir=$${prefix}/include

Name: $(basename $(@F))
Description: one graphics pipeline run by interchangeable execution engines with identical results
Version: $(VERSION)
Cflags: -I$${includedir}/triptych
$(pkgconfig_libraries)
endef

define pkgconfig_shared
Libs: -L$${libdir} -ltriptych
Requires.private: $(LIBRARY_PACKAGES)
Libs.private: $(other_libraries)
endef

define pkgconfig_static
Libs: $${libdir}/libtriptych.a $(other_libraries)
Requires: $(LIBRARY_PACKAGES)
endef

$(BUILD)/triptych.pc: pkgconfig_libraries = $(pkgconfig_shared)
$(BUILD)/triptych-static.pc: pkgconfig_libraries = $(pkgconfig_static)

# Make writes the file before it runs the lines of the recipe.
$(PKGCONFIG): Makefile FORCE
	@$(shell mkdir -p $(@D))$(file >$@.new,$(pkgconfig))cmp -s $@.new $@ && rm $@.new || mv $@.new $@

# Manual pages and completions of shells, from the tables of options.
COMMANDS    := $(shell sed -n 's/^COMMAND(\(.*\))/\1/p' src/command/support/command.def)
PAGES       := $(addprefix $(BUILD)/share/man/man1/triptych,.1 $(COMMANDS:%=-%.1))
COMPLETIONS := $(addprefix $(BUILD)/share/,bash-completion/completions/triptych zsh/site-functions/_triptych \
  fish/vendor_completions.d/triptych.fish)

$(PAGES): $(BUILD)/share/man/man1/triptych%1: $(COMMAND)
	@mkdir -p $(@D)
	$(call say,GEN)$(COMMAND) help $(patsubst -%.,%,$(filter-out .,$*)) --as man >$@

$(COMPLETIONS): $(COMMAND)
	@mkdir -p $(@D)
	$(call say,GEN)$(COMMAND) help --as $(firstword $(subst -, ,$(subst /, ,$(@:$(BUILD)/share/%=%)))) >$@

# Models that draw streams use.
build/glmark2 build/assimp:
	@mkdir -p build
	@ln -sfn /usr/share/$(@F) $@

build/unity/src/unity.c:
	@tests/support/scripts/unity.sh build/unity

# --- What to do ---------------------------------------------------------------------------------------------

jobs = $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$(shell nproc))

dependencies:
	@tests/support/scripts/dependencies.sh build test bench peers format

packages:
	@tests/support/scripts/dependencies.sh --list

# Only the scripts need the command.
check:
	@tests/support/scripts/dependencies.sh build test
	+@$(MAKE) $(jobs) programs $(if $(SCRIPTS),all)
	@tests/support/scripts/run.sh '$(ONLY)' $(BUILD)

test:
	@tests/support/scripts/dependencies.sh build test
	+@$(MAKE) $(jobs) all programs
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/sanitize SANITIZE=address all programs
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/thread SANITIZE=thread all $(threaded)
	@tests/support/scripts/run.sh '$(ONLY)' $(BUILD) $(BUILD)/sanitize $(BUILD)/thread

# Programs that run under ThreadSanitizer, besides tests/threads.sh: those that test threads or data that
# threads share.
threaded = $(patsubst %.c,$(BUILD)/thread/%,$(call only,$(call tests,machine/code render/device/background \
  render/device/buffer render/device/texture render/cache/cache render/device/shuffle render/queue/pool \
  command/stream/threads front/egl/context front/egl/sync front/egl/threads)))

# Uses pages of the command explore in a headless Chromium. PICTURES=folder takes the pictures of
# docs/explorer.md instead.
check-explore:
	@tests/support/scripts/dependencies.sh build browser
	+@$(MAKE) $(jobs) all
	@python3 tests/explore/browse.py $(COMMAND) $(PICTURES)

# `make lab N`: the folder of lab N of the course, or its check (docs/course/README.md); LAB=folder: that one.
ifeq ($(firstword $(MAKECMDGOALS)),lab)
$(wordlist 2,9,$(MAKECMDGOALS)):
	@:
endif
lab:
	@tests/support/scripts/dependencies.sh build course
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) CC=$(CC) docs/course/lab.sh '$(wordlist 2,9,$(MAKECMDGOALS))' $(LAB)

# The checks of all labs, on solutions, starting files and planted mistakes. `make test` runs the quick ones.
labs:
	@tests/support/scripts/dependencies.sh build course
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) CC=$(CC) LABS=all tests/course.sh

# `make test` runs ThreadSanitizer on small streams. This target runs it on all streams, with more threads.
check-threads:
	@tests/support/scripts/dependencies.sh build test
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/thread SANITIZE=thread all $(threaded)
	@THOROUGH=1 tests/support/scripts/run.sh '$(ONLY)' $(BUILD)/thread

# Compares the pictures of builds by compiler and level, with and without AVX-512: results/matrix.txt.
matrix:
	@tests/support/scripts/dependencies.sh build test
	+@tests/support/scripts/matrix.sh $(BUILD)/matrix

# Lists the lines of src/ and emu/ that the tests execute, results/coverage.txt, and fails below 90 %.
coverage:
	@tests/support/scripts/dependencies.sh build test
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/coverage COVERAGE=1 all programs
	@find $(BUILD)/coverage -name '*.gcda' -delete
	@COVERAGE=1 tests/support/scripts/run.sh '$(ONLY)' $(BUILD)/coverage
	@mkdir -p results
	@tests/support/scripts/coverage.sh $(BUILD)/coverage 90 >results/coverage.txt; status=$$?; tail -n 1 results/coverage.txt; exit $$status

bench:
	@tests/support/scripts/dependencies.sh build bench
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) bench/run.sh

# Measures other renderers and every engine on the same work, in turns: results/peers.txt. bench/peers.sh
# describes WORKLOAD=glob PEERS="name ..." PASSES=n QUICK=1.
peers:
	@tests/support/scripts/dependencies.sh build bench peers
	+@$(MAKE) $(jobs) all $(addprefix $(BUILD)/peers/,drive triptych gles)
	@BUILD=$(BUILD) bench/peers.sh

# Measures every shader of the corpus with every engine, and flow control by constants and by values:
# results/shaders.txt.
bench-shaders:
	@tests/support/scripts/dependencies.sh build bench
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) bench/shaders.sh

# Leaves passes of the specializer out, and measures the parts of a build (bench/passes.sh).
bench-passes:
	@tests/support/scripts/dependencies.sh build bench
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) bench/passes.sh

# Measures draws of one small triangle per second, with one change of the state before each draw
# (bench/draws.c).
$(BUILD)/bench/draws: $(BUILD)/object/bench/draws.o $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) $^ $(library_libraries) -o $@

bench-draws:
	@tests/support/scripts/dependencies.sh build
	+@$(MAKE) $(jobs) $(BUILD)/bench/draws
	@$(BUILD)/bench/draws

# Measures changes of the target (bench/targets.c).
$(BUILD)/bench/targets: $(BUILD)/object/bench/targets.o $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) $^ $(library_libraries) -o $@

# Programs that are not graphics, as kernels, in plain C and by libraries (docs/clients.md).
$(BUILD)/bench/clients: $(CLIENT_OBJECTS) $(call object,$(call find,bench/clients/run,*.c)) $(BUILD)/command.a \
  $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) $(filter %.o,$^) $(filter %.a,$^) $(tool_libraries) -lcrypto -lswscale -lavutil -lpcre2-8 -o $@

bench-clients:
	@tests/support/scripts/dependencies.sh build clients
	+@$(MAKE) $(jobs) $(BUILD)/bench/clients
	@BUILD=$(BUILD) bench/clients.sh

bench-targets:
	@tests/support/scripts/dependencies.sh build
	+@$(MAKE) $(jobs) $(BUILD)/bench/targets
	@$(BUILD)/bench/targets

# Measures what frames cost that draw only what changes (bench/peers/scroll.c).
$(BUILD)/peers/scroll: $(BUILD)/object/bench/peers/scroll.o $(BUILD)/command.a $(BUILD)/libtriptych.a
	@mkdir -p $(@D)
	$(call say,LD)$(link) $^ $(tool_libraries) -o $@

bench-scroll:
	@tests/support/scripts/dependencies.sh build
	+@$(MAKE) $(jobs) $(BUILD)/peers/scroll
	@$(BUILD)/peers/scroll

# Tests the claims of the thesis and of other renderers (docs/claims.md): results/claims.json and
# results/report. ONLY=C156,S9 selects claims; RESUME=1 continues after an interruption, and RESUME=older
# uses outputs of other commits too.
claims:
	@tests/support/scripts/dependencies.sh build test claims peers browser
	+@$(MAKE) $(jobs) all $(UNITY_SOURCE)
	@$(COMMAND) claims --pdf $(if $(ONLY),--only $(ONLY)) $(if $(RESUME),$(if $(filter older,$(RESUME)),--older,--resume))

# Wine's Direct3D 9 tests on Triptych and on Wine's own Direct3D 9: results/conformance.md.
# bench/conformance-d3d9.sh describes ENGINE=name THREADS=n SUITES="name ..." LIMIT=seconds.
conformance-d3d9:
	@tests/support/scripts/dependencies.sh build d3d9 suites
	+@$(MAKE) $(jobs) all $(d3d9_files)
	@BUILD=$(BUILD) bench/conformance-d3d9.sh

# Programs for Windows on Triptych and on Wine's own Direct3D 9: results/programs.json. bench/programs-d3d9.sh
# describes ENGINE=name PROGRAMS="name ..." PASSES=n SIDES=name.
programs-d3d9:
	@tests/support/scripts/dependencies.sh build d3d9 suites programs
	+@$(MAKE) $(jobs) all $(d3d9_files)
	@BUILD=$(BUILD) bench/programs-d3d9.sh

# Programs of OpenGL ES on Triptych and on llvmpipe: results/programs-gles.json. bench/programs-gles.sh
# describes ENGINE=name NAMES="name ..." PASSES=n SIDES=name.
programs-gles:
	@tests/support/scripts/dependencies.sh build gles programs-gles
	+@$(MAKE) $(jobs) all $(gles_files)
	@BUILD=$(BUILD) bench/programs-gles.sh

# The instructions of a frame of the same programs by what they are for: results/profile-gles.json.
profile-gles:
	@tests/support/scripts/dependencies.sh build gles programs-gles
	+@$(MAKE) $(jobs) all $(gles_files)
	@BUILD=$(BUILD) PROFILE=1 bench/programs-gles.sh

# Builds of Khronos' dEQP-GLES2 and dEQP-EGL from elsewhere, on Triptych and on llvmpipe:
# results/conformance-gles2.json and results/conformance-egl.json. bench/conformance-gles.sh describes
# DEQP=folder SUITE=name ENGINE=name THREADS=n CASES="glob ..." EVERY=n SIDES=name.
conformance-gles:
	@tests/support/scripts/dependencies.sh build gles conformance-gles
	+@$(MAKE) $(jobs) all $(gles_files)
	@BUILD=$(BUILD) bench/conformance-gles.sh

# piglit's tests of the OpenGL ES Shading Language, of Debian's package, on Triptych and on llvmpipe:
# results/conformance-piglit.json.
conformance-piglit:
	@tests/support/scripts/dependencies.sh build gles conformance-piglit
	+@$(MAKE) $(jobs) all $(gles_files)
	@python3 bench/gles/piglit.py --triptych $(or $(TRIPTYCH),$(COMMAND)) --engine $(or $(ENGINE),specialize)

# The text of external:c=portable on another machine.
check-cross:
	@tests/support/scripts/dependencies.sh build cross
	+@$(MAKE) $(jobs) $(BUILD)/tests/engines/external/portable
	@TRIPTYCH_CROSS=aarch64-linux-gnu-gcc TRIPTYCH_CROSS_RUN='qemu-aarch64 -L /usr/aarch64-linux-gnu' \
	  $(BUILD)/tests/engines/external/portable

# `make check` draws a few streams with the external engine. This target draws all: each routine is one
# compilation.
verify-external: all
	@$(COMMAND) verify --engines external --frames 1 --threads 2 $(wildcard bench/streams/*.tri bench/streams/pages/*.trib tests/data/streams/*.tri \
	  tests/data/scenes/*.tri tests/data/shading/*.tri)

# Runs random cases and random tests with successive seeds from SEED on, for DURATION seconds, partly with
# sanitizers.
DURATION ?= 1800
SEED     ?= 1
soak:
	@tests/support/scripts/dependencies.sh build test
	+@$(MAKE) $(jobs) all
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/sanitize SANITIZE=address all programs
	@tests/support/scripts/soak.sh $(DURATION) $(BUILD) $(BUILD)/sanitize $(SEED)

# Runs the readers of untrusted input under libFuzzer, JOBS targets at a time, each for DURATION seconds, or
# only TARGET=name. Findings are in $(BUILD)/fuzzer/findings.
JOBS ?= 1
fuzz-input:
	@tests/support/scripts/dependencies.sh build test fuzz
	+@$(MAKE) $(jobs) BUILD=$(BUILD)/fuzzer CC=clang SANITIZE=fuzzer CFLAGS='-O2 -gline-tables-only' fuzzers
	+@$(MAKE) $(jobs) all
	@COMMAND=$(COMMAND) tests/command/fuzz/campaign.sh $(BUILD)/fuzzer $(DURATION) $(JOBS) $(or $(TARGET),$(FUZZERS))

# The same in ten minutes.
fuzz-input-smoke:
	+@$(MAKE) fuzz-input DURATION=$$((600 / $(words $(FUZZERS)))) JOBS=1

# Runs a campaign of CASES random cases on a Slurm with four nodes on this machine, and kills a node in the
# middle. bench/slurm/test.sh describes SHARDS=n SEED=n OPTIONS="--engines ..." TIMEOUT=seconds OUTPUT=folder.
campaign-slurm-test:
	@tests/support/scripts/dependencies.sh build slurm
	+@$(MAKE) $(jobs) all
	@BUILD=$(BUILD) bench/slurm/test.sh

# Plants each bug of tests/mutations/table.txt in a copy of the tree and runs the tests: results/mutations.md.
# This takes about half an hour. ONLY="text..." selects bugs whose name contains one of the texts.
mutations:
	@tests/support/scripts/dependencies.sh build test
	+@$(MAKE) $(jobs) $(UNITY_SOURCE) build/glmark2 build/assimp
	@BUILD=$(BUILD) tests/mutations/run.sh '$(ONLY)'

# Refuses every request to the system, one at a time, and every allocation.
soak-faults:
	@tests/support/scripts/dependencies.sh build test
	+@$(MAKE) $(jobs) all programs
	@tests/support/scripts/faults.sh $(BUILD)

# Measures memory on streams of 10 million triangles, 100,000 states, 100,000 shaders and a million constants.
soak-memory: $(BUILD)/tests/fault/memory
	@TRIPTYCH_SOAK=1 $<

# Writes the measured figures of the pages from results/, their listings from the command, and docs/states.md
# and docs/shaders.md from the tables.
docs: all
	@tests/support/scripts/dependencies.sh build test
	@python3 bench/figures write
	@for page in states shaders; do $(COMMAND) list $$page --markdown >$(BUILD)/$$page.md && mv $(BUILD)/$$page.md docs/$$page.md || exit; done
	@LISTINGS=write TRIPTYCH=$(COMMAND) tests/pages.sh

# Renders the pictures of docs/gallery.md, docs/shader-gallery.md and docs/inspecting.md, which are goldens,
# and those of docs/viewer.md: look at them before a commit.
gallery: all
	@GOLDENS=write TRIPTYCH=$(COMMAND) tests/goldens.sh $(wildcard tests/data/scenes/*.tri tests/data/shading/*.tri)
	@$(COMMAND) render tests/data/scenes/shadow-volume.tri --engine emulate --draws all --sheet 5 --out docs/images/draws.png
	@GOLDENS=write TRIPTYCH=$(COMMAND) tests/inspect.sh
	@GOLDENS=write TRIPTYCH=$(COMMAND) tests/view.sh

installed = $(DESTDIR)$(PREFIX)

install: all $(PAGES) $(COMPLETIONS)
	install -d $(installed)/bin $(installed)/include/triptych $(installed)/lib/pkgconfig
	install -m 755 $(COMMAND) $(installed)/bin/
	install -m 644 $(BUILD)/include/triptych/triptych.h $(installed)/include/triptych/
	install -m 644 $(BUILD)/libtriptych.a $(installed)/lib/
	install -m 755 $(BUILD)/$(SONAME) $(installed)/lib/
	ln -sf $(SONAME) $(installed)/lib/libtriptych.so
	install -m 644 $(PKGCONFIG) $(installed)/lib/pkgconfig/
	for file in $(patsubst $(BUILD)/%,%,$(wildcard $(D3D9)/*/*.dll $(D3D9)/*/*.so $(D3D9)/triptych-d3d9-server)); do install -D -m 755 $(BUILD)/$$file $(installed)/lib/triptych/$$file || exit; done
	for file in $(patsubst $(BUILD)/%,%,$(wildcard $(EGL)/*.so.0 $(EGL)/*.json)); do install -D -m 644 $(BUILD)/$$file $(installed)/lib/triptych/$$file || exit; done
	for file in $(patsubst $(BUILD)/%,%,$(PAGES) $(COMPLETIONS)); do install -D -m 644 $(BUILD)/$$file $(installed)/$$file || exit; done

clean:
	rm -rf $(BUILD)

# The compilation database, for clangd and other tools: every C source, and every header of the specification,
# because each header compiles by itself.
DATABASE_FILES = $(eval DATABASE_FILES := $(filter-out src/front/d3d9/pe/%,$(C_SOURCES)) \
  $(filter-out tests/front/d3d9/pe/% tests/front/egl/program/%,$(TEST_SOURCES)) $(BENCH_SOURCES) \
  $(call find,src/spec,*.h))$(DATABASE_FILES)
comma := ,
database_entry = {"directory": "$(CURDIR)", "file": "$(1)", \
  "command": "$(compile) $(if $(filter tests/%,$(1)),$(unity_flags)) -x c -c $(1)"}

$(BUILD)/compile_commands.json: $(WORDS) FORCE
	@mkdir -p $(@D)
	@$(file >$@.new,[)$(foreach f,$(DATABASE_FILES),$(file >>$@.new,$(call database_entry,$(f))$(if \
	  $(filter-out $(lastword $(DATABASE_FILES)),$(f)),$(comma))))$(file >>$@.new,])mv $@.new $@

compile_commands.json: $(BUILD)/compile_commands.json
	@cp $< $@

FORMATTED = $(call find,src emu asm tests bench,*.[ch])

format:
	@tests/support/scripts/dependencies.sh format
	clang-format -i $(FORMATTED)

format-check:
	@tests/support/scripts/dependencies.sh format
	clang-format --dry-run --Werror $(FORMATTED)

define help
make                 the library (static and shared) and the command, in $(BUILD)/
make test            all tests, starting from a bare Debian; ends with "N passed, N failed"
make check           the same tests on the plain build only
make bench           the measurements, starting from a bare Debian; writes results/, or with QUICK=1, which takes
                     short samples, $(BUILD)/bench/quick
make soak-faults     refuses every request to the system, one at a time: half an hour
make soak-memory     measures the memory of 10 million triangles and 100,000 states: minutes
make peers           measures Mesa's softpipe and llvmpipe, SwiftShader and every engine on the same work: results/peers.txt
                     (WORKLOAD=glob PEERS="name..." PASSES=n QUICK=1 CLOCK=time)
make conformance-d3d9  Wine's Direct3D 9 tests, on Triptych and on Wine's own Direct3D 9: results/conformance.md
make programs-d3d9   programs for Windows, on Triptych and on Wine's own Direct3D 9: results/programs.json
make programs-gles   programs of OpenGL ES, on Triptych and on llvmpipe: results/programs-gles.json
make profile-gles    instructions of a frame of these programs, by what they are for: results/profile-gles.json
make conformance-gles  Khronos' dEQP-GLES2 and dEQP-EGL, of which DEQP=folder has builds, on both: results/conformance-*.json
make conformance-piglit  piglit's tests of GLSL ES 1.00, of Debian's package piglit, on both: results/conformance-piglit.json
make bench-shaders   measures every shader in tests/data/shading, by shader and by length
make bench-passes    leaves passes of the specializer out, and measures the parts of a build
make bench-draws     draws per second of one small triangle, one change of the state before each
make bench-clients   a cipher, a filter and a matcher: kernels, plain C and libraries
make bench-targets   the time to draw to a texture and return to the target
make bench-scroll    the time and the pixels of frames of a page that draw only what changes
make claims          tests the claims of the thesis and of other renderers, an hour: results/claims.json, results/report
                     (ONLY=C156,S9 RESUME=1)
make soak            random cases and tests with new seeds, half an hour (DURATION=1800 SEED=1), then a summary
make fuzz-input      readers of untrusted input under libFuzzer, half an hour (DURATION=1800) each TARGET, JOBS at a time
make fuzz-input-smoke  the same in ten minutes
make campaign-slurm-test  a campaign on a Slurm of this machine, a node killed in the middle (CASES=600 SHARDS=8)
make matrix          compares builds of gcc and clang at -O0, -O2, -O3, with and without AVX-512: results/matrix.txt
make lab N           lab N of the course: its starting files in labs/, then its check (docs/course/README.md)
make labs            the checks of all labs, on their solutions, starting files and planted mistakes
make check-cross     texts in portable C, compiled for ARM64 and run by QEMU, against the emulator; installs both
make check-threads   all streams with several threads in random orders under ThreadSanitizer
make check-explore   the pages of triptych explore in a headless Chromium; PICTURES=folder: their pictures
make coverage        lists lines that the tests execute, results/coverage.txt; fails below 90 %
make mutations       plants bugs in a copy of the tree and checks that the tests find them: results/mutations.md
make verify-external every stream with the external engine: minutes of compiling
make docs            writes the measured figures of the pages from results/, their listings, and docs/states.md
make gallery         renders the pictures of docs/gallery.md, docs/shader-gallery.md, docs/inspecting.md and docs/viewer.md
make gles            OpenGL ES through EGL for programs of Linux: $(BUILD)/egl
make d3d9            Direct3D 9 for programs of Windows under Wine: $(BUILD)/d3d9; installs mingw-w64 and Wine
make install         PREFIX=$(PREFIX) DESTDIR=$(DESTDIR)
make dependencies    install every Debian package that any target needs
make packages        lists those packages and their purpose
make compile_commands.json  writes the compilation database, for clangd
make format          runs clang-format on the C sources; format-check only compares
make clean           remove $(BUILD)/

BUILD=dir  CC=clang  SANITIZE=address|thread  COVERAGE=1  CHECK_IR=1 (verify after each pass)
V=1 (show commands)  ONLY=text (tests whose path contains it)  UNDEFINED= (with SANITIZE=address, a message for each check)
CFLAGS=... (optimisation and debugging only)  UNITY_DIR=dir (a Unity checkout instead of the fetched one)
endef

help:
	@$(info $(help)):

-include $(OBJECTS:.o=.d) $(WIDE_OBJECTS:.obj=.d) $(NARROW_OBJECTS:.obj32=.32.d) $(wildcard $(ASM_INCLUDES:.inc=.d))
