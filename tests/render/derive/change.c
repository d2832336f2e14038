/* Deriving the changed parts of the state gives the same bytes as deriving all of it, whatever changes.
 *
 * In every situation of tests/support/picture/situation.def every setter of the interface is called, and
 * every state of the tables is set to each of its values. After each call the device derives the parts
 * that the setter names, and a second derivation, which keeps nothing, derives everything. The device keeps
 * the sources of keys from call to call, so a source that leaves out a state gives the keys of another one.
 * The opposite is checked too: if a named part is omitted, some situation must differ. So no setter names
 * too many parts, and the comparison detects each of them. Builds with sanitizers change some settings and
 * states in each situation, from situation to situation others. */
#include "render/device/device.h"
#include "tests/support/change/setting.h"
#include "tests/support/picture/situation.h"
#include "tests/support/system/bytes.h"
#include "tests/support/system/seed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static const struct {
    const char *name, *description;
} situations[] = {
#define SITUATION(name, description) {name, description},
#define GATE(holds, means_nothing)
#include "tests/support/picture/situation.def"
#undef SITUATION
#undef GATE
    {"skinned", "state lighting false state vertexblend 3weights state indexedvertexblendenable true"},
    {"in the window", "attribute positiont float4 state lighting false"},
    {"user clip planes", "state lighting false state clipplaneenable 5"},
    {"w-buffer", "state lighting false state zenable usew"},
};

enum { SITUATIONS = sizeof situations / sizeof *situations };

static enum triptych_primitive drawn;

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(setting_device))

void setUp(void)
{
    setting_begin();
}

void tearDown(void)
{
    setting_end();
}

static void update(void)
{
    OK(device_derived_update(&setting_device->derived, &setting_device->state, drawn, setting_device->epoch,
                             &setting_device->errors.last));
}

/* Sets the device's state to the situation's. Returns false if the situation is not supported. */
static bool enter(const char *description)
{
    static struct situation situation;
    situation_start(&situation);
    if (situation_add(&situation, description))
        return false;
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        situation.state.registers[stage] = &setting_device->registers[stage];
    setting_device->state = situation.state;
    drawn = situation.drawn;
    device_state_changed(setting_device, PARTS_ALL);
    update();
    return true;
}

/* --- Comparing --- */

struct derived {
    union key key[UNIT_COUNT];
    struct job job;
    struct draw draw;
    uint64_t vertices;
    struct palette_entry palette[WORLD_MATRICES];
};

static void take(const struct device_derived *from, struct derived *derived)
{
    const struct derived_source *now = from->now;
    memset(derived, 0, sizeof *derived);
    memcpy(derived->key, now->key, sizeof derived->key);
    memcpy(&derived->job, &now->job, sizeof derived->job);
    memcpy(&derived->draw, &now->draw, sizeof derived->draw);
    derived->vertices = now->vertices;
    if (now->job.palette)
        memcpy(derived->palette, now->job.palette, sizeof derived->palette);
    derived->job.palette = NULL;
}

/* Derives, and frees the palettes, which otherwise stay until something is rendered. */
static void derive(struct derived *derived)
{
    update();
    take(&setting_device->derived, derived);
    triptych_finish(setting_device);
}

/* Derives everything from the state, without anything that was derived before. */
static void derive_whole(struct derived *derived)
{
    static struct device_derived fresh;
    memset(&fresh, 0, sizeof fresh);
    device_derived_initialize(&fresh);
    OK(device_derived_update(&fresh, &setting_device->state, drawn, 0, &setting_device->errors.last));
    take(&fresh, derived);
    device_free_palettes(fresh.palettes);
}

static const char *print(const char *situation, const char *setter, unsigned value)
{
    static char text[256];
    snprintf(text, sizeof text, "%s: %s %u", situation, setter, value);
    return text;
}

/* Derives all named parts, everything from scratch, and all but each one of the parts. Adds the parts whose
 * omission makes a difference to `needed`. */
