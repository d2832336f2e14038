/* Generated routines as callees. The checked trampoline calls thousands of routines of every engine that
 * generates code, in every unit, on random data. They keep the calling convention, do not write to their
 * inputs or outside of their outputs, and agree with each other. Their code depends only on their key: a
 * routine that is built again at another address, in another arena, after another routine or in another
 * process has the same bytes. */
#define _GNU_SOURCE
#include "machine/code.h"
#include "engines/list.h"
#include "engines/stitch/fragment.h"
#include "tests/support/differential/differential.h"
#include "tests/support/routine/routines.h"
#include "tests/support/system/seed.h"
#include "tests/support/differential/trampoline.h"
#include "engines/tiered/tiered.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>
#include <xxhash.h>

enum { ENGINES = 32, RANDOM_KEYS = 450, RANDOM_SHADERS = 120, HASHED_KEYS = 90 };

static struct code_arena *arena, *other;
static struct differential *differential;
static const struct engine *engines[ENGINES];
static unsigned engine_count;
static uint64_t seed;

static void find_engines(void)
{
    engine_count = 0;
    for (unsigned i = 0; engine_at(i) && engine_count < ENGINES; i++) {
        const struct engine *engine = engine_at(i);
        if (!engine->without_arena && !engine_unavailable(engine) && !tiered_engine(engine, 0))
            engines[engine_count++] = engine;
    }
    if (!engine_count)
        TEST_IGNORE_MESSAGE("no engine can generate code here");
}

