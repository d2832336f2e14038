/* The audit of the keys: every state with every routine, derived from the tables.
 *
 * In each situation of a list, every supported state is set to each of its values; states of stages and
 * samplers are set in the first, the second and the last one. The column `units` of the tables then predicts:
 *   - A unit's key changes only if the row of the state names the unit, or if later routines read other data
 *     than before: setup provides the pixel routine's data, and the vertex routine the data of both.
 *   - Each unit that a row names changes in some situation. If a row names none, a run-time value changes.
 *   - Any two words of a state differ in a key or a value in some situation.
 *   - A state that another one disables (the gates below) changes nothing.
 *   - Different keys of a unit never record the same operations, and never have the same machine code or the
 *     same plan of fragments. Building a key twice results in the same bytes.
 * A state that becomes supported is audited automatically. If the list has no situation in which the state
 * matters, the audit fails until one is added. */
#include "engines/specialize/build.h"
#include "contract/key_query.h"
#include "engines/stitch/cover.h"
#include "engines/stitch/plan.h"
#include "tests/support/change/alike.h"
#include "tests/support/change/derived.h"
#include "tests/support/change/known.h"
#include "tests/support/change/synonym.h"
#include "tests/support/system/seed.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>
#include <xxhash.h>

static const struct {
    const char *name, *description;
} situations[] = {
#define SITUATION(name, description) {name, description},
#define GATE(holds, means_nothing)
#include "tests/support/picture/situation.def"
#undef SITUATION
#undef GATE
};

enum { SITUATIONS = sizeof situations / sizeof *situations };

static const struct {
    const char *holds, *means_nothing;
} gates[] = {
#define SITUATION(name, description)
#define GATE(holds, means_nothing) {holds, means_nothing},
#include "tests/support/picture/situation.def"
#undef SITUATION
#undef GATE
};

enum { GATES = sizeof gates / sizeof *gates };

/* --- Reports ------------------------------------------------------------------------------------------- */

enum { COMPLAINTS_SHOWN = 40 };

static unsigned complaints;

__attribute__((format(printf, 1, 2))) static void complain(const char *format, ...)
{
    va_list arguments;
    if (complaints++ >= COMPLAINTS_SHOWN)
        return;
    va_start(arguments, format);
    printf("  ");
    vprintf(format, arguments);
    putchar('\n');
    va_end(arguments);
}

/* Fails the test if there were complaints. */
static void settle(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, complaints, "complaints, see above");
}

/* --- Flips --------------------------------------------------------------------------------------------- */

enum { VALUES_MAXIMUM = 64, ROWS_MAXIMUM = 128 };

/* One position of a state. */
struct spot {
    enum triptych_state_table table;
    unsigned i, row;
    const struct triptych_state_row *state;
};

/* The observed effects of a state: bits of units, then of the values; and the pairs of words that differed.
 */
enum { SEEN_VALUES = 1 << UNIT_COUNT };
static struct {
    unsigned changed;
    uint64_t apart[VALUES_MAXIMUM];
} seen[TRIPTYCH_STATE_TABLE_COUNT][ROWS_MAXIMUM];

/* The values that are set: all words, or those of a list of numbers that are in the range. */
static unsigned candidates(const struct triptych_kind *kind, uint32_t value[VALUES_MAXIMUM])
{
    static const uint32_t numbers[] = {0,  1,  2,   3,   4,          5,          6,         7,
                                       8,  9,  10,  11,  12,         13,         14,        15,
                                       16, 33, 128, 255, 0x12345678, 0x80ff4020, 0xffffffff};
    static const float reals[] = {0, .25f, 1, 1.5f, 3, -1, 40, 1000};
    unsigned count = 0;
    const struct triptych_value *word;
    if (kind->notation == TRIPTYCH_NOTATION_WORDS)
        for (; (word = triptych_value_at(kind, count)); count++) {
            TEST_ASSERT_TRUE(count < VALUES_MAXIMUM);
            value[count] = word->number;
        }
    else if (kind->notation == TRIPTYCH_NOTATION_REAL)
        for (; count < sizeof reals / sizeof *reals; count++)
            value[count] = triptych_float_bits(reals[count]);
    else {
        count = sizeof numbers / sizeof *numbers;
        memcpy(value, numbers, sizeof numbers);
    }
    return count;
}

