/* What this processor and operating system together let code use.
 *
 * CPUID says what the processor can do; XGETBV (XCR0) says which registers the operating system saves. A
 * feature counts only when both agree: without the second, another process would find its registers in ours.
 * The features are the rows of def/cpu.def. */
#ifndef BASE_CPU_H
#define BASE_CPU_H

#include <stdbool.h>
#include <stdint.h>

enum cpu_feature {
#define FEATURE(name, leaf, register, bit, state, meaning) CPU_##name,
#include "def/cpu.def"
#undef FEATURE
    CPU_FEATURE_COUNT
};

struct cpu_registers {
    uint32_t eax, ebx, ecx, edx;
};

/* The two instructions that are asked; tests replace them. `identify` is CPUID with eax = leaf, ecx = 0;
 * `saved_state` is XGETBV with ecx = 0, asked only where CPUID says that the instruction exists (OSXSAVE). */
struct cpu_system {
    struct cpu_registers (*identify)(uint32_t leaf);
    uint64_t (*saved_state)(void);
};

struct cpu {
    char model[49]; /* the brand string without surrounding spaces, or "unknown" */
    bool has[CPU_FEATURE_COUNT];
};

/* Asks `system`. */
struct cpu cpu_detect(const struct cpu_system *system);

/* This machine, asked once (CPUID is slow in virtual machines). Thread-safe. */
const struct cpu *cpu_native(void);

/* Whether code that needs x86-64-v3's vector part runs here: AVX, AVX2, FMA and F16C, which no
 * processor with AVX2 lacks. */
bool cpu_has_avx2_fma(void);

/* The feature's name as in /proc/cpuinfo, and what it is, for lists. */
const char *cpu_feature_name(enum cpu_feature feature);
const char *cpu_feature_meaning(enum cpu_feature feature);

#endif
