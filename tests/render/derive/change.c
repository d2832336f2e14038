/* Deriving the changed parts of the state gives the same bytes as deriving all of it, whatever changes.
 *
 * In every situation of tests/support/picture/situation.def every setter of the interface is called, and
 * every state of the tables is set to each of its values. After each call the device derives the parts
 * that the setter names, and then everything. The opposite is checked too: if a named part is omitted, some
 * situation must differ. So no setter names too many parts, and the comparison detects each of them. Builds
 * with sanitizers change some settings and states in each situation, from situation to situation others. */
#include "render/device/device.h"
#include "tests/support/change/setting.h"
#include "tests/support/picture/situation.h"
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
    OK(device_derived_update(&setting_device->derived, &setting_device->state, drawn,
                             &setting_device->errors.last));
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

static void take(struct derived *derived)
{
    memset(derived, 0, sizeof *derived);
    memcpy(derived->key, setting_device->derived.key, sizeof derived->key);
    memcpy(&derived->job, &setting_device->derived.job, sizeof derived->job);
    memcpy(&derived->draw, &setting_device->derived.draw, sizeof derived->draw);
    derived->vertices = setting_device->derived.vertices;
    if (setting_device->derived.job.palette)
        memcpy(derived->palette, setting_device->derived.job.palette, sizeof derived->palette);
    derived->job.palette = NULL;
}

/* Derives, and frees the palettes, which otherwise stay until something is rendered. */
static void derive(struct derived *derived)
{
    OK(device_derived_update(&setting_device->derived, &setting_device->state, drawn,
                             &setting_device->errors.last));
    take(derived);
    triptych_finish(setting_device);
}

static const char *print(const char *situation, const char *setter, unsigned value)
{
    static char text[256];
    snprintf(text, sizeof text, "%s: %s %u", situation, setter, value);
    return text;
}

/* Derives all named parts, all but each one of them, and everything from scratch. Adds the parts whose
 * omission makes a difference to `needed`. */
static void compare(const char *what, unsigned *named, unsigned *needed)
{
    static struct derived by_parts, whole, before;
    unsigned stale = setting_device->derived.stale;
    take(&before);
    derive(&by_parts);
    device_state_changed(setting_device, PARTS_ALL);
    derive(&whole);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&whole, &by_parts, sizeof whole, what);
    if (!named || stale & PARTS(KEYS))
        return;
    *named |= stale;
    for (unsigned part = 0; part < DERIVED_PARTS; part++) {
        if (!(stale >> part & 1))
            continue;
        memcpy(&setting_device->derived.job, &before.job, sizeof setting_device->derived.job);
        memcpy(&setting_device->derived.draw, &before.draw, sizeof setting_device->derived.draw);
        setting_device->derived.vertices = before.vertices;
        setting_device->derived.stale = stale & ~(1u << part);
        take(&by_parts);
        memcpy(by_parts.palette, before.palette, sizeof before.palette);
        if (setting_device->derived.stale) {
            OK(device_derived_update(&setting_device->derived, &setting_device->state, drawn,
                                     &setting_device->errors.last));
            if (part != PART_PALETTE)
                take(&by_parts);
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
        "SETTING", "VERTICES", "KEYS"};
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(states_that_exclude_the_keys_are_in_no_key);
    RUN_TEST(every_setter_in_every_situation);
    RUN_TEST(every_state_in_every_situation);
    RUN_TEST(random_changes);
    return UNITY_END();
}