void setUp(void)
{
    struct error error = {{0}};
    find_engines();
    arena = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
    other = code_create(0, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(other, error.text);
    differential = differential_create(arena);
    TEST_ASSERT_NOT_NULL(differential);
    seed = test_seed();
}

void tearDown(void)
{
    differential_destroy(differential);
    code_destroy(arena);
    code_destroy(other);
    differential = NULL;
    arena = other = NULL;
}

/* --- The harness ------------------------------------------------------------------------------------- */

/* Each function breaks one rule. */
static void test_violations_are_reported(void)
{
    static const struct {
        const char *name;
        uint8_t code[24];
    } offence[] = {
        {"does not restore rbx", {0x48, 0xff, 0xc3, 0xc3}},                      /* inc rbx */
        {"does not restore rbp", {0x48, 0xff, 0xc5, 0xc3}},                      /* inc rbp */
        {"does not restore r12", {0x49, 0xff, 0xc4, 0xc3}},                      /* inc r12 */
        {"does not restore r15", {0x49, 0xff, 0xc7, 0xc3}},                      /* inc r15 */
        {"returns with rsp 8 bytes off", {0xc2, 0x08, 0x00}},                    /* ret 8 */
        {"returns with the direction flag set", {0xc5, 0xfc, 0x77, 0xfd, 0xc3}}, /* vzeroall; std */
        {"does not restore MXCSR",
         {0x6a, 0x00, 0xc7, 0x04, 0x24, 0x80, 0x1f, 0x00, 0x00, 0x0f, 0xae, 0x14, 0x24, 0x58, 0xc3}},
        /* push 0; mov dword [rsp], 0x1f80; ldmxcsr [rsp]; pop rax */
        {"upper half of vector register 0", {0xc3}},
        {"upper half of vector register 1",
         {0xc5, 0xf8, 0x57, 0xc0, 0xc3}}, /* vxorps xmm0, xmm0, xmm0 clears it, 1 is left */
        {"writes to its caller's frame", {0xc5, 0xf8, 0x77, 0x48, 0x89, 0x7c, 0x24, 0x08, 0xc3}},
        /* vzeroupper; mov [rsp + 8], rdi */
    };
    static const uint8_t innocent[] = {0xc5, 0xf8, 0x77,
                                       0x50, 0x58, 0xc3}; /* vzeroupper; push rax; pop rax */
    struct code_span span;
    struct error error = {{0}};
    for (size_t i = 0; i <= sizeof offence / sizeof *offence; i++) {
        int good = i == sizeof offence / sizeof *offence;
        TEST_ASSERT_EQUAL_INT(0, code_reserve(arena, 64, &span, &error));
        memcpy(span.writable, good ? innocent : offence[i].code,
               good ? sizeof innocent : sizeof offence[i].code);
        const char *found = trampoline_call(code_commit(arena, &span, 64), NULL, NULL, 0x7f80, &seed);
        const char *expected = good ? NULL : offence[i].name;
        int noticed = found && expected && strstr(found, expected);
        TEST_ASSERT_TRUE_MESSAGE(good ? !found : noticed, found ? found : expected);
        code_free(arena, &span);
    }
}

/* --- Routines ---------------------------------------------------------------------------------------- */

static struct routine *build(const struct engine *engine, struct code_arena *where, enum unit unit,
                             const union key *key)
{
    struct error error = {{0}};
    struct routine *routine = engine_build(engine, where, unit, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    return routine;
}

/* The last keys without a shader. A key with a shader may name one that no longer exists. */
static union key between[UNIT_ALL];

/* Builds the key twice. Between them a routine of another key is built, so that the second build has another
 * address. */
static void expect_same_bytes(const struct engine *engine, enum unit unit, const union key *key)
{
    static char message[KEY_TEXT_CAPACITY + 200];
    char text[KEY_TEXT_CAPACITY];
    struct routine *first = build(engine, arena, unit, key);
    struct routine *second = build(engine, other, unit, &between[unit]);
    struct routine *third = build(engine, other, unit, key);
    int same = first->code_bytes == third->code_bytes && first->constant_bytes == third->constant_bytes &&
               first->parts == third->parts && first->spills == third->spills &&
               (!first->code_bytes || !memcmp(first->code, third->code, first->code_bytes));
    snprintf(message, sizeof message, "%s is not the same again; %s key: %s", engine->name, unit_name[unit],
             key_print(unit, key, text));
    engine->free(arena, first);
    engine->free(other, second);
    engine->free(other, third);
    TEST_ASSERT_TRUE_MESSAGE(same, message);
}

/* Tries every second engine, and with sanitizers every fifth, from key to key others. */
static void check(void *context, enum unit unit, const union key *key)
{
    static unsigned number;
    const struct engine *tried[ENGINES];
    unsigned count = 0, stride = test_step(2, 5);
    (void)context;
    for (unsigned e = number++ % stride; e < engine_count; e += stride)
        tried[count++] = engines[e];
    for (unsigned e = 0; e < count; e++)
        expect_same_bytes(tried[e], unit, key);
    if (!key_shader(unit, key))
        between[unit] = *key;
    const char *found = differential_run(differential, tried, count, unit, key, seed);
    if (found)
        TEST_FAIL_MESSAGE(found);
}

/* --- Another process --------------------------------------------------------------------------------- */

/* Clears the only address in code, that of the stitcher's constants, which differs between processes. */
static void forget_address(uint8_t *code, size_t bytes)
{
    const void *address = stitch_constants;
    for (uint8_t *at = code; (at = memmem(at, (size_t)(code + bytes - at), &address, sizeof address));)
        memset(at, 0, sizeof address);
}

static void hash_bytes(void *hash, enum unit unit, const union key *key)
{
    for (unsigned e = 0; e < engine_count; e++) {
        static uint8_t code[1 << 20];
        struct routine *routine = build(engines[e], arena, unit, key);
        TEST_ASSERT_LESS_OR_EQUAL(sizeof code, routine->code_bytes);
        if (routine->code_bytes) /* none of the vertices of mixed, which emulate draws */
            memcpy(code, routine->code, routine->code_bytes);
        forget_address(code, routine->code_bytes);
        *(uint64_t *)hash = XXH3_64bits_withSeed(code, routine->code_bytes, *(uint64_t *)hash);
        engines[e]->free(arena, routine);
    }
}

static uint64_t hash_of_many(void)
{
    uint64_t hash = 0;
    visit_random_keys(test_share_of(HASHED_KEYS, 9), test_seed(), hash_bytes, &hash);
    visit_shaders(test_seed(), hash_bytes, &hash);
    return hash;
}

/* In another process all addresses differ. */
static void test_another_process_makes_the_same_bytes(void)
{
    unsigned long long other_hash = 0;
    FILE *process = popen("/proc/$PPID/exe hash", "r");
    TEST_ASSERT_NOT_NULL(process);
    int items = fscanf(process, "%llx", &other_hash);
    TEST_ASSERT_EQUAL_INT(0, pclose(process));
    TEST_ASSERT_EQUAL_INT(1, items);
    TEST_ASSERT_EQUAL_HEX64(hash_of_many(), other_hash);
}

static int print_hash(void)
{
    setUp();
    printf("%llx\n", (unsigned long long)hash_of_many());
    tearDown();
    return 0;
}

/* --- Many routines ------------------------------------------------------------------------------------- */

static void test_routines_of_random_keys(void)
{
    unsigned keys = test_share_of(RANDOM_KEYS, 9);
    TEST_ASSERT_GREATER_THAN(keys / 2, visit_random_keys(keys, seed, check, NULL));
}

static void test_routines_of_the_shaders(void)
{
    TEST_ASSERT_GREATER_THAN(test_share_of(100, 9), visit_shaders(seed, check, NULL));
}

static void test_routines_of_random_shaders(void)
{
    unsigned shaders = test_share_of(RANDOM_SHADERS, 9);
    TEST_ASSERT_GREATER_THAN(shaders / 2, visit_random_shaders(shaders, seed, check, NULL));
}

static void test_routines_of_the_streams(void)
{
    TEST_ASSERT_GREATER_THAN(test_share_of(500, 9), visit_streams(check, NULL));
}

int main(int count, char **arguments)
{
    visit_fewer();
    if (count > 1 && !strcmp(arguments[1], "hash"))
        return print_hash();
    UNITY_BEGIN();
    RUN_TEST(test_violations_are_reported);
    RUN_TEST(test_another_process_makes_the_same_bytes);
    RUN_TEST(test_routines_of_random_keys);
    RUN_TEST(test_routines_of_the_shaders);
    RUN_TEST(test_routines_of_random_shaders);
    RUN_TEST(test_routines_of_the_streams);
    return UNITY_END();
}
