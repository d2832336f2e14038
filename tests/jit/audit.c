/* The audit of the keys: every state against every routine, out of the tables.
 *
 * From each of a list of situations every supported state is set to each of its values, per stage and per
 * sampler in the first, the second and the last. Then, with docs/states.md (the column `units` of the
 * tables):
 *   - a unit's key changes only if the state's row names the unit, or if the later routines read something
 * else than before: setup provides what the pixel routine reads, and the vertex routine what both read;
 *   - each unit that a row names is seen to change somewhere, and the run-time values for a row that names
 * none;
 *   - any two of a state's words differ in a key or a value somewhere;
 *   - what another state shuts off (the gates below) changes nothing at all;
 *   - keys are as many as codes: among all keys that came up no two of a unit record the same operations,
 * none have the same machine code, nor the same plan of fragments; and the same key gives the same bytes
 * twice. A state that becomes supported is audited from then on. If the list has no situation in which it
 * matters, the audit fails, and one is to be added. */
#include "jit/build.h"
#include "stitch/cover.h"
#include "stitch/plan.h"
#include "tests/support/situation.h"

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
#include "tests/support/situation.def"
#undef SITUATION
#undef GATE
};

enum { SITUATIONS = sizeof situations / sizeof *situations };

static const struct {
    const char *holds, *means_nothing;
} gates[] = {
#define SITUATION(name, description)
#define GATE(holds, means_nothing) {holds, means_nothing},
#include "tests/support/situation.def"
#undef SITUATION
#undef GATE
};

enum { GATES = sizeof gates / sizeof *gates };

/* Words of a state that mean the same: what is left of them without their common beginning. */
static const struct {
    const char *state, *ending, *other, *reason;
} synonyms[] = {
    {"shademode", "gouraud", "phong", "Direct3D 9 draws Phong shading as Gouraud shading"},
    {"srcblendalpha", "color", "alpha", "of alpha, the colour is alpha"},
    {"destblendalpha", "color", "alpha", "of alpha, the colour is alpha"},
    {"srcblendalpha", "one", "srcalphasat", "for alpha, the factor is 1"},
    {"destblendalpha", "one", "srcalphasat", "for alpha, the factor is 1"},
    {"alphaarg", "", "_alphareplicate", "alpha replicated is alpha"},
    {"texturetransformflags", "", "_projected",
     "the last of three or four coordinates divides, not of fewer"},
    {"magfilter", "none", "point", "no filter is the nearest texel"},
    {"minfilter", "none", "point", "no filter is the nearest texel"},
    {"magfilter", "linear", "anisotropic", "a magnified texel has no long side"},
};

enum { SYNONYMS = sizeof synonyms / sizeof *synonyms };

static bool synonym_needed[SYNONYMS];

/* --- Reports
 * ---------------------------------------------------------------------------------------------------
 */

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

/* Fails the test if anything was complained of. */
static void settle(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, complaints, "complaints, see above");
}

/* --- What a state derives to
 * ------------------------------------------------------------------------------------
 */

/* What a draw reads at run time. */
struct values {
    struct job job;
    struct rectangle scissor;
    uint64_t wrapped;
    uint32_t shape, clip_ignored, last_pixel, sample_mask;
};

struct derived {
    union key key[UNIT_COUNT];
    struct packed_key packed[UNIT_COUNT];
    struct values values;
};

static void derive(const struct situation *situation, struct derived *d)
{
    const struct state *state = &situation->state;
    enum primitive primitive = derive_primitive(state, situation->drawn);
    memset(d, 0, sizeof *d);
    derive_keys(state, primitive, d->key);
    for (int u = 0; u < UNIT_COUNT; u++)
        d->packed[u] = key_pack(u, &d->key[u]);
    derive_job(state, &d->key[UNIT_VERTEX].vertex, &d->key[UNIT_PIXEL].pixel, &d->values.job);
    d->values.scissor = derive_scissor(state);
    d->values.wrapped = derive_wrapped(state, &d->key[UNIT_PIXEL].pixel);
    d->values.sample_mask = derive_sampling(state).mask;
    d->values.shape = derive_shape(primitive);
    d->values.clip_ignored = derive_clip_ignored(state);
    d->values.last_pixel = d->values.shape == SHAPE_LINE && derive_last_pixel(state);
}

static bool key_differs(const struct derived *a, const struct derived *b, int unit)
{
    return !key_equal(&a->packed[unit], &b->packed[unit]);
}

static bool values_differ(const struct derived *a, const struct derived *b)
{
    return memcmp(&a->values, &b->values, sizeof a->values) != 0;
}

static bool differs(const struct derived *a, const struct derived *b)
{
    bool keys = false;
    for (int u = 0; u < UNIT_COUNT; u++)
        keys |= key_differs(a, b, u);
    return keys || values_differ(a, b);
}

