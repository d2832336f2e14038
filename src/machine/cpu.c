#define _GNU_SOURCE /* secure_getenv */
#include "machine/cpu.h"
#include "base/words.h"

#include <cpuid.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* XCR0: bit 1 SSE, bit 2 the upper halves of ymm; bits 5 to 7 mask registers and the rest of zmm. */
enum { STATE_YMM = 0x06, STATE_ZMM = 0xe6 };

enum { LEAF_FEATURES = 1, LEAF_EXTENDED_MAXIMUM = 0x80000000, LEAF_BRAND = 0x80000002 };

static const uint32_t osxsave = 1u << 27; /* leaf 1, ecx: XGETBV exists and the system enabled it */

enum { EAX, EBX, ECX, EDX };

static const struct {
    const char *name, *meaning;
    uint8_t needs, leaf, from, bit, state;
} features[CPU_FEATURE_COUNT] = {
#define FEATURE(name, needs, leaf, register, bit, state, meaning)                                            \
    {#name, meaning, CPU_##needs, leaf, register, bit, state},
#include "def/cpu.def"
#undef FEATURE
};

static uint32_t field(const struct cpu_registers *registers, unsigned from)
{
    const uint32_t value[] = {registers->eax, registers->ebx, registers->ecx, registers->edx};
    return value[from];
}

/* Some brand strings are padded with spaces on either side. */
static void read_model(const struct cpu_system *system, char model[static 49])
{
    memset(model, 0, 49);
    if (system->identify(LEAF_EXTENDED_MAXIMUM).eax >= LEAF_BRAND + 2)
        for (unsigned i = 0; i < 3; i++) {
            struct cpu_registers part = system->identify(LEAF_BRAND + i);
            memcpy(model + 16 * i, &part, sizeof part);
        }
    memmove(model, model + strspn(model, " "), strlen(model + strspn(model, " ")) + 1);
    for (size_t length = strlen(model); length && model[length - 1] == ' ';)
        model[--length] = 0;
    if (!model[0])
        strcpy(model, "unknown");
}

struct cpu cpu_detect(const struct cpu_system *system)
{
    struct cpu cpu = {0};
    read_model(system, cpu.model);
    uint32_t leaves = system->identify(0).eax;
    struct cpu_registers basic = system->identify(LEAF_FEATURES);
    uint64_t saved = basic.ecx & osxsave ? system->saved_state() : 0;
    for (int i = 0; i < CPU_FEATURE_COUNT; i++) {
        /* Above the highest leaf, processors return the data of another leaf. */
        if (features[i].leaf > leaves || (saved & features[i].state) != features[i].state)
            continue;
        struct cpu_registers registers = system->identify(features[i].leaf);
        cpu.has[i] = field(&registers, features[i].from) >> features[i].bit & 1;
    }
    return cpu;
}

/* The feature with that name, of `length` characters; CPU_FEATURE_COUNT if there is none. */
static unsigned find_feature(const char *name, size_t length)
{
    unsigned i = 0;
    while (i < CPU_FEATURE_COUNT &&
           (strlen(features[i].name) != length || memcmp(features[i].name, name, length) != 0))
        i++;
    return i;
}

/* The words have no sign, in `features` or in the suggestion. */
static int refuse_mask(const char *mask, const char *wrong, struct error *error)
{
    char names[ERROR_CAPACITY] = "";
    for (unsigned i = 0; i < CPU_FEATURE_COUNT; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s-%s", i ? ", " : "",
                 features[i].name);
    error_set(error, "TRIPTYCH_CPU is \"%.80s\", expected what to hide, separated by commas, of %s", mask,
              names);
    wrong += *wrong == '-';
    return words_suggest_in(WORDS_OF_ROWS(features), wrong, strcspn(wrong, ","), error);
}

int cpu_hide(struct cpu *cpu, const char *mask, struct error *error)
{
    bool hide[CPU_FEATURE_COUNT] = {false};
    for (const char *at = mask; *at;) {
        size_t length = strcspn(at, ",");
        unsigned feature = at[0] == '-' ? find_feature(at + 1, length - 1) : CPU_FEATURE_COUNT;
        if (feature == CPU_FEATURE_COUNT || (at[length] && !at[length + 1]))
            return refuse_mask(mask, at, error);
        hide[feature] = true;
        at += length + (at[length] == ',');
    }
    /* A required feature has an earlier row, so one pass reaches all features that depend on it. */
    for (unsigned i = 0; i < CPU_FEATURE_COUNT; i++) {
        hide[i] |= hide[features[i].needs];
        cpu->hidden[i] |= hide[i] && cpu->has[i];
        cpu->has[i] &= !hide[i];
    }
    return 0;
}

static struct cpu_registers native_identify(uint32_t leaf)
{
    struct cpu_registers registers;
    __cpuid_count(leaf, 0, registers.eax, registers.ebx, registers.ecx, registers.edx);
    return registers;
}

static uint64_t native_saved_state(void)
{
    uint32_t low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return (uint64_t)high << 32 | low;
}

/* Distinguishes hidden from missing features. Missing ones are reported first. */
static const char *lacks(const struct cpu *cpu, const uint8_t *needed, unsigned count, const char *hidden,
                         const char *missing)
{
    const char *reason = NULL;
    for (unsigned i = 0; i < count; i++)
        if (cpu->hidden[needed[i]])
            reason = hidden;
        else if (!cpu->has[needed[i]])
            return missing;
    return reason;
}

static const char *lacks_avx2_fma(const struct cpu *cpu)
{
    static const uint8_t needed[] = {CPU_avx, CPU_avx2, CPU_fma, CPU_f16c};
    return lacks(cpu, needed, sizeof needed, "needs AVX2 and FMA, which TRIPTYCH_CPU hides",
                 "needs AVX2 and FMA, which this processor or system does not offer");
}

static const char *lacks_avx512(const struct cpu *cpu)
{
    static const uint8_t needed[] = {CPU_avx512f, CPU_avx512dq, CPU_avx512bw, CPU_avx512vl};
    return lacks(cpu, needed, sizeof needed, "needs AVX-512 F, DQ, BW and VL, which TRIPTYCH_CPU hides",
                 "needs AVX-512 F, DQ, BW and VL, which this processor or system does not offer");
}

static struct cpu native;
static struct error native_error;
static const char *native_lacks_avx2_fma, *native_lacks_avx512; /* needed for each tile */

static void detect_native(void)
{
    const char *mask = secure_getenv("TRIPTYCH_CPU");
    native = cpu_detect(&(struct cpu_system){native_identify, native_saved_state});
    if (mask)
        cpu_hide(&native, mask, &native_error);
    native_lacks_avx2_fma = lacks_avx2_fma(&native);
    native_lacks_avx512 = lacks_avx512(&native);
}

const struct cpu *cpu_native(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, detect_native);
    return &native;
}

const char *cpu_native_error(void)
{
    cpu_native();
    return native_error.text[0] ? native_error.text : NULL;
}

const char *cpu_lacks_avx2_fma(void)
{
    cpu_native();
    return native_lacks_avx2_fma;
}

const char *cpu_lacks_avx512(void)
{
    cpu_native();
    return native_lacks_avx512;
}

const char *cpu_feature_name(enum cpu_feature feature)
{
    return features[feature].name;
}

const char *cpu_feature_meaning(enum cpu_feature feature)
{
    return features[feature].meaning;
}
