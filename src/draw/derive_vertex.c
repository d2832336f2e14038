/* The vertex key: what of the vertex declaration and of lighting the setup key's varyings need. */
#include "draw/derive_part.h"

/* The bound format, cut to the components that the vertex routine can read. */
static uint8_t derive_format(const struct state *state, enum attribute attribute, int components)
{
    int format = (int)state->element[attribute].format;
    int last = ATTRIBUTE_FORMAT_FLOAT1 + components - 1;
    int floats = vertex_types[format].encoding == ENCODING_FLOAT;
    return (uint8_t)(floats && format > last ? last : format);
}

/* Without lights nobody reads the normal. Without a normal it is zero, of length one or not: a cosine of a
 * zero vector is a zero or a NaN, and either gives no light. */
static void derive_lighting(const struct state *state, struct vertex_key *key)
{
    int count = 0;
    key->lighting = 1;
    for (int i = 0; i < LIGHT_COUNT; i++)
        if (state->light_enabled[i])
            key->light[count++] = (uint8_t)(state->light[i].type + LIGHT_DIRECTIONAL);
    if (!count)
        return;
    key->attribute[ATTRIBUTE_NORMAL] = derive_format(state, ATTRIBUTE_NORMAL, 3);
    key->normalize = key->attribute[ATTRIBUTE_NORMAL] && GET(normalizenormals);
}

/* The set of coordinates that a channel takes, which is that of each of its stages. */
static void derive_texcoord(const struct state *state, const struct pixel_key *pixel, int channel,
                            struct vertex_key *key)
{
    uint8_t set = (uint8_t)STAGE(derive_channel_stage(pixel, channel), texcoordindex);
    enum attribute attribute = ATTRIBUTE_TEXCOORD + set;
    key->texcoord[channel] = set;
    key->attribute[attribute] = derive_format(state, attribute, key->varying[varying_third(channel)] ? 3 : 2);
}

/* A point sprite's texture coordinates are setup's. */
static int is_read(const struct setup_key *setup, int varying)
{
    int smooth = setup->varying[varying] == INTERPOLATION_SMOOTH;
    return setup->varying[varying] != INTERPOLATION_NONE && !(smooth && primitive_is_point(setup->primitive));
}

void derive_vertex(const struct state *state, const struct pixel_key *pixel, const struct setup_key *setup,
                   struct vertex_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++)
        key->varying[v] = (uint8_t)is_read(setup, v);
    int window = setup->window;
    enum attribute position = window ? ATTRIBUTE_POSITIONT : ATTRIBUTE_POSITION;
    key->attribute[position] = derive_format(state, position, 4);
    if (GET(clipping) && !window)
        key->clip_planes = (uint8_t)__builtin_popcount(GET(clipplaneenable));
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        if (key->varying[varying_texcoord(channel)])
            derive_texcoord(state, pixel, channel, key);
    if (key->varying[VARYING_diffuse] && GET(lighting) && !window)
        derive_lighting(state, key);
    else if (key->varying[VARYING_diffuse])
        key->attribute[ATTRIBUTE_DIFFUSE] = derive_format(state, ATTRIBUTE_DIFFUSE, 4);
}