static bool set(struct situation *situation, const struct spot *spot, uint32_t value)
{
    return state_set_value(&situation->state, spot->table, spot->i, spot->row, value, NULL) == TRIPTYCH_OK;
}

static uint32_t *stored(struct state *state, const struct spot *spot)
{
    return spot->table == TRIPTYCH_RENDER_STATES    ? &state->value[spot->row]
           : spot->table == TRIPTYCH_SAMPLER_STATES ? &state->sampler[spot->i][spot->row]
                                                    : &state->stage[spot->i][spot->row];
}

static bool names_unit(const struct triptych_state_row *state, int unit)
{
    return strcmp(state->units, "job") != 0 && strchr(state->units, "VSP"[unit]);
}

static const char *print_spot(const struct spot *spot)
{
    static char text[96];
    if (spot->table == TRIPTYCH_RENDER_STATES)
        snprintf(text, sizeof text, "state %s", spot->state->name);
    else
        snprintf(text, sizeof text, "%s %u %s", triptych_table_name(spot->table), spot->i, spot->state->name);
    return text;
}

static const char *print_value(const struct spot *spot, uint32_t value)
{
    static char text[16];
    const char *word = triptych_value_word(spot->state->kind, value);
    snprintf(text, sizeof text, "0x%x", value);
    return word ? word : text;
}

/* Calls `visit` for each position of a supported state: all render states; the first, second and last stages
 * and samplers. */
static void for_each_spot(void (*visit)(const struct spot *, void *), void *context)
{
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++) {
        unsigned last = triptych_table_size(t) - 1, at[] = {0, 1, last};
        for (unsigned p = 0; p < (last ? 3 : 1); p++)
            for (unsigned row = 0; triptych_state_at(t, row); row++) {
                struct spot spot = {t, at[p], row, triptych_state_at(t, row)};
                if (spot.state->support == TRIPTYCH_SUPPORT_YES)
                    visit(&spot, context);
            }
    }
}

/* A situation, its derived keys and values, and its origin. */
struct origin {
    struct situation situation;
    struct derived derived;
    const char *name;
};

static void check_units(const struct origin *origin, const struct spot *spot, uint32_t value,
                        const struct derived *after)
{
    unsigned *changed = &seen[spot->table][spot->row].changed;
    for (int u = 0; u < UNIT_COUNT; u++) {
        if (!derived_key_differs(&origin->derived, after, u))
            continue;
        *changed |= 1u << u;
        if (!names_unit(spot->state, u) && !derived_later_reads_differ(&origin->derived, after, u))
            complain("%s: %s %s changes the %s key, which its row does not name", origin->name,
                     print_spot(spot), print_value(spot, value), unit_name[u]);
    }
    if (!derived_values_differ(&origin->derived, after))
        return;
    *changed |= SEEN_VALUES;
    if (!strcmp(spot->state->units, "-"))
        complain("%s: %s %s changes values, but its row names none", origin->name, print_spot(spot),
                 print_value(spot, value));
}

/* Marks the words that differ in this situation. */
static void tell_apart(const struct spot *spot, const struct derived *after, const bool *taken,
                       unsigned count)
{
    uint64_t *apart = seen[spot->table][spot->row].apart;
    for (unsigned a = 0; a < count; a++)
        for (unsigned b = a + 1; b < count; b++)
            if (taken[a] && taken[b] && !(apart[a] >> b & 1) && derived_differ(&after[a], &after[b]))
                apart[a] |= 1ull << b;
}

