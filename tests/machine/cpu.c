#include "machine/cpu.h"

#include <unity.h>

#include <stdlib.h>
#include <string.h>

/* A simulated processor: its leaves, its answers for leaves 1 and 7, and the state that the system saves. */
static struct {
    uint32_t leaves, leaf1_ecx, leaf7_ebx;
    uint64_t saved;
    const char *brand;
    int saved_state_asked;
} fake;

static struct cpu_registers fake_identify(uint32_t leaf)
{
    struct cpu_registers registers = {0};
    char brand[48] = {0};
    switch (leaf) {
    case 0: registers.eax = fake.leaves; break;
    case 1: registers.ecx = fake.leaf1_ecx; break;
    case 7: registers.ebx = fake.leaf7_ebx; break;
    case 0x80000000: registers.eax = fake.brand ? 0x80000004 : 0; break;
    case 0x80000002:
    case 0x80000003:
    case 0x80000004:
        memcpy(brand, fake.brand, strlen(fake.brand));
        memcpy(&registers, brand + 16 * (leaf - 0x80000002), sizeof registers);
        break;
    }
    return registers;
}

static uint64_t fake_saved_state(void)
{
    fake.saved_state_asked++;
    return fake.saved;
}

static struct cpu detect(void)
{
    return cpu_detect(&(struct cpu_system){fake_identify, fake_saved_state});
}

enum { XSAVE = 1 << 27, AVX = 1 << 28, FMA = 1 << 12, AVX2 = 1 << 5, AVX512F = 1 << 16, AVX512BW = 1 << 30 };

void setUp(void)
{
    memset(&fake, 0, sizeof fake);
    fake.leaves = 7;
    fake.leaf1_ecx = XSAVE | AVX | FMA;
    fake.leaf7_ebx = AVX2 | AVX512F;
    fake.saved = 0xe7;
}

void tearDown(void)
{
}

static void test_features_of_processor_and_system_are_all_reported(void)
{
    struct cpu cpu = detect();
    TEST_ASSERT_TRUE(cpu.has[CPU_avx]);
    TEST_ASSERT_TRUE(cpu.has[CPU_fma]);
    TEST_ASSERT_TRUE(cpu.has[CPU_avx2]);
    TEST_ASSERT_TRUE(cpu.has[CPU_avx512f]);
    TEST_ASSERT_FALSE(cpu.has[CPU_avx512bw]);
}

static void test_a_system_that_does_not_save_ymm_hides_avx(void)
{
    fake.saved = 0x3;
    struct cpu cpu = detect();
    for (int i = 0; i < CPU_FEATURE_COUNT; i++)
        TEST_ASSERT_FALSE(cpu.has[i]);
}

static void test_a_system_that_does_not_save_zmm_hides_avx512_only(void)
{
    fake.saved = 0x7;
    struct cpu cpu = detect();
    TEST_ASSERT_TRUE(cpu.has[CPU_avx2]);
    TEST_ASSERT_FALSE(cpu.has[CPU_avx512f]);
}

static void test_xgetbv_is_not_executed_where_it_does_not_exist(void)
{
    fake.leaf1_ecx = AVX | FMA;
    struct cpu cpu = detect();
    TEST_ASSERT_EQUAL_INT(0, fake.saved_state_asked);
    TEST_ASSERT_FALSE(cpu.has[CPU_avx]);
}

static void test_leaves_beyond_the_last_are_ignored(void)
{
    fake.leaves = 6;
    struct cpu cpu = detect();
    TEST_ASSERT_TRUE(cpu.has[CPU_fma]);
    TEST_ASSERT_FALSE(cpu.has[CPU_avx2]);
}

static void test_the_model_is_trimmed_and_never_empty(void)
{
    TEST_ASSERT_EQUAL_STRING("unknown", detect().model);
    fake.brand = "   Example(R) Processor 9 @ 1 GHz   ";
    TEST_ASSERT_EQUAL_STRING("Example(R) Processor 9 @ 1 GHz", detect().model);
    fake.brand = "exactly forty-eight characters of a brand string";
    TEST_ASSERT_EQUAL_STRING(fake.brand, detect().model);
}

static struct cpu hide(const char *mask)
{
    struct cpu cpu = detect();
    struct error error = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, cpu_hide(&cpu, mask, &error), error.text);
    return cpu;
}

