#include "state.h"

/* A texel of a texture of 16 texels, read with one of six filters and six ways to repeat it. */
static unsigned texel(unsigned index, unsigned address)
{
    switch (address) {
    case 0: index &= 15; break;                                                /* wrap */
    case 1: index = index < 16 ? index : 15; break;                            /* clamp */
    case 2: index = index & 16 ? 15 - (index & 15) : index & 15; break;        /* mirror */
    case 3: return index < 16 ? index * 16 : 0;                                /* border */
    case 4: index = index < 32 ? (index & 16 ? 31 - index : index) : 0; break; /* mirror once */
    default: index = index < 16 ? index : index % 5; break;
    }
    return (index * 37 + 11) & 255;
}

static unsigned sample(const struct state *state, unsigned u)
{
    unsigned index = u / 4, rest = u % 4, left = texel(index, state->address),
             right = texel(index + 1, state->address);
    switch (state->filter) {
    case 0: return left;
    case 1: return rest < 2 ? left : right;
    case 2: return (left * (4 - rest) + right * rest) / 4;
    case 3: return left > right ? left : right;
    case 4: return left < right ? left : right;
    default: return (left + right) / 2;
    }
}

static unsigned combine(unsigned stage, unsigned diffuse, unsigned color)
{
    switch (stage) {
    case 0: return diffuse; /* the texture is not used */
    case 1: return color;
    case 2: return diffuse * color / 255;
    case 3: return diffuse + color < 255 ? diffuse + color : 255;
    case 4: return diffuse > color ? diffuse - color : 0;
    default: return (diffuse + color) / 2;
    }
}

static int passes(unsigned test, unsigned alpha, unsigned reference)
{
    switch (test) {
    case 0: return 1; /* always: the reference is not read */
    case 1: return alpha < reference;
    case 2: return alpha > reference;
    case 3: return alpha <= reference;
    case 4: return alpha >= reference;
    default: return alpha != reference;
    }
}

static unsigned factor(unsigned which, unsigned source)
{
    switch (which) {
    case 0: return 0;
    case 1: return 255;
    case 2: return source;
    default: return 255 - source;
    }
}

static unsigned blended(const struct state *state, unsigned source, unsigned target)
{
    unsigned sum =
        source * factor(state->source_factor, source) + target * factor(state->destination_factor, source);
    return sum / 255 < 255 ? sum / 255 : 255;
}

unsigned shade(const struct state *state, const struct pixel *pixel)
{
    unsigned color = pixel->diffuse;
    if (state->texture)
        color = combine(state->stage, color, sample(state, pixel->u));
    if (!passes(state->alpha_test, color, state->alpha_reference))
        return pixel->target;
    if (state->fog)
        color = color * (255 - pixel->depth * state->fog_density / 255) / 255;
    return state->blend ? blended(state, color, pixel->target) : color;
}