static void flip(const struct spot *spot, void *context)
{
    static struct derived after[VALUES_MAXIMUM];
    struct origin *origin = context;
    struct situation *situation = &origin->situation;
    bool taken[VALUES_MAXIMUM];
    uint32_t value[VALUES_MAXIMUM], *at = stored(&situation->state, spot), before = *at;
    unsigned count = candidates(spot->state->kind, value);
    for (unsigned v = 0; v < count; v++) {
        taken[v] = set(situation, spot, value[v]);
        if (!taken[v])
            continue;
        derived_make(situation, &after[v]);
        check_units(origin, spot, value[v], &after[v]);
        known_remember(&after[v]);
    }
    tell_apart(spot, after, taken, count);
    *at = before;
}

/* Returns true if the situation is possible. */
static bool prepare(unsigned s, struct origin *origin)
{
    origin->name = situations[s].name;
    situation_start(&origin->situation);
    if (situation_add(&origin->situation, situations[s].description))
        return false;
    derived_make(&origin->situation, &origin->derived);
    return true;
}

/* --- Tests --------------------------------------------------------------------------------------------- */

static struct origin origin;

void setUp(void)
{
    complaints = 0;
}

void tearDown(void)
{
}

static void states_change_only_the_keys_that_their_rows_name(void)
{
    for (unsigned s = 0; s < SITUATIONS; s++)
        if (prepare(s, &origin))
            for_each_spot(flip, &origin);
    settle();
}

static void check_seen(const struct spot *spot, void *context)
{
    const char *units = spot->state->units;
    unsigned changed = seen[spot->table][spot->row].changed;
    (void)context;
    if (spot->i)
        return;
    for (int u = 0; u < UNIT_COUNT; u++)
        if (names_unit(spot->state, u) && !(changed >> u & 1))
            complain("%s changes the %s key in no situation", print_spot(spot), unit_name[u]);
    if (!strcmp(units, "job") && !(changed & SEEN_VALUES))
        complain("%s changes no value in any situation", print_spot(spot));
}

/* Uses the results of the test before. */
static void supported_states_change_all_keys_that_their_rows_name(void)
{
    for_each_spot(check_seen, NULL);
    settle();
}

static void check_words(const struct spot *spot, void *context)
{
    const struct triptych_kind *kind = spot->state->kind;
    const struct triptych_value *a, *b;
    (void)context;
    if (spot->i)
        return;
    for (unsigned i = 0; (a = triptych_value_at(kind, i)); i++)
        for (unsigned j = i + 1; (b = triptych_value_at(kind, j)); j++)
            if (a->support == TRIPTYCH_SUPPORT_YES && b->support == TRIPTYCH_SUPPORT_YES &&
                !(seen[spot->table][spot->row].apart[i] >> j & 1) &&
                !synonym_are(spot->state->name, a->word, b->word))
                complain("%s: %s and %s are the same in every situation", print_spot(spot), a->word, b->word);
}

static void any_two_words_of_a_state_differ_somewhere(void)
{
    for_each_spot(check_words, NULL);
    if (synonym_unneeded())
        complain("not synonyms any more: %s", synonym_unneeded());
    settle();
}

/* Returns true if an entry of a gate's list ("stage 1 color*") includes the spot. */
static bool is_about(const char *list, const struct spot *spot)
{
    char table[16], name[48];
    unsigned i = 0;
    for (int length = 0; sscanf(list, " %15s%n", table, &length) == 1; list += length, i = 0) {
        list += length;
        if (strcmp(table, triptych_table_name(TRIPTYCH_RENDER_STATES)) != 0) {
            TEST_ASSERT_EQUAL_INT(1, sscanf(list, " %u%n", &i, &length));
            list += length;
        }
        TEST_ASSERT_EQUAL_INT(1, sscanf(list, " %47s%n", name, &length));
        size_t until = strcspn(name, "*");
        bool same = name[until] ? !strncmp(name, spot->state->name, until) : !strcmp(name, spot->state->name);
        if (same && i == spot->i && !strcmp(table, triptych_table_name(spot->table)))
            return true;
    }
    return false;
}