static void test_features_in_the_mask_are_hidden(void)
{
    struct cpu cpu = hide("-fma,-avx512f");
    TEST_ASSERT_TRUE(cpu.has[CPU_avx]);
    TEST_ASSERT_TRUE(cpu.has[CPU_avx2]);
    TEST_ASSERT_FALSE(cpu.has[CPU_fma]);
    TEST_ASSERT_TRUE(cpu.hidden[CPU_fma]);
    TEST_ASSERT_FALSE(cpu.has[CPU_avx512f]);
    TEST_ASSERT_TRUE(cpu.hidden[CPU_avx512f]);
    cpu = hide("");
    TEST_ASSERT_TRUE(cpu.has[CPU_avx512f]);
}

static void test_features_that_need_a_hidden_feature_are_hidden_too(void)
{
    fake.leaf7_ebx |= AVX512BW;
    struct cpu cpu = hide("-avx2");
    TEST_ASSERT_TRUE(cpu.has[CPU_fma]);
    TEST_ASSERT_TRUE(cpu.hidden[CPU_avx2] && cpu.hidden[CPU_avx512f] && cpu.hidden[CPU_avx512bw]);
    TEST_ASSERT_FALSE(cpu.has[CPU_avx2] || cpu.has[CPU_avx512f] || cpu.has[CPU_avx512bw]);
    cpu = hide("-avx");
    for (int i = 0; i < CPU_FEATURE_COUNT; i++)
        TEST_ASSERT_FALSE(cpu.has[i]);
}

static void test_a_missing_feature_is_not_hidden(void)
{
    struct cpu cpu = hide("-avx512vl");
    TEST_ASSERT_FALSE(cpu.has[CPU_avx512vl]);
    TEST_ASSERT_FALSE(cpu.hidden[CPU_avx512vl]);
}

static void test_any_other_mask_hides_nothing(void)
{
    static const char *const masks[] = {
        "avx2",        "+avx2",       "-avx3",      "-",     "-avx2,",  ",-avx2",       "-avx2 ",
        "-avx2,,-fma", "-avx2,-fmaa", "-avx2;-fma", "-AVX2", "-avx512", "-fma,-avx2,-", " "};
    for (size_t i = 0; i < sizeof masks / sizeof *masks; i++) {
        struct cpu cpu = detect(), before = cpu;
        struct error error = {""};
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, cpu_hide(&cpu, masks[i], &error), masks[i]);
        TEST_ASSERT_NOT_NULL(strstr(error.text, masks[i]));
        TEST_ASSERT_NOT_NULL(strstr(error.text, "-avx512f, "));
        TEST_ASSERT_EQUAL_MEMORY(&before, &cpu, sizeof cpu);
    }
}

/* Only if no feature is hidden: the compiler ignores the mask. */
static void test_this_machine_agrees_with_the_compiler(void)
{
    if (getenv("TRIPTYCH_CPU"))
        TEST_IGNORE_MESSAGE("TRIPTYCH_CPU is set");
    __builtin_cpu_init();
    const struct cpu *cpu = cpu_native();
    TEST_ASSERT_EQUAL(!!__builtin_cpu_supports("avx2"), cpu->has[CPU_avx2]);
    TEST_ASSERT_EQUAL(!!__builtin_cpu_supports("fma"), cpu->has[CPU_fma]);
    TEST_ASSERT_EQUAL(!!__builtin_cpu_supports("avx512f"), cpu->has[CPU_avx512f]);
    TEST_ASSERT_EQUAL(!!__builtin_cpu_supports("avx512vl"), cpu->has[CPU_avx512vl]);
    TEST_ASSERT_EQUAL(cpu->has[CPU_avx2] && cpu->has[CPU_fma], cpu_has_avx2_fma());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_features_of_processor_and_system_are_all_reported);
    RUN_TEST(test_a_system_that_does_not_save_ymm_hides_avx);
    RUN_TEST(test_a_system_that_does_not_save_zmm_hides_avx512_only);
    RUN_TEST(test_xgetbv_is_not_executed_where_it_does_not_exist);
    RUN_TEST(test_leaves_beyond_the_last_are_ignored);
    RUN_TEST(test_the_model_is_trimmed_and_never_empty);
    RUN_TEST(test_features_in_the_mask_are_hidden);
    RUN_TEST(test_features_that_need_a_hidden_feature_are_hidden_too);
    RUN_TEST(test_a_missing_feature_is_not_hidden);
    RUN_TEST(test_any_other_mask_hides_nothing);
    RUN_TEST(test_this_machine_agrees_with_the_compiler);
    return UNITY_END();
}
