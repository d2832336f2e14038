/* Depth, stencil and samples: which tests there are, and what can come of them. */
#include "render/derive/derive_part.h"
#include "contract/key_query.h"

#include <string.h>

/* EQUAL never changes the stored depth: both are as the format stores them, and in 0..1 without denormals or
 * -0 equal means the same bits. NEVER changes nothing at all. */
static void derive_depth_test(const struct state *state, struct pixel_key *key)
{
    key->depth_function = COMPARE_ALWAYS;
    if (!GET(state, zenable) || !depth_formats[state->depth_format].depth_bits)
        return;
    key->depth_function = derive_compare(GET(state, zfunc));
    key->depth_write = GET(state, zwriteenable) && key->depth_function != COMPARE_EQUAL;
}

/* One winding's test. */
struct side {
    uint8_t function, fail, depth_fail, pass;
};

static struct side make_side(uint32_t function, uint32_t fail, uint32_t depth_fail, uint32_t pass)
{
    return (struct side){derive_compare(function), derive_stencil_operation(fail),
                         derive_stencil_operation(depth_fail), derive_stencil_operation(pass)};
}

/* The masks of a side, within the bits of the format. */
struct masks {
    uint32_t compared, written;
};

/* Equal operations need no decision between them: what cannot happen is made equal to what can. */
static struct side reduce_side(struct side s, struct masks masks, uint8_t depth_function)
{
    if (!masks.compared) { /* 0 is compared with 0 */
        int equal = s.function == COMPARE_EQUAL || s.function == COMPARE_LESS_EQUAL ||
                    s.function == COMPARE_GREATER_EQUAL || s.function == COMPARE_ALWAYS;
        s.function = equal ? COMPARE_ALWAYS : COMPARE_NEVER;
    }
    if (!masks.written)
        return (struct side){s.function, STENCIL_KEEP, STENCIL_KEEP, STENCIL_KEEP};
    if (s.function == COMPARE_NEVER)
        return (struct side){s.function, s.fail, s.fail, s.fail};
    if (depth_function == COMPARE_ALWAYS)
        s.depth_fail = s.pass;
    if (depth_function == COMPARE_NEVER)
        s.pass = s.depth_fail;
    if (s.function == COMPARE_ALWAYS)
        s.fail = s.pass;
    return s;
}

static void store_side(struct pixel_key *key, int i, struct side s)
{
    key->stencil_function[i] = s.function;
    key->stencil_fail[i] = s.fail;
    key->stencil_depth_fail[i] = s.depth_fail;
    key->stencil_pass[i] = s.pass;
}

void derive_no_stencil(struct pixel_key *key)
{
    key->stencil = STENCIL_OFF;
    key->stencil_values = STENCIL_VALUES_FIRST;
    for (int i = 0; i < STENCIL_SIDES; i++)
        store_side(key, i, (struct side){0});
}

static bool same_side(struct side a, struct side b)
{
    return a.function == b.function && a.fail == b.fail && a.depth_fail == b.depth_fail && a.pass == b.pass;
}

/* Returns true if the side reads its reference or a mask. */
static bool reads_values(struct side s)
{
    return (s.function != COMPARE_NEVER && s.function != COMPARE_ALWAYS) || s.fail || s.depth_fail || s.pass;
}

static struct side first_side(const struct state *state, uint8_t depth_function)
{
    uint32_t bits = stencil_mask(state->depth_format);
    struct masks masks = {GET(state, stencilmask) & bits, GET(state, stencilwritemask) & bits};
    return reduce_side(make_side(GET(state, stencilfunc), GET(state, stencilfail), GET(state, stencilzfail),
                                 GET(state, stencilpass)),
                       masks, depth_function);
}

static struct side second_side(const struct state *state, uint8_t depth_function)
{
    uint32_t bits = stencil_mask(state->depth_format);
    bool own = GET(state, stencilseparate);
    struct masks masks = {(own ? GET(state, ccw_stencilmask) : GET(state, stencilmask)) & bits,
                          (own ? GET(state, ccw_stencilwritemask) : GET(state, stencilwritemask)) & bits};
    return reduce_side(make_side(GET(state, ccw_stencilfunc), GET(state, ccw_stencilfail),
                                 GET(state, ccw_stencilzfail), GET(state, ccw_stencilpass)),
                       masks, depth_function);
}