/* A gate does not disable the states that it sets itself. */
static bool is_set_by(const char *statements, const struct spot *spot)
{
    char text[96];
    snprintf(text, sizeof text, "%s ", print_spot(spot));
    return strstr(statements, text) != NULL;
}

static unsigned gate, shut;

static void flip_shut(const struct spot *spot, void *context)
{
    static struct derived after;
    struct origin *from = context;
    uint32_t value[VALUES_MAXIMUM], *at = stored(&from->situation.state, spot), before = *at;
    if (!is_about(gates[gate].means_nothing, spot) || is_set_by(gates[gate].holds, spot))
        return;
    unsigned count = candidates(spot->state->kind, value);
    for (unsigned v = 0; v < count; v += test_stride_of(13)) {
        if (!set(&from->situation, spot, value[v]))
            continue;
        derived_make(&from->situation, &after);
        shut++;
        if (derived_differ(&from->derived, &after))
            complain("%s with %s: %s %s changes something", from->name, gates[gate].holds, print_spot(spot),
                     print_value(spot, value[v]));
    }
    *at = before;
}

static void disabled_states_change_nothing(void)
{
    for (unsigned s = 0; s < SITUATIONS; s++)
        for (gate = 0; gate < GATES; gate++) {
            if (!prepare(s, &origin) || situation_add(&origin.situation, gates[gate].holds))
                continue;
            derived_make(&origin.situation, &origin.derived);
            for_each_spot(flip_shut, &origin);
        }
    settle();
    TEST_ASSERT_GREATER_THAN_UINT(10000 / test_stride_of(13), shut);
}

/* --- Codes --------------------------------------------------------------------------------------------- */

/* The operations of a recording without their lines of the specification. */
static uint64_t hash_recorded(const struct ir *ir)
{
    uint64_t hash = ir->count;
    for (uint32_t n = 0; n < ir->count; n++) {
        const struct ir_instruction *i = &ir->instruction[n];
        int32_t part[] = {i->op,         i->type,       i->base, i->scale, i->operand[0],
                          i->operand[1], i->operand[2], i->k,    i->field};
        hash = XXH3_64bits_withSeed(part, sizeof part, hash);
    }
    return hash;
}

static uint64_t hash_plan(struct plan *plan, enum unit unit, const union key *key)
{
    if (stages_cover(unit, key))
        plan_stages(plan, unit, key);
    else
        plan_operations(plan, unit, key);
    uint64_t hash = plan->count + ((uint64_t)plan->frame_bytes << 32);
    for (unsigned i = 0; i < plan->count; i++) {
        hash = XXH3_64bits_withSeed(plan->part[i].fragment->name, strlen(plan->part[i].fragment->name), hash);
        hash = XXH3_64bits_withSeed(&plan->part[i].arguments, sizeof plan->part[i].arguments, hash);
    }
    return XXH3_64bits_withSeed(plan->literal, plan->literals * sizeof *plan->literal, hash);
}

static uint64_t hash_code(struct builder *builder, const struct known *k)
{
    static const struct build_options options = {.width = 8, .profile = PROFILE_FULL};
    struct error error = {{0}};
    size_t bytes = specialize_code(builder, &options, k->unit, &k->key, NULL, NULL, &error);
    TEST_ASSERT_TRUE_MESSAGE(bytes, error.text);
    return XXH3_64bits_withSeed(builder->emitter.code, bytes, bytes);
}

static size_t compared; /* the offset of the compared member in struct known */

static uint64_t hash_of(const struct known *k)
{
    uint64_t hash;
    memcpy(&hash, (const char *)k + compared, sizeof hash);
    return hash;
}