/* Whether the pixel routine reads something else of setup. */
static bool pixel_reads_differ(const struct derived *a, const struct derived *b)
{
    const struct pixel_key *x = &a->key[UNIT_PIXEL].pixel, *y = &b->key[UNIT_PIXEL].pixel;
    return memcmp(x->varying, y->varying, sizeof x->varying) != 0 ||
           pixel_reads_depth(x) != pixel_reads_depth(y) ||
           (x->stencil == STENCIL_TWO) != (y->stencil == STENCIL_TWO) || pixel_reads_w(x) != pixel_reads_w(y);
}

static bool later_reads_differ(const struct derived *a, const struct derived *b, int unit)
{
    return (unit < UNIT_PIXEL && pixel_reads_differ(a, b)) ||
           (unit < UNIT_SETUP && key_differs(a, b, UNIT_SETUP));
}

/* --- Keys that came up
 * ------------------------------------------------------------------------------------------
 */

struct known {
    struct packed_key packed;
    union key key;
    uint64_t recorded, code, plan;
    enum unit unit;
};

static struct known *known;
static size_t known_count, known_room;
static uint32_t *slot; /* by the key's hash: an index into `known` and 1, or 0 */
static size_t slots;

static void insert_slot(uint32_t index)
{
    size_t at = key_hash(known[index].unit, &known[index].packed) & (slots - 1);
    while (slot[at])
        at = (at + 1) & (slots - 1);
    slot[at] = index + 1;
}

static void grow_known(void)
{
    known_room = known_room ? 2 * known_room : 4096;
    slots = 4 * known_room;
    known = realloc(known, known_room * sizeof *known);
    free(slot);
    slot = calloc(slots, sizeof *slot);
    TEST_ASSERT_TRUE(known && slot);
    for (uint32_t i = 0; i < known_count; i++)
        insert_slot(i);
}

static bool is_known(enum unit unit, const struct packed_key *packed)
{
    size_t at = key_hash(unit, packed) & (slots - 1);
    for (; slot[at]; at = (at + 1) & (slots - 1))
        if (known[slot[at] - 1].unit == unit && key_equal(&known[slot[at] - 1].packed, packed))
            return true;
    return false;
}

static void remember(const struct derived *d)
{
    for (int u = 0; u < UNIT_COUNT; u++) {
        if (known_count == known_room)
            grow_known();
        if (is_known(u, &d->packed[u]))
            continue;
        known[known_count] = (struct known){.unit = u, .packed = d->packed[u], .key = d->key[u]};
        insert_slot((uint32_t)known_count++);
    }
}

/* --- Flips
 * ------------------------------------------------------------------------------------------------------
 */

enum { VALUES_MAXIMUM = 64, ROWS_MAXIMUM = 128 };

/* One place where a state stands. */
struct spot {
    enum triptych_state_table table;
    unsigned i, row;
    const struct triptych_state_row *state;
};

/* What has been seen of a state: bits of units, then of the values; and pairs of words told apart. */
enum { SEEN_VALUES = 1 << UNIT_COUNT };
static struct {
    unsigned changed;
    uint64_t apart[VALUES_MAXIMUM];
} seen[TRIPTYCH_STATE_TABLE_COUNT][ROWS_MAXIMUM];

/* The values that are tried: all words, or numbers of all sizes of which those in the range are taken. */
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

/* Calls `visit` for each place of a supported state: all render states; the first, second and last of stages
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

/* A situation, what it derives to, and where it comes from. */
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
        if (!key_differs(&origin->derived, after, u))
            continue;
        *changed |= 1u << u;
        if (!names_unit(spot->state, u) && !later_reads_differ(&origin->derived, after, u))
            complain("%s: %s %s changes the %s key, which its row does not name", origin->name,
                     print_spot(spot), print_value(spot, value), unit_name[u]);
    }
    if (!values_differ(&origin->derived, after))
        return;
    *changed |= SEEN_VALUES;
    if (!strcmp(spot->state->units, "-"))
        complain("%s: %s %s changes values, and its row says nothing", origin->name, print_spot(spot),
                 print_value(spot, value));
}

/* Marks which of the words differ here. */
static void tell_apart(const struct spot *spot, const struct derived *after, const bool *taken,
                       unsigned count)
{
    uint64_t *apart = seen[spot->table][spot->row].apart;
    for (unsigned a = 0; a < count; a++)
        for (unsigned b = a + 1; b < count; b++)
            if (taken[a] && taken[b] && !(apart[a] >> b & 1) && differs(&after[a], &after[b]))
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
        derive(situation, &after[v]);
        check_units(origin, spot, value[v], &after[v]);
        remember(&after[v]);
    }
    tell_apart(spot, after, taken, count);
    *at = before;
}