static void compare(const char *what, unsigned *named, unsigned *needed)
{
    static struct derived by_parts, whole, before;
    struct device_derived *derived = &setting_device->derived;
    unsigned stale = derived->changed;
    take(derived, &before);
    derive(&by_parts);
    derive_whole(&whole);
    TEST_ASSERT_SAME_BYTES(&whole, &by_parts, sizeof whole, what);
    if (!named || stale & PARTS(KEYS))
        return;
    *named |= stale;
    for (unsigned part = 0; part < DERIVED_PARTS; part++) {
        if (!(stale >> part & 1))
            continue;
        memcpy(&derived->now->job, &before.job, sizeof before.job);
        memcpy(&derived->now->draw, &before.draw, sizeof before.draw);
        derived->now->vertices = before.vertices;
        derived->changed = stale & ~(1u << part);
        take(derived, &by_parts);
        memcpy(by_parts.palette, before.palette, sizeof before.palette);
        if (derived->changed) {
            update();
            if (part != PART_PALETTE)
                take(derived, &by_parts);
        }
        *needed |= (unsigned)(memcmp(&by_parts, &whole, sizeof whole) != 0) << part;
    }
    device_state_changed(setting_device, PARTS_ALL);
    derive(&whole);
}

/* --- Tests --- */

/* A part of the cases does not miss every part. */
static void report_unneeded(const char *setter, unsigned named, unsigned needed)
{
    if (test_stride() > 1)
        return;
    static const char *const part_name[DERIVED_PARTS] = {
#define JOB_PART(name, keys, first, last, meaning) #name,
#include "def/job_part.def"
#undef JOB_PART
        "AREA", "VERTICES", "KEYS"};
    for (unsigned part = 0; part < DERIVED_PARTS; part++)
        if (named >> part & ~needed >> part & 1) {
            char text[128];
            snprintf(text, sizeof text, "%s: %s is never missed", setter, part_name[part]);
            TEST_FAIL_MESSAGE(text);
        }
}

static void every_setter_in_every_situation(void)
{
    static unsigned named[SETTINGS], needed[SETTINGS];
    for (unsigned s = 0; s < SITUATIONS; s++)
        for (unsigned i = s % test_stride_of(5); i < SETTINGS; i += test_stride_of(5)) {
            if (!enter(situations[s].description))
                continue;
            for (unsigned variant = 0; variant < SETTING_VARIANTS; variant++) {
                settings[i].set(variant);
                compare(print(situations[s].name, settings[i].name, variant), &named[i], &needed[i]);
            }
        }
    for (unsigned i = 0; i < SETTINGS; i++)
        report_unneeded(settings[i].name, named[i], needed[i]);
}

/* Returns candidate number i of a kind: one of its words, or a number of a list if it is in the kind's
 * range. */
static bool candidate(const struct triptych_kind *kind, unsigned i, uint32_t *value)
{
    static const uint32_t numbers[] = {0, 1, 2, 3, 5, 8, 15, 128, 255, 0x12345678, 0x80ff4020, 0xffffffff};
    static const float reals[] = {0, .25f, 1, 3, -1, 40};
    const struct triptych_value *word = triptych_value_at(kind, i);
    if (kind->notation == TRIPTYCH_NOTATION_WORDS) {
        *value = word ? word->number : 0;
        return word;
    }
    if (kind->notation == TRIPTYCH_NOTATION_REAL) {
        *value = i < sizeof reals / sizeof *reals ? triptych_float_bits(reals[i]) : 0;
        return i < sizeof reals / sizeof *reals;
    }
    *value = i < sizeof numbers / sizeof *numbers ? numbers[i] : 0;
    return i < sizeof numbers / sizeof *numbers;
}

static enum triptych_result set_value(enum triptych_state_table table, unsigned i, unsigned row,
                                      uint32_t value)
{
    return table == TRIPTYCH_SAMPLER_STATES ? triptych_set_sampler_state(setting_device, i, row, value)
           : table == TRIPTYCH_STAGE_STATES ? triptych_set_stage_state(setting_device, i, row, value)
                                            : triptych_set_state(setting_device, row, value);
}