/* Lines and points go by the first test. Two are one where only one winding is drawn, or both are alike and
 * read the same values; a test that passes everything and changes nothing is none. Values that are not read
 * do not matter. */
static void derive_stencil(const struct state *state, enum primitive primitive, struct pixel_key *key)
{
    static const struct side nothing = {COMPARE_ALWAYS, STENCIL_KEEP, STENCIL_KEEP, STENCIL_KEEP};
    if (!GET(state, stencilenable) || !stencil_mask(state->depth_format))
        return;
    struct side first = first_side(state, key->depth_function), second = first;
    uint8_t values = STENCIL_VALUES_FIRST;
    if (GET(state, twosidedstencilmode) && primitive_has_area(primitive) &&
        GET(state, cullmode) != CULLMODE_ccw) {
        bool only = GET(state, cullmode) == CULLMODE_cw;
        second = second_side(state, key->depth_function);
        first = only ? second : first;
        if (GET(state, stencilseparate) && reads_values(second))
            values = only ? STENCIL_VALUES_SECOND : STENCIL_VALUES_EACH;
    }
    if (same_side(first, nothing) && same_side(second, nothing))
        return;
    bool one = same_side(first, second) && values != STENCIL_VALUES_EACH;
    key->stencil = one ? STENCIL_ONE : STENCIL_TWO;
    key->stencil_values = values;
    store_side(key, SIDE_CLOCKWISE, first);
    if (key->stencil == STENCIL_TWO)
        store_side(key, SIDE_COUNTERCLOCKWISE, second);
}

void derive_depth(const struct state *state, enum primitive primitive, struct pixel_key *key)
{
    derive_depth_test(state, key);
    derive_stencil(state, primitive, key);
}

/* Returns true if a pixel can pass all tests. */
bool derive_passes(const struct pixel_key *key)
{
    bool stencil = !key->stencil;
    for (int i = 0; i < key->stencil; i++)
        stencil |= key->stencil_function[i] != COMPARE_NEVER;
    return stencil && key->depth_function != COMPARE_NEVER && key->alpha_discard != COMPARE_ALWAYS;
}

/* Returns true if depth affects the result. */
static bool depth_matters(const struct pixel_key *key)
{
    bool matters = pixel_write_mask(key) || key->depth_write || key->count;
    for (int i = 0; i < key->stencil; i++)
        matters |= key->stencil_pass[i] != key->stencil_depth_fail[i];
    return matters;
}

/* Sample i of n is one of the first `samplecoverage` of them if that is at least (2 i + 1) / 2 n, as with
 * alpha to coverage (spec/pixel/multisample.h). */
static uint32_t sample_coverage(const struct state *state)
{
    uint32_t samples = 1u << state->samples, mask = 0;
    for (uint32_t i = 0; i < samples; i++)
        if (GET_FLOAT(state, samplecoverage) * (float)(2 * samples) >= (float)(2 * i + 1))
            mask |= 1u << i;
    return GET(state, samplecoverageinvert) ? ~mask : mask;
}

struct sampling derive_sampling(const struct state *state)
{
    if (!state->samples)
        return (struct sampling){.mask = 1};
    uint32_t mask = GET(state, multisamplemask) & sample_coverage(state);
    return (struct sampling){.samples = state->samples,
                             .centers = !GET(state, multisampleantialias),
                             .mask = (uint8_t)(mask & ((1u << (1 << state->samples)) - 1))};
}

/* When it is known what is tested and written. */
void derive_depth_format(const struct state *state, struct pixel_key *key)
{
    struct sampling sampling = derive_sampling(state);
    if (derive_effective(key)) {
        key->samples = sampling.samples;
        key->sample_centers = sampling.centers;
    }
    if (!depth_matters(key))
        key->depth_function = COMPARE_ALWAYS;
    key->depth_w = pixel_tests_depth(key) && GET(state, zenable) == ZBUFFER_usew;
    if (pixel_tests_depth(key) || key->stencil)
        key->depth_format = (uint8_t)depth_formats[state->depth_format].storage;
}
