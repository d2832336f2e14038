/* Values that the renderer accepts. Direct3D lets a program set any number and returns it; what a number that
 * does not exist means is not defined. Here it means what graphics chips of the time did, or the default. */
#include "front/d3d9/state.h"

#include <float.h>
#include <math.h>
#include <string.h>

float d3d9_state_finite(float number)
{
    if (isnan(number))
        return 0;
    return number > FLT_MAX ? FLT_MAX : number < -FLT_MAX ? -FLT_MAX : number;
}

static uint32_t sanitize_real(const struct triptych_kind *kind, uint32_t value)
{
    float number;
    memcpy(&number, &value, sizeof number);
    number = d3d9_state_finite(number);
    return triptych_float_bits(number < kind->first ? (float)kind->first : number);
}

static uint32_t sanitize_number(const struct triptych_kind *kind, uint32_t value)
{
    uint32_t last = (uint32_t)kind->last, first = (uint32_t)kind->first;
    if (value >= first && value <= last)
        return value;
    /* Bits and bytes: what is beyond them is not stored. */
    if (!(last & (last + 1)))
        return value & last;
    return value < first ? first : last;
}

static bool works(const struct triptych_kind *kind, uint32_t value)
{
    const struct triptych_value *row = triptych_value_find(kind, value);
    return row && row->support == TRIPTYCH_SUPPORT_YES;
}

/* One coordinate is none, as on the chips of one maker, and so is a count that does not exist. */
static uint32_t sanitize_transform(uint32_t value)
{
    enum { PROJECTED = 0x100, COUNT = 0xff };
    uint32_t count = value & COUNT;
    return (value & PROJECTED) | (count > 4 || count == 1 ? 0 : count);
}

/* The last factor or operation of blending that Direct3D has. The renderer has others of OpenGL. */
static bool is_of_opengl(enum triptych_state_table table, unsigned row, uint32_t value)
{
    if (table != TRIPTYCH_RENDER_STATES)
        return false;
    switch (row) {
    case TRIPTYCH_STATE_SRCBLEND:
    case TRIPTYCH_STATE_DESTBLEND:
    case TRIPTYCH_STATE_SRCBLENDALPHA:
    case TRIPTYCH_STATE_DESTBLENDALPHA: return value > TRIPTYCH_BLEND_INVSRCCOLOR2;
    case TRIPTYCH_STATE_BLENDOP:
    case TRIPTYCH_STATE_BLENDOPALPHA: return value > TRIPTYCH_BLENDOP_MAX;
    default: return false;
    }
}

/* A word by its number, for a number that does not exist or is not supported. */
static uint32_t sanitize_word(enum triptych_state_table table, unsigned row, unsigned i, uint32_t value)
{
    const struct triptych_kind *kind = triptych_state_at(table, row)->kind;
    if (table == TRIPTYCH_SAMPLER_STATES && row == TRIPTYCH_SAMPLER_SRGBTEXTURE)
        return value & 1;
    if (works(kind, 1) && works(kind, 0) && !works(kind, 2))
        return value != 0;
    if (table == TRIPTYCH_SAMPLER_STATES && value > TRIPTYCH_FILTER_LINEAR &&
        row >= TRIPTYCH_SAMPLER_MAGFILTER && row <= TRIPTYCH_SAMPLER_MIPFILTER)
        return TRIPTYCH_FILTER_LINEAR;
    if (table == TRIPTYCH_STAGE_STATES && row == TRIPTYCH_STAGE_TEXCOORDINDEX &&
        works(kind, value & ~UINT32_C(0xfff8)))
        return value & ~UINT32_C(0xfff8);
    if (table == TRIPTYCH_STAGE_STATES && row == TRIPTYCH_STAGE_ALPHAOP &&
        value > TRIPTYCH_TEXTUREOP_PREMODULATE)
        return TRIPTYCH_TEXTUREOP_SELECTARG1;
    return triptych_state_default(table, row, i);
}

uint32_t d3d9_state_sanitize(enum triptych_state_table table, unsigned row, unsigned i, uint32_t value)
{
    const struct triptych_state_row *state = triptych_state_at(table, row);
    if (state->support != TRIPTYCH_SUPPORT_YES)
        return triptych_state_default(table, row, i);
    switch (state->kind->notation) {
    case TRIPTYCH_NOTATION_REAL: return sanitize_real(state->kind, value);
    case TRIPTYCH_NOTATION_NUMBER:
    case TRIPTYCH_NOTATION_HEXADECIMAL: return sanitize_number(state->kind, value);
    case TRIPTYCH_NOTATION_WORDS: break;
    }
    if (table == TRIPTYCH_STAGE_STATES && row == TRIPTYCH_STAGE_TEXTURETRANSFORMFLAGS)
        return sanitize_transform(value);
    if (is_of_opengl(table, row, value))
        return triptych_state_default(table, row, i);
    return works(state->kind, value) ? value : sanitize_word(table, row, i, value);
}
