/* The instruction-set extensions that this processor and its operating system support.
 *
 * CPUID reports what the processor can do; XGETBV (XCR0) reports which registers the operating system saves.
 * A feature counts only if both agree: otherwise another process could read or change its registers. The
 * features are the rows of def/cpu.def.
 *
 * The environment can hide features, to simulate a processor with fewer: TRIPTYCH_CPU is a list such as
 * "-avx512f" or "-fma,-avx512vl". Features that depend on a hidden one are hidden too. No other code of the
 * project queries the processor, so a hidden feature is not used anywhere. */
#ifndef MACHINE_CPU_H
#define MACHINE_CPU_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

enum cpu_feature {
#define FEATURE(name, needs, leaf, register, bit, state, meaning) CPU_##name,
#include "def/cpu.def"
#undef FEATURE
    CPU_FEATURE_COUNT
};

struct cpu_registers {
    uint32_t eax, ebx, ecx, edx;
};

/* The two instructions that query the machine; tests replace them. `identify` is CPUID with eax = leaf, ecx =
 * 0. `saved_state` is XGETBV with ecx = 0; it is called only if CPUID reports that the instruction exists
 * (OSXSAVE). */
struct cpu_system {
    struct cpu_registers (*identify)(uint32_t leaf);
    uint64_t (*saved_state)(void);
};

struct cpu {
    char model[49]; /* the brand string without surrounding spaces, or "unknown" */
    bool has[CPU_FEATURE_COUNT];
    bool hidden[CPU_FEATURE_COUNT]; /* present, but hidden by the mask */
};

/* Detects the features of `system`. For tests: a simulated processor. */
struct cpu cpu_detect(const struct cpu_system *system);

/* Hides the features that `mask` names, each after a minus, separated by commas. If the mask is malformed,
 * returns -1 with the reason and hides nothing; else returns 0. For tests: masks of a simulated processor. */
int cpu_hide(struct cpu *cpu, const char *mask, struct error *error);

/* This machine without the features that TRIPTYCH_CPU hides. Detected once, because CPUID is slow in virtual
 * machines. Thread-safe. */
const struct cpu *cpu_native(void);

/* The error in TRIPTYCH_CPU, or null. After an error nothing is hidden, and nothing should be run. */
const char *cpu_native_error(void);

/* The reason why code with the vector part of x86-64-v3 cannot run here, or null: AVX, AVX2, FMA and F16C,
 * which every processor with AVX2 has. */
const char *cpu_lacks_avx2_fma(void);
static inline bool cpu_has_avx2_fma(void)
{
    return !cpu_lacks_avx2_fma();
}

/* The reason why code with 512-bit vectors of 16-bit and 32-bit elements cannot run here, or null: AVX-512 F,
 * DQ, BW and VL. */
const char *cpu_lacks_avx512(void);

/* The feature's name as in /proc/cpuinfo, and its description. */
const char *cpu_feature_name(enum cpu_feature feature);
const char *cpu_feature_meaning(enum cpu_feature feature);

#endif