/* Sets a state to each of its values and back. */
static void try_values(const char *situation, enum triptych_state_table table, unsigned i, unsigned row,
                       unsigned *named, unsigned *needed)
{
    const struct triptych_state_row *state = triptych_state_at(table, row);
    uint32_t before = table == TRIPTYCH_SAMPLER_STATES ? setting_device->state.sampler[i][row]
                      : table == TRIPTYCH_STAGE_STATES ? setting_device->state.stage[i][row]
                                                       : setting_device->state.value[row],
             value;
    for (unsigned v = 0; candidate(state->kind, v, &value); v++)
        if (set_value(table, i, row, value) == TRIPTYCH_OK)
            compare(print(situation, state->name, value), named, needed);
    OK(set_value(table, i, row, before));
    compare(print(situation, state->name, before), named, needed);
}

static void every_state_in_every_situation(void)
{
    enum { ROWS = 256 };
    static unsigned named[TRIPTYCH_STATE_TABLE_COUNT][ROWS], needed[TRIPTYCH_STATE_TABLE_COUNT][ROWS];
    const unsigned stride = test_stride_of(7);
    for (unsigned s = 0; s < SITUATIONS; s++) {
        if (!enter(situations[s].description))
            continue;
        for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++) {
            unsigned last = triptych_table_size(table) - 1, at[] = {0, 1, last};
            for (unsigned p = 0; p < (last ? 3 : 1); p++)
                for (unsigned row = (s + p) % stride; triptych_state_at(table, row); row += stride)
                    try_values(situations[s].name, table, at[p], row, &named[table][row],
                               &needed[table][row]);
        }
    }
    for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++)
        for (unsigned row = 0; triptych_state_at(table, row); row++)
            report_unneeded(triptych_state_at(table, row)->name, named[table][row], needed[table][row]);
}

/* States whose changes exclude the keys are those that the tables list as in no key. States that never change
 * need no derivation. */
static void states_that_exclude_the_keys_are_in_no_key(void)
{
    for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++)
        for (unsigned row = 0; triptych_state_at(table, row); row++)
            if (!(change_of_value(table, row) & PARTS(KEYS)) &&
                triptych_state_at(table, row)->support != TRIPTYCH_SUPPORT_NEVER)
                TEST_ASSERT_EQUAL_STRING_MESSAGE("job", triptych_state_at(table, row)->units,
                                                 triptych_state_at(table, row)->name);
}

static uint32_t random_below(uint64_t *seed, uint32_t limit)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*seed >> 32) * limit >> 32);
}

static void change_at_random(uint64_t *seed)
{
    uint32_t value;
    if (!random_below(seed, 3)) {
        unsigned i = random_below(seed, SETTINGS);
        if (settings[i].set != setting_count_pixels)
            settings[i].set(random_below(seed, SETTING_VARIANTS));
        return;
    }
    unsigned table = random_below(seed, TRIPTYCH_STATE_TABLE_COUNT), rows = 0;
    while (triptych_state_at(table, rows))
        rows++;
    unsigned row = random_below(seed, rows);
    if (candidate(triptych_state_at(table, row)->kind, random_below(seed, 8), &value))
        set_value(table, random_below(seed, triptych_table_size(table)) % 4, row, value);
}

/* Makes several changes between two draws, some of them to the same state. */
static void random_changes(void)
{
    uint64_t seed = 20;
    for (unsigned s = 0; s < SITUATIONS; s++) {
        if (!enter(situations[s].description))
            continue;
        for (unsigned step = 0; step < test_share_of(400, 16); step++) {
            for (unsigned n = 1 + random_below(&seed, 5); n--;)
                change_at_random(&seed);
            drawn = (enum triptych_primitive)random_below(&seed, TRIPTYCH_PRIMITIVE_COUNT);
            compare(print(situations[s].name, "step", step), NULL, NULL);
        }
    }
}