/* Whether the situation can be had. */
static bool prepare(unsigned s, struct origin *origin)
{
    origin->name = situations[s].name;
    situation_start(&origin->situation);
    if (situation_add(&origin->situation, situations[s].description))
        return false;
    derive(&origin->situation, &origin->derived);
    return true;
}

/* --- Tests
 * ------------------------------------------------------------------------------------------------------
 */

static struct origin origin;

void setUp(void)
{
    complaints = 0;
}

void tearDown(void)
{
}

static void states_enter_no_keys_but_those_of_their_rows(void)
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

/* Follows the test before. */
static void supported_states_enter_all_keys_of_their_rows(void)
{
    for_each_spot(check_seen, NULL);
    settle();
}

static bool are_synonyms(const struct spot *spot, const char *a, const char *b)
{
    bool result = false;
    while (*a && *a == *b)
        a++, b++;
    for (unsigned i = 0; i < SYNONYMS; i++) {
        const char *x = synonyms[i].ending, *y = synonyms[i].other;
        bool same = (!strcmp(a, x) && !strcmp(b, y)) || (!strcmp(a, y) && !strcmp(b, x));
        if (same && !strncmp(spot->state->name, synonyms[i].state, strlen(synonyms[i].state)))
            synonym_needed[i] = result = true;
    }
    return result;
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
                !(seen[spot->table][spot->row].apart[i] >> j & 1) && !are_synonyms(spot, a->word, b->word))
                complain("%s: %s and %s are the same in every situation", print_spot(spot), a->word, b->word);
}

static void any_two_words_of_a_state_differ_somewhere(void)
{
    for_each_spot(check_words, NULL);
    for (unsigned i = 0; i < SYNONYMS; i++)
        if (!synonym_needed[i])
            complain("%s: %s and %s are no synonyms any more", synonyms[i].state, synonyms[i].ending,
                     synonyms[i].other);
    settle();
}

/* Whether a statement of a gate's list ("stage 1 color*") is about the spot. */
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

/* What a gate sets itself is not shut off by it. */
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
    for (unsigned v = 0; v < count; v++) {
        if (!set(&from->situation, spot, value[v]))
            continue;
        derive(&from->situation, &after);
        shut++;
        if (differs(&from->derived, &after))
            complain("%s with %s: %s %s changes something", from->name, gates[gate].holds, print_spot(spot),
                     print_value(spot, value[v]));
    }
    *at = before;
}

static void what_is_shut_off_changes_nothing(void)
{
    for (unsigned s = 0; s < SITUATIONS; s++)
        for (gate = 0; gate < GATES; gate++) {
            if (!prepare(s, &origin) || situation_add(&origin.situation, gates[gate].holds))
                continue;
            derive(&origin.situation, &origin.derived);
            for_each_spot(flip_shut, &origin);
        }
    settle();
    TEST_ASSERT_GREATER_THAN_UINT(10000, shut);
}

/* --- Codes
 * ------------------------------------------------------------------------------------------------------
 */

/* Everything of the operations but the lines of the specification that they come from. */
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
    size_t bytes = build_code(builder, &options, k->unit, &k->key, NULL, NULL, &error);
    TEST_ASSERT_TRUE_MESSAGE(bytes, error.text);
    return XXH3_64bits_withSeed(builder->emitter.code, bytes, bytes);
}

static size_t compared; /* the offset in struct known of what is compared */

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

/* The keys that may have the same code, and why they are not made one. */
typedef bool alike_function(const struct pixel_key *a, const struct pixel_key *b);

static bool other_varyings(const struct pixel_key *a, const struct pixel_key *b)
{
    return memcmp(a->varying, b->varying, sizeof a->varying) != 0;
}

static bool reads_unwritten(const struct pixel_key *key)
{
    bool reads = false, written = false;
    for (int i = 0; i < key->stages; i++) {
        reads |= !written && stage_reads(key, i, SOURCE_TEMPORARY);
        written |= key->temporary[i];
    }
    return reads;
}

static bool one_reads_unwritten(const struct pixel_key *a, const struct pixel_key *b)
{
    return reads_unwritten(a) || reads_unwritten(b);
}

static bool other_temporaries(const struct pixel_key *a, const struct pixel_key *b)
{
    return memcmp(a->temporary, b->temporary, sizeof a->temporary) != 0;
}

/* In a stage that is not the last. */
static bool copies(const struct pixel_key *key)
{
    bool result = false;
    for (int i = 0; i + 1 < key->stages; i++)
        result |= key->color_stage[i] == STAGE_SELECT && stage_is_joint(key, i);
    return result;
}

static bool one_copies(const struct pixel_key *a, const struct pixel_key *b)
{
    return copies(a) || copies(b);
}

