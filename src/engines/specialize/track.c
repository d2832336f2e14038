/* Tracking of constants that seldom change, and the variants for their values (track.h).
 *
 * Time is counted in draws. Of each word the tracker has its last value and the draw since which it has it.
 * Words are compared only if the draw's block of constants is another; otherwise a draw costs one comparison
 * of its number with `due`, the next draw at which a word is old enough. */
#include "engines/specialize/track.h"

#include "engines/specialize/specialize.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

struct variant {
    struct routine *routine;
    struct burnt_words burnt; /* its arrays are one allocation, which `at` begins */
    uint64_t hash;            /* of the words' numbers and values */
};

#define NEVER UINT64_MAX

struct track {
    struct routine_tracking counts; /* the first member: routine->tracking */
    struct code_arena *arena;
    const struct routine *routine;
    const struct variant *in_use; /* null: the routine itself */
    uint64_t number;              /* of the last block; 0: none yet */
    uint64_t due;                 /* the draw at which the next words are old enough */
    bool stopped;                 /* words are not tracked any longer */
    struct variant variant[TRACK_VARIANTS];
    uint32_t *at; /* counts.words of each: the word's number in the block, its value */
    uint32_t *word;
    uint64_t *since; /* the draw that brought the value */
};

static struct track *track_of(const struct routine *routine)
{
    return (struct track *)(uintptr_t)routine->tracking;
}

/* --- Recordings ----------------------------------------------------------------------------------------- */

static bool reads_constant(const struct ir_instruction *i)
{
    return i->op == IR_uniform && i->type == TYPE_flt && i->base == BASE_CONSTANT && i->k >= 0 &&
           i->k < 4 * TRACKED_WORDS;
}

void specialize_note_constants(const struct ir *ir, uint64_t constants[TRACKED_WORDS / 64])
{
    memset(constants, 0, TRACKED_WORDS / 8);
    for (uint32_t n = 1; n < ir->count; n++) {
        const struct ir_instruction *i = ir->instruction + n;
        uint32_t at = (uint32_t)i->k / 4;
        if (reads_constant(i))
            constants[at / 64] |= (uint64_t)1 << at % 64;
    }
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t left = *(const uint32_t *)a, right = *(const uint32_t *)b;
    return (left > right) - (left < right);
}

static const uint32_t *find_burnt(const struct burnt_words *burnt, uint32_t at)
{
    const uint32_t *found = bsearch(&at, burnt->at, burnt->count, sizeof *burnt->at, compare_numbers);
    return found ? burnt->word + (found - burnt->at) : NULL;
}

void specialize_burn(struct ir *ir, const struct burnt_words *burnt)
{
    for (uint32_t n = 1; n < ir->count; n++) {
        struct ir_instruction *i = ir->instruction + n;
        const uint32_t *word = reads_constant(i) ? find_burnt(burnt, (uint32_t)i->k / 4) : NULL;
        if (!word)
            continue;
        i->op = IR_literal;
        i->base = 0;
        memcpy(&i->k, word, sizeof i->k);
    }
}

/* --- Variants ------------------------------------------------------------------------------------------- */

static uint32_t word_of(const float *constants, uint32_t at)
{
    uint32_t word;
    memcpy(&word, constants + at, sizeof word);
    return word;
}

/* The guard: true if the draw's constants are those in the code. */
static bool holds(struct track *t, const struct variant *v, const float *constants)
{
    t->counts.guards++;
    t->counts.compared += v->burnt.count;
    for (uint32_t i = 0; i < v->burnt.count; i++)
        if (v->burnt.word[i] != word_of(constants, v->burnt.at[i]))
            return false;
    return true;
}

/* The variant with the most words whose guard holds; null: none. */
static const struct variant *find_holding(struct track *t, const struct variant *except,
                                          const float *constants)
{
    const struct variant *found = NULL;
    for (uint32_t n = 0; n < t->counts.variants; n++) {
        const struct variant *v = t->variant + n;
        if (v != except && (!found || v->burnt.count > found->burnt.count) && holds(t, v, constants))
            found = v;
    }
    return found;
}

/* Takes the words that are old enough. Returns 0, or -1 if memory is short. */
static int take_words(const struct track *t, struct burnt_words *burnt, uint64_t *hash, uint32_t age)
{
    uint32_t *at = malloc(2 * (size_t)t->counts.words * sizeof *at + 1), *word = at + t->counts.words;
    *burnt = (struct burnt_words){0, at, word};
    if (!at)
        return -1;
    for (uint32_t i = 0; i < t->counts.words; i++)
        if (t->counts.draws - t->since[i] >= age) {
            at[burnt->count] = t->at[i];
            word[burnt->count++] = t->word[i];
        }
    *hash =
        XXH3_64bits_withSeed(word, burnt->count * sizeof *word, XXH3_64bits(at, burnt->count * sizeof *at));
    return 0;
}

static const struct variant *find_same(const struct track *t, const struct burnt_words *burnt, uint64_t hash)
{
    const size_t bytes = burnt->count * sizeof *burnt->at;
    for (uint32_t n = 0; n < t->counts.variants; n++) {
        const struct variant *v = t->variant + n;
        if (v->hash == hash && v->burnt.count == burnt->count && !memcmp(v->burnt.at, burnt->at, bytes) &&
            !memcmp(v->burnt.word, burnt->word, bytes))
            return v;
    }
    return NULL;
}

