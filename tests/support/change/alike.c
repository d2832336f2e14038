#include "alike.h"

#include <string.h>

/* Different keys that may have the same code, and the reasons. */
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

/* Returns true if a stage before the last only copies an argument. */
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

static bool other_precisions_of_a_shader(const struct pixel_key *a, const struct pixel_key *b)
{
    return a->precision != b->precision && key_program(a->shader) && key_program(b->shader);
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
    {other_precisions_of_a_shader, "nothing may read the inputs of a shader that w interpolates"},
    {one_copies, "a stage that hands on a source gives the next stage what it can name itself"},
};

enum { ALIKES = sizeof alikes / sizeof *alikes };

static bool alike_needed[ALIKES];

/* Two vertex shaders may differ only in outputs that the pixel routine does not read. */
static bool other_vertex_shaders(enum unit unit, const union key *a, const union key *b)
{
    const struct vertex_key *x = &a->vertex, *y = &b->vertex;
    return unit == UNIT_VERTEX && key_program(x->shader) != key_program(y->shader);
}

bool alike_keys(enum unit unit, const union key *a, const union key *b)
{
    bool result = other_vertex_shaders(unit, a, b);
    for (unsigned i = 0; i < ALIKES && unit == UNIT_PIXEL; i++)
        if (alikes[i].applies(&a->pixel, &b->pixel))
            alike_needed[i] = result = true;
    return result;
}

const char *alike_unneeded(void)
{
    for (unsigned i = 0; i < ALIKES; i++)
        if (!alike_needed[i])
            return alikes[i].reason;
    return NULL;
}