static void set_state(enum triptych_state state, uint32_t value)
{
    OK(triptych_set_state(setting_device, state, value));
    compare("set", NULL, NULL);
}

/* Two states in turn have two sources, whatever else changes. */
static void a_state_that_returns_has_its_source_again(void)
{
    TEST_ASSERT_TRUE(enter(situations[0].description));
    const struct derived_source *first = setting_device->derived.now;
    set_state(TRIPTYCH_STATE_ALPHABLENDENABLE, 1);
    const struct derived_source *second = setting_device->derived.now;
    TEST_ASSERT_NOT_EQUAL(first, second);
    for (uint32_t i = 0; i < 4 * DERIVED_SOURCES; i++) {
        set_state(TRIPTYCH_STATE_TEXTUREFACTOR, i);
        set_state(TRIPTYCH_STATE_ALPHABLENDENABLE, 0);
        TEST_ASSERT_EQUAL_PTR(first, setting_device->derived.now);
        set_state(TRIPTYCH_STATE_BLENDFACTOR, i);
        set_state(TRIPTYCH_STATE_ALPHABLENDENABLE, 1);
        TEST_ASSERT_EQUAL_PTR(second, setting_device->derived.now);
    }
}

/* The source that is given up is the one that was used first. */
static void more_states_than_sources_are_kept(void)
{
    const struct derived_source *last = NULL;
    TEST_ASSERT_TRUE(enter(situations[0].description));
    for (uint32_t i = 0; i < 3 * DERIVED_SOURCES; i++) {
        set_state(TRIPTYCH_STATE_STENCILMASK, i);
        TEST_ASSERT_NOT_EQUAL(last, setting_device->derived.now);
        last = setting_device->derived.now;
    }
    for (uint32_t i = 3 * DERIVED_SOURCES; i-- > 2 * DERIVED_SOURCES;)
        set_state(TRIPTYCH_STATE_STENCILMASK, i);
    TEST_ASSERT_EQUAL_INT(DERIVED_SOURCES, setting_device->derived.count);
    set_state(TRIPTYCH_STATE_STENCILMASK, 3 * DERIVED_SOURCES - 1);
    TEST_ASSERT_EQUAL_PTR(last, setting_device->derived.now);
}

/* Draws a source in an epoch, and returns its draw. */
static struct draw *draw_in(uint32_t blend, uint64_t epoch)
{
    OK(triptych_set_state(setting_device, TRIPTYCH_STATE_ALPHABLENDENABLE, blend));
    OK(device_derived_update(&setting_device->derived, &setting_device->state, drawn, epoch,
                             &setting_device->errors.last));
    return &setting_device->derived.now->draw;
}

/* Routines are held and jobs are queued until the epoch ends. The device clears those of the last draw. */
static void routines_and_jobs_end_with_their_epoch(void)
{
    static const struct routine routine;
    static const struct job job;
    TEST_ASSERT_TRUE(enter(situations[0].description));
    struct draw *draw = draw_in(1, 7);
    draw->routine[UNIT_PIXEL] = &routine;
    draw->job = &job;
    TEST_ASSERT_NOT_EQUAL(draw, draw_in(0, 7));
    TEST_ASSERT_EQUAL_PTR(draw, draw_in(1, 7));
    TEST_ASSERT_EQUAL_PTR(&routine, draw->routine[UNIT_PIXEL]);
    TEST_ASSERT_EQUAL_PTR(&job, draw->job);
    draw_in(0, 7);
    draw_in(1, 8);
    TEST_ASSERT_NULL(draw->routine[UNIT_PIXEL]);
    TEST_ASSERT_NULL(draw->job);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(states_that_exclude_the_keys_are_in_no_key);
    RUN_TEST(every_setter_in_every_situation);
    RUN_TEST(every_state_in_every_situation);
    RUN_TEST(random_changes);
    RUN_TEST(a_state_that_returns_has_its_source_again);
    RUN_TEST(more_states_than_sources_are_kept);
    RUN_TEST(routines_and_jobs_end_with_their_epoch);
    return UNITY_END();
}