static bool other_specular(const struct pixel_key *a, const struct pixel_key *b)
{
    return a->specular != b->specular;
}

static bool one_compares(const struct pixel_key *a, const struct pixel_key *b)
{
    bool result = false;
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        result |= a->texel[i] == TEXEL_COMPARE || b->texel[i] == TEXEL_COMPARE;
    return result;
}

static const struct {
    alike_function *applies;
    const char *reason;
} alikes[] = {
    {other_varyings, "the only one read lies in the same place, and setup puts there which it is"},
    {one_reads_unwritten, "the temporary colour is zero until a stage has written it, and zeros fold"},
    {other_temporaries, "a colour may go to the next stage by either name"},
    {one_compares, "a shadow map's comparison is its colour and its alpha"},
    {other_specular, "the specular colour may be added by a last stage, too"},
    {one_copies, "a stage that hands on a source gives the next stage what it can name itself"},
};

enum { ALIKES = sizeof alikes / sizeof *alikes };

static bool alike_needed[ALIKES];

/* What differs of two vertex shaders may be what the pixel side does not read. */
static bool other_vertex_shaders(const struct known *a, const struct known *b)
{
    const struct vertex_key *x = &a->key.vertex, *y = &b->key.vertex;
    return a->unit == UNIT_VERTEX && key_program(x->shader) != key_program(y->shader);
}

static bool may_be_alike(const struct known *a, const struct known *b)
{
    bool result = other_vertex_shaders(a, b);
    for (unsigned i = 0; i < ALIKES && a->unit == UNIT_PIXEL; i++)
        if (alikes[i].applies(&a->key.pixel, &b->key.pixel))
            alike_needed[i] = result = true;
    return result;
}

/* Complains of keys of a unit that have the same. */
static void expect_distinct(const char *what, size_t offset)
{
    static char text[2][KEY_TEXT_CAPACITY];
    const struct known **order = calloc(known_count + 1, sizeof(*order));
    TEST_ASSERT_NOT_NULL(order);
    for (size_t i = 0; i < known_count; i++)
        order[i] = &known[i];
    compared = offset;
    qsort(order, known_count, sizeof(*order), by_hash);
    for (size_t i = 1; i < known_count; i++)
        for (size_t j = i; j-- && order[j]->unit == order[i]->unit && hash_of(order[j]) == hash_of(order[i]);)
            if (!may_be_alike(order[j], order[i]))
                complain("two %s keys, the same %s:\n  %s\n  %s", unit_name[order[i]->unit], what,
                         key_print(order[i]->unit, &order[j]->key, text[0]),
                         key_print(order[i]->unit, &order[i]->key, text[1]));
    free(order);
    settle();
}

static void keys_that_differ_record_other_operations(void)
{
    struct builder *builder = builder_take(NULL);
    TEST_ASSERT_NOT_NULL(builder);
    for (size_t i = 0; i < known_count; i++) {
        ir_record(&builder->ir, known[i].unit, &known[i].key);
        known[i].recorded = hash_recorded(&builder->ir);
    }
    builder_give(builder);
    TEST_ASSERT_GREATER_THAN_UINT(1000, known_count);
    expect_distinct("operations", offsetof(struct known, recorded));
}

static void keys_that_differ_have_other_fragments(void)
{
    struct plan *plan = plan_take(NULL);
    TEST_ASSERT_NOT_NULL(plan);
    for (size_t i = 0; i < known_count; i++)
        known[i].plan = hash_plan(plan, known[i].unit, &known[i].key);
    plan_give(plan);
    expect_distinct("fragments", offsetof(struct known, plan));
}

static void keys_that_differ_have_other_code_and_the_same_the_same(void)
{
    struct builder *builder = builder_take(NULL);
    TEST_ASSERT_NOT_NULL(builder);
    for (size_t i = 0; i < known_count; i++)
        known[i].code = hash_code(builder, &known[i]);
    for (size_t i = known_count; i--;)
        TEST_ASSERT_EQUAL_HEX64(known[i].code, hash_code(builder, &known[i]));
    builder_give(builder);
    expect_distinct("code", offsetof(struct known, code));
    for (unsigned i = 0; i < ALIKES; i++)
        TEST_ASSERT_TRUE_MESSAGE(alike_needed[i], alikes[i].reason);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(states_enter_no_keys_but_those_of_their_rows);
    RUN_TEST(supported_states_enter_all_keys_of_their_rows);
    RUN_TEST(any_two_words_of_a_state_differ_somewhere);
    RUN_TEST(what_is_shut_off_changes_nothing);
    RUN_TEST(keys_that_differ_record_other_operations);
    RUN_TEST(keys_that_differ_have_other_fragments);
    RUN_TEST(keys_that_differ_have_other_code_and_the_same_the_same);
    free(known);
    free(slot);
    return UNITY_END();
}
