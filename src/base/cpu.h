/* What this processor and operating system together let code use.
 *
 * CPUID says what the processor can do; XGETBV (XCR0) says which registers the operating system saves. A
 * feature counts only when both agree: without the second, another process would find its registers in ours.
 * The features are the rows of def/cpu.def.
 *
 * The environment can hide features, so that one machine shows what a lesser one would do: the value of
 * TRIPTYCH_CPU is a list such as "-avx512f" or "-fma,-avx512vl". What builds on a hidden feature is hidden
 * too. Nothing else in the project asks the processor, so what is hidden here is used nowhere. */
#ifndef BASE_CPU_H
#define BASE_CPU_H

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

/* The two instructions that are asked; tests replace them. `identify` is CPUID with eax = leaf, ecx = 0;
 * `saved_state` is XGETBV with ecx = 0, asked only where CPUID says that the instruction exists (OSXSAVE). */
struct cpu_system {
    struct cpu_registers (*identify)(uint32_t leaf);
    uint64_t (*saved_state)(void);
};

struct cpu {
    char model[49]; /* the brand string without surrounding spaces, or "unknown" */
    bool has[CPU_FEATURE_COUNT];
    bool hidden[CPU_FEATURE_COUNT]; /* it would, were it not for the mask */
};

/* Asks `system`. */
struct cpu cpu_detect(const struct cpu_system *system);

/* Hides the features that `mask` names, each with a minus in front, separated by commas. Returns 0, or -1
 * with the reason and nothing hidden when the mask says anything else. */
int cpu_hide(struct cpu *cpu, const char *mask, struct error *error);

/* This machine without what TRIPTYCH_CPU hides, asked once (CPUID is slow in virtual machines). Thread-safe.
 */
const struct cpu *cpu_native(void);

/* What is wrong with TRIPTYCH_CPU: nothing has been hidden then, and nothing should be run. Null: it is good.
 */
const char *cpu_native_error(void);

/* Why code that needs x86-64-v3's vector part cannot run here: AVX, AVX2, FMA and F16C, which no processor
 * with AVX2 lacks. Null: it can. */
const char *cpu_lacks_avx2_fma(void);
static inline bool cpu_has_avx2_fma(void)
{
    return !cpu_lacks_avx2_fma();
}

/* Why code of 512-bit vectors with 16 and 32-bit elements cannot run here: AVX-512 F, DQ, BW and VL. Null: it can. */
const char *cpu_lacks_avx512(void);

/* The feature's name as in /proc/cpuinfo, and what it is, for lists. */
const char *cpu_feature_name(enum cpu_feature feature);
const char *cpu_feature_meaning(enum cpu_feature feature);

#endif