static int by_hash(const void *a, const void *b)
{
    const struct known *x = *(const struct known *const *)a, *y = *(const struct known *const *)b;
    if (x->unit != y->unit)
        return x->unit < y->unit ? -1 : 1;
    return hash_of(x) < hash_of(y) ? -1 : hash_of(x) > hash_of(y);
}

/* Reports keys of a unit that have the same compared member. */
static void expect_distinct(const char *what, size_t offset)
{
    static char text[2][KEY_TEXT_CAPACITY];
    const struct known **order = calloc(known_count + 1, sizeof(*order));
    TEST_ASSERT_NOT_NULL(order);
    for (size_t i = 0; i < known_count; i++)
        order[i] = &known_keys[i];
    compared = offset;
    qsort(order, known_count, sizeof(*order), by_hash);
    for (size_t i = 1; i < known_count; i++)
        for (size_t j = i; j-- && order[j]->unit == order[i]->unit && hash_of(order[j]) == hash_of(order[i]);)
            if (!alike_keys(order[i]->unit, &order[j]->key, &order[i]->key))
                complain("two %s keys, the same %s:\n  %s\n  %s", unit_name[order[i]->unit], what,
                         key_print(order[i]->unit, &order[j]->key, text[0]),
                         key_print(order[i]->unit, &order[i]->key, text[1]));
    free(order);
    settle();
}

/* Keeps the keys that the build tries in the tests that follow. */
static void keep_share_of_keys(void)
{
    size_t kept = 0;
    for (size_t i = 0; i < known_count; i += test_stride_of(19))
        known_keys[kept++] = known_keys[i];
    known_count = kept;
    TEST_ASSERT_GREATER_THAN_UINT(test_share_of(1000, 19), known_count);
}

static void different_keys_record_different_operations(void)
{
    keep_share_of_keys();
    struct builder *builder = specialize_take(NULL);
    TEST_ASSERT_NOT_NULL(builder);
    for (size_t i = 0; i < known_count; i++) {
        ir_record(&builder->ir, known_keys[i].unit, &known_keys[i].key);
        known_keys[i].recorded = hash_recorded(&builder->ir);
    }
    specialize_give(builder);
    expect_distinct("operations", offsetof(struct known, recorded));
}

static void different_keys_have_different_fragments(void)
{
    struct plan *plan = plan_take(NULL);
    TEST_ASSERT_NOT_NULL(plan);
    for (size_t i = 0; i < known_count; i++)
        known_keys[i].plan = hash_plan(plan, known_keys[i].unit, &known_keys[i].key);
    plan_give(plan);
    expect_distinct("fragments", offsetof(struct known, plan));
}

static void different_keys_have_different_code_and_equal_keys_equal_code(void)
{
    struct builder *builder = specialize_take(NULL);
    TEST_ASSERT_NOT_NULL(builder);
    for (size_t i = 0; i < known_count; i++)
        known_keys[i].code = hash_code(builder, &known_keys[i]);
    for (size_t i = known_count; i--;)
        TEST_ASSERT_EQUAL_HEX64(known_keys[i].code, hash_code(builder, &known_keys[i]));
    specialize_give(builder);
    expect_distinct("code", offsetof(struct known, code));
    const char *unneeded = test_stride() > 1 ? NULL : alike_unneeded(); /* a part of the keys needs a part */
    TEST_ASSERT_NULL_MESSAGE(unneeded, unneeded);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(states_change_only_the_keys_that_their_rows_name);
    RUN_TEST(supported_states_change_all_keys_that_their_rows_name);
    RUN_TEST(any_two_words_of_a_state_differ_somewhere);
    RUN_TEST(disabled_states_change_nothing);
    RUN_TEST(different_keys_record_different_operations);
    RUN_TEST(different_keys_have_different_fragments);
    RUN_TEST(different_keys_have_different_code_and_equal_keys_equal_code);
    known_free();
    return UNITY_END();
}
