#include "base/cpu.h"

#include <cpuid.h>
#include <pthread.h>
#include <string.h>

/* XCR0: bit 1 SSE, bit 2 the upper halves of ymm; bits 5 to 7 mask registers and the rest of zmm. */
enum { STATE_YMM = 0x06, STATE_ZMM = 0xe6 };

enum { LEAF_FEATURES = 1, LEAF_EXTENDED_MAXIMUM = 0x80000000, LEAF_BRAND = 0x80000002 };

static const uint32_t osxsave = 1u << 27; /* leaf 1, ecx: XGETBV exists and the system uses it */

enum { EAX, EBX, ECX, EDX };

static const struct {
    const char *name, *meaning;
    uint8_t leaf, from, bit, state;
} features[CPU_FEATURE_COUNT] = {
#define FEATURE(name, leaf, register, bit, state, meaning) {#name, meaning, leaf, register, bit, state},
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
        /* Beyond the highest leaf, processors answer with some other leaf's data. */
        if (features[i].leaf > leaves || (saved & features[i].state) != features[i].state)
            continue;
        struct cpu_registers registers = system->identify(features[i].leaf);
        cpu.has[i] = field(&registers, features[i].from) >> features[i].bit & 1;
    }
    return cpu;
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

static struct cpu native;

static void detect_native(void)
{
    native = cpu_detect(&(struct cpu_system){native_identify, native_saved_state});
}

const struct cpu *cpu_native(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, detect_native);
    return &native;
}

bool cpu_has_avx2_fma(void)
{
    const struct cpu *cpu = cpu_native();
    return cpu->has[CPU_avx] && cpu->has[CPU_avx2] && cpu->has[CPU_fma] && cpu->has[CPU_f16c];
}

const char *cpu_feature_name(enum cpu_feature feature)
{
    return features[feature].name;
}

const char *cpu_feature_meaning(enum cpu_feature feature)
{
    return features[feature].meaning;
}
