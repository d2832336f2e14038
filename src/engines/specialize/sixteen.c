#include "engines/specialize/sixteen.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <immintrin.h>

struct sixteen {
    struct routine_second second; /* the first member: routine->second */
    struct code_arena *arena;
    routine_function *first;         /* the routine's own code */
    _Atomic(struct routine *) built; /* null: not yet, or never */
    struct pass_shapes shapes;       /* written before `built` */
    uint32_t pairs;                  /* blocks of second.blocks that a pass over two blocks would have */
    bool has_pairs; /* the second code computes two blocks in a pass; written before `built` */
};

static struct sixteen *sixteen_of(const struct routine *routine)
{
    return (struct sixteen *)(uintptr_t)routine->second;
}

bool specialize_may_sixteen(const struct build_options *options, enum unit unit)
{
    return options->sixteen && options->width == 8 && options->parts <= 1 && unit == UNIT_PIXEL &&
           options->calls == CALLS_INLINE && options->addresses == ADDRESSES_LOADED && !options->track &&
           !options->burnt;
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

/* Of four entries, the words of coverage and block number. */
static __m128i load_coverage(const __m128i *entry)
{
    __m128i low = _mm_unpackhi_epi32(_mm_loadu_si128(entry), _mm_loadu_si128(entry + 1));
    __m128i high = _mm_unpackhi_epi32(_mm_loadu_si128(entry + 2), _mm_loadu_si128(entry + 3));
    return _mm_unpacklo_epi64(low, high);
}

/* Of four entries, -1 for each that is covered in both halves. */
static __m128i both_of_four(const struct entry *entries)
{
    const __m128i coverage = load_coverage((const __m128i *)(const void *)entries);
    const __m128i empty = _mm_cmpeq_epi8(coverage, _mm_setzero_si128());
    return _mm_cmpeq_epi32(_mm_slli_epi32(empty, 16), _mm_setzero_si128());
}

/* The sum of four words. */
static uint32_t sum(__m128i words)
{
    words = _mm_add_epi32(words, _mm_unpackhi_epi64(words, words));
    return (uint32_t)_mm_cvtsi128_si32(_mm_add_epi32(words, _mm_shuffle_epi32(words, 1)));
}

uint32_t specialize_count_both(const struct entry *entries, uint32_t count)
{
    enum { SAMPLE = 64 };
    uint32_t i = 0, seen = 0, step = count < 2 * SAMPLE ? 4 : count / SAMPLE * 4;
    __m128i fours = _mm_setzero_si128();
    for (; i + 4 <= count; i += step, seen += 4)
        fours = _mm_sub_epi32(fours, both_of_four(entries + i));
    uint32_t both = sum(fours);
    for (; step == 4 && i < count; i++, seen++)
        both += (entries[i].coverage & 0xff) && entries[i].coverage >> 8;
    return seen == count ? both : (uint32_t)((uint64_t)both * count / seen);
}

/* The passes over these entries that have a second block (frame.c). */
static uint32_t pairs_of(const struct entry *entries, uint32_t count)
{
    uint32_t pairs = 0;
    for (uint32_t i = 1; i < count; i++)
        if (entries[i].triangle == entries[i - 1].triangle && entries[i].block != entries[i - 1].block) {
            pairs++;
            i++;
        }
    return pairs;
}

uint32_t specialize_count_pairs(const struct entry *entries, uint32_t count)
{
    enum { SAMPLES = 4, SAMPLE = 32 };
    uint32_t pairs = 0;
    if (count <= SAMPLES * SAMPLE)
        return pairs_of(entries, count);
    for (uint32_t i = 0; i < SAMPLES; i++)
        pairs += pairs_of(entries + i * (count / SAMPLES), SAMPLE);
    return (uint32_t)((uint64_t)pairs * count / (SAMPLES * SAMPLE));
}

bool specialize_is_worth(const struct pass_shapes *shapes)
{
    return shapes->two < shapes->one - shapes->one / 32;
}

/* The time of the first code in half cycles. A pass takes half of shapes->one, and each block has one or two.
 * Its branches are predicted as for most blocks, so that each of the others costs the time of a wrong
 * prediction. */
static uint64_t time_of_first(const struct pass_shapes *shapes, uint32_t count, uint32_t both)
{
    enum { MISPREDICTED = 20 /* cycles */ };
    const uint32_t others = both < count - both ? both : count - both;
    return (uint64_t)(count + both) * shapes->one + 2 * (uint64_t)others * MISPREDICTED;
}

/* A pass computes a pair of blocks, or one block in the same time. */
bool specialize_prefers_pairs(const struct pass_shapes *shapes, uint32_t count, uint32_t both, uint32_t pairs)
{
    return 4 * (uint64_t)(count - pairs) * shapes->four < time_of_first(shapes, count, both);
}

bool specialize_prefers_sixteen(const struct pass_shapes *shapes, uint32_t count, uint32_t both)
{
    return 2 * (uint64_t)count * shapes->two < time_of_first(shapes, count, both);
}

/* Adds up the blocks of calls in which most blocks are covered in both halves. */
static void count_blocks(struct sixteen *s, const struct pixel_arguments *call, uint32_t both)
{
    if (both < call->count - both)
        return;
    __atomic_fetch_add(&s->second.blocks, both, __ATOMIC_RELAXED);
    __atomic_fetch_add(&s->pairs, 2 * specialize_count_pairs(call->entries, call->count), __ATOMIC_RELAXED);
}

/* Returns true if the second code is faster for a call. */
static bool prefers_second(const struct sixteen *s, const struct pixel_arguments *call, uint32_t both)
{
    if (!s->has_pairs)
        return specialize_prefers_sixteen(&s->shapes, call->count, both);
    const uint32_t pairs = specialize_count_pairs(call->entries, call->count);
    return specialize_prefers_pairs(&s->shapes, call->count, both, pairs);
}

/* Returns true if a call has too few blocks to be worth a count, or there is no other code for it. */
static bool has_first_only(const struct sixteen *s, const struct pixel_arguments *call)
{
    enum { FEW = 4 };
    return call->count < FEW || call->tile ||
           (__atomic_load_n(&s->second.is_decided, __ATOMIC_RELAXED) &&
            !atomic_load_explicit(&s->built, memory_order_relaxed));
}

static void run_either(const void *arguments, const struct routine *routine)
{
    const struct pixel_arguments *call = arguments;
    struct sixteen *s = sixteen_of(routine);
    if (has_first_only(s, call)) {
        s->first(arguments, routine);
        return;
    }
    const uint32_t both = specialize_count_both(call->entries, call->count);
    const struct routine *built = atomic_load_explicit(&s->built, memory_order_acquire);
    if (!built)
        count_blocks(s, call, both);
    if (!built || !prefers_second(s, call, both)) {
        s->first(arguments, routine);
        return;
    }
    __atomic_fetch_add(&s->second.runs, 1, __ATOMIC_RELAXED);
    built->run(arguments, built);
}

/* --- Building ------------------------------------------------------------------------------------------- */

/* Returns true if of four blocks that were counted at least three have a pair. */
static bool has_many_pairs(struct sixteen *s)
{
    const uint64_t blocks = __atomic_load_n(&s->second.blocks, __ATOMIC_RELAXED);
    return 4 * (uint64_t)__atomic_load_n(&s->pairs, __ATOMIC_RELAXED) >= 3 * blocks;
}

void specialize_build_sixteen(const struct routine *routine)
{
    struct sixteen *s = sixteen_of(routine);
    struct build_options options = specialize_options(routine->engine, routine->unit);
    struct error error = {{0}};
    options.parts = 2;
    options.sixteen = 0;
    options.shapes = &s->shapes;
    options.may_pair = has_many_pairs(s);
    struct routine *built =
        specialize_routine(routine->engine, &options, s->arena, routine->unit, &routine->key, &error);
    if (built) {
        s->second.bytes = built->code_bytes + sizeof *built;
        s->second.routine = built;
        s->has_pairs = built->lanes > BLOCK_PIXELS;
        atomic_store_explicit(&s->built, built, memory_order_release);
    }
    __atomic_store_n(&s->second.is_decided, true, __ATOMIC_RELAXED);
}

int specialize_sixteen(struct code_arena *arena, struct routine *routine, const struct pass_shapes *shapes,
                       struct error *error)
{
    const struct build_options options = specialize_options(routine->engine, routine->unit);
    struct sixteen *s = calloc(1, sizeof *s);
    if (!s)
        return error_set(error, "out of memory for the state of a routine");
    s->arena = arena;
    s->first = routine->run;
    s->shapes = *shapes;
    s->second.least = options.sixteen;
    routine->second = &s->second;
    routine->run = run_either;
    routine->data_bytes += (uint32_t)sizeof *s;
    return 0;
}

void specialize_sixteen_free(struct routine *routine)
{
    struct sixteen *s = sixteen_of(routine);
    if (!s)
        return;
    struct routine *built = atomic_load_explicit(&s->built, memory_order_acquire);
    if (built)
        routine->engine->free(s->arena, built);
    routine->second = NULL;
    free(s);
}