/* To the cache and its reports a variant is the routine. */
static void take_identity(struct routine *to, const struct routine *from)
{
    to->lanes = from->lanes;
    to->number = from->number;
    to->time = from->time;
    to->entry = from->entry;
    to->traits = from->traits;
    to->depth_plane = from->depth_plane;
    to->span_blocks = from->span_blocks;
    to->joined_blocks = from->joined_blocks;
}

/* Returns the new variant, which owns the arrays of `burnt`; null if it cannot be built. */
static const struct variant *build_variant(struct track *t, const struct burnt_words *burnt, uint64_t hash)
{
    struct error error;
    const struct routine *r = t->routine;
    struct build_options options = specialize_options(r->engine, r->unit);
    options.track = 0;
    options.burnt = burnt;
    struct routine *routine = specialize_routine(r->engine, &options, t->arena, r->unit, &r->key, &error);
    if (!routine)
        return NULL;
    take_identity(routine, r);
    struct variant *v = t->variant + t->counts.variants++;
    *v = (struct variant){routine, *burnt, hash};
    t->counts.burnt += burnt->count;
    t->counts.bytes +=
        routine->code_bytes + sizeof *routine + 2 * (size_t)t->counts.words * sizeof *burnt->at;
    return v;
}

static void stop(struct track *t)
{
    t->counts.refused++;
    t->stopped = true;
    t->due = NEVER;
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

static void note_due(struct track *t, uint64_t draw)
{
    if (draw < t->due)
        t->due = draw;
}

static void note_values(struct track *t, const float *constants, uint32_t age)
{
    t->counts.compared += t->counts.words;
    for (uint32_t i = 0; i < t->counts.words; i++) {
        uint32_t word = word_of(constants, t->at[i]);
        if (t->number && word == t->word[i])
            continue;
        t->word[i] = word;
        t->since[i] = t->counts.draws;
        note_due(t, t->counts.draws + age);
    }
}

static void use_guards(struct track *t, const float *constants)
{
    const struct variant *before = t->in_use;
    if (before && holds(t, before, constants))
        return;
    t->counts.failures += before != NULL;
    t->in_use = find_holding(t, before, constants);
}

/* Some words are old enough: uses the variant for all that are. */
static void burn_old(struct track *t, uint32_t age)
{
    struct burnt_words burnt;
    uint64_t hash;
    const struct variant *v = NULL;
    t->due = NEVER;
    for (uint32_t i = 0; i < t->counts.words; i++)
        if (t->since[i] + age > t->counts.draws)
            note_due(t, t->since[i] + age);
    if (take_words(t, &burnt, &hash, age)) {
        stop(t);
        return;
    }
    const struct variant *same = find_same(t, &burnt, hash);
    if (!same && t->counts.variants < TRACK_VARIANTS)
        v = build_variant(t, &burnt, hash);
    if (!v)
        free((void *)(uintptr_t)burnt.at);
    if (same || v)
        t->in_use = same ? same : v;
    else
        stop(t);
}

const struct routine *specialize_select(const struct routine *routine, const float *constants,
                                        uint64_t number)
{
    struct track *t = track_of(routine);
    uint32_t age = ((const struct build_options *)routine->engine->options)->track;
    if (!t)
        return routine;
    t->counts.draws++;
    if (number != t->number) {
        if (!t->stopped)
            note_values(t, constants, age);
        use_guards(t, constants);
        t->number = number;
    }
    if (t->counts.draws >= t->due)
        burn_old(t, age);
    t->counts.burnt_draws += t->in_use != NULL;
    return t->in_use ? t->in_use->routine : routine;
}

/* --- Routines ------------------------------------------------------------------------------------------- */

static uint32_t count_words(const uint64_t constants[TRACKED_WORDS / 64])
{
    uint32_t count = 0;
    for (unsigned i = 0; i < TRACKED_WORDS / 64; i++)
        count += (uint32_t)__builtin_popcountll(constants[i]);
    return count;
}

static void destroy(struct track *t)
{
    if (!t)
        return;
    for (uint32_t n = 0; n < t->counts.variants; n++) {
        t->routine->engine->free(t->arena, t->variant[n].routine);
        free((void *)(uintptr_t)t->variant[n].burnt.at);
    }
    free(t->at);
    free(t->word);
    free(t->since);
    free(t);
}

static struct track *create(uint32_t words)
{
    struct track *t = calloc(1, sizeof *t);
    if (!t)
        return NULL;
    t->at = malloc(words * sizeof *t->at);
    t->word = malloc(words * sizeof *t->word);
    t->since = malloc(words * sizeof *t->since);
    if (t->at && t->word && t->since)
        return t;
    destroy(t);
    return NULL;
}

int specialize_track(const uint64_t constants[TRACKED_WORDS / 64], struct code_arena *arena,
                     struct routine *routine, struct error *error)
{
    uint32_t words = count_words(constants);
    if (!words)
        return 0;
    struct track *t = create(words);
    if (!t)
        return error_set(error, "out of memory for the constants that a routine tracks");
    t->arena = arena;
    t->routine = routine;
    t->due = NEVER;
    for (uint32_t at = 0; at < TRACKED_WORDS; at++)
        if (constants[at / 64] >> at % 64 & 1)
            t->at[t->counts.words++] = at;
    routine->tracking = &t->counts;
    routine->data_bytes +=
        (uint32_t)(sizeof *t + words * (sizeof *t->at + sizeof *t->word + sizeof *t->since));
    return 0;
}

void specialize_track_free(struct routine *routine)
{
    destroy(track_of(routine));
    routine->tracking = NULL;
}
