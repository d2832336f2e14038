/* The vertex key: what of the vertex declaration, of lighting, fog and blending the setup key's varyings
 * need. */
#include "render/derive/derive_part.h"

/* The bound format, cut to the components that the vertex routine can read. */
uint8_t derive_format(const struct state_element *element, int components)
{
    int format = (int)element->format;
    int last = ATTRIBUTE_FORMAT_FLOAT1 + components - 1;
    bool floats = key_vertex_types[format].encoding == ENCODING_FLOAT;
    return (uint8_t)(floats && format > last ? last : format);
}

static void need(const struct state *state, struct vertex_key *key, enum attribute attribute, int components)
{
    key->attribute[attribute] = derive_format(&state->element[attribute], components);
}

static bool is_declared(const struct state *state, enum attribute attribute)
{
    return state->element[attribute].format != TRIPTYCH_FORMAT_NONE;
}

static bool in_window(const struct vertex_key *key)
{
    return key->attribute[ATTRIBUTE_POSITIONT] != ATTRIBUTE_FORMAT_NONE;
}

/* --- Positions --- */

/* One matrix with weight 1 is the first world matrix, unless vertices have indices. */
static void derive_blending(const struct state *state, struct vertex_key *key)
{
    int weights = 0;
    switch ((enum triptych_vertexblend)GET(state, vertexblend)) {
    case TRIPTYCH_VERTEXBLEND_DISABLE: return;
    case TRIPTYCH_VERTEXBLEND_TWEENING:
        key->tween = 1;
        need(state, key, ATTRIBUTE_POSITION1, 4);
        return;
    case TRIPTYCH_VERTEXBLEND_0WEIGHTS: weights = 0; break;
    case TRIPTYCH_VERTEXBLEND_1WEIGHTS: weights = 1; break;
    case TRIPTYCH_VERTEXBLEND_2WEIGHTS: weights = 2; break;
    case TRIPTYCH_VERTEXBLEND_3WEIGHTS: weights = 3; break;
    }
    key->indexed_matrices = GET(state, indexedvertexblendenable) != 0;
    if (!weights && !key->indexed_matrices)
        return;
    key->matrices = (uint8_t)(weights + 1);
    if (weights)
        need(state, key, ATTRIBUTE_WEIGHTS, weights);
    if (key->indexed_matrices)
        need(state, key, ATTRIBUTE_INDICES, weights + 1);
}

static void derive_position(const struct state *state, struct vertex_key *key)
{
    if (is_declared(state, ATTRIBUTE_POSITIONT)) {
        need(state, key, ATTRIBUTE_POSITIONT, 4);
        return;
    }
    need(state, key, ATTRIBUTE_POSITION, 4);
    derive_blending(state, key);
}

/* --- Colours --- */

/* A colour that the vertex does not have is the material's (Direct3D 9, D3DRS_DIFFUSEMATERIALSOURCE). */
static uint8_t derive_source(const struct state *state, uint32_t source)
{
    bool follows = GET(state, colorvertex);
    switch ((enum triptych_materialsource)source) {
    case TRIPTYCH_MATERIALSOURCE_MATERIAL: return REFLECTANCE_MATERIAL;
    case TRIPTYCH_MATERIALSOURCE_COLOR1:
        return follows && is_declared(state, ATTRIBUTE_DIFFUSE) ? REFLECTANCE_DIFFUSE_COLOR
                                                                : REFLECTANCE_MATERIAL;
    case TRIPTYCH_MATERIALSOURCE_COLOR2:
        return follows && is_declared(state, ATTRIBUTE_SPECULAR) ? REFLECTANCE_SPECULAR_COLOR
                                                                 : REFLECTANCE_MATERIAL;
    }
    derive_impossible("material source", source);
}

static void derive_reflectances(const struct state *state, struct vertex_key *key)
{
    if (key->varying[VARYING_diffuse]) {
        key->reflectance[REFLECTANCE_DIFFUSE] = derive_source(state, GET(state, diffusematerialsource));
        key->reflectance[REFLECTANCE_AMBIENT] = derive_source(state, GET(state, ambientmaterialsource));
        key->reflectance[REFLECTANCE_EMISSIVE] = derive_source(state, GET(state, emissivematerialsource));
    }
    if (key->highlight != HIGHLIGHT_NONE)
        key->reflectance[REFLECTANCE_SPECULAR] = derive_source(state, GET(state, specularmaterialsource));
    for (int i = 0; i < REFLECTANCE_COUNT; i++)
        if (key->reflectance[i] == REFLECTANCE_DIFFUSE_COLOR)
            need(state, key, ATTRIBUTE_DIFFUSE, 4);
        else if (key->reflectance[i] == REFLECTANCE_SPECULAR_COLOR)
            need(state, key, ATTRIBUTE_SPECULAR, 4);
}

static uint8_t derive_light(const struct triptych_light *light)
{
    if (light->type == TRIPTYCH_LIGHT_SPOT)
        return light->falloff == 1 ? LIGHT_SPOT : LIGHT_SPOT_POWER;
    return (uint8_t)(light->type + LIGHT_DIRECTIONAL);
}

static void derive_highlight(const struct state *state, struct vertex_key *key)
{
    float power = state->material.power;
    if (!key->varying[VARYING_specular] || !GET(state, specularenable))
        return;
    key->highlight = power == 0 ? HIGHLIGHT_FLAT : power == 1 ? HIGHLIGHT_LINEAR : HIGHLIGHT_POWER;
    key->local_viewer = GET(state, localviewer) != 0;
}

/* Without a normal it is zero, of length one or not: a cosine of a zero vector is a zero or a NaN, and either
 * gives no light. */
static void derive_normal(const struct state *state, struct vertex_key *key)
{
    need(state, key, ATTRIBUTE_NORMAL, 3);
    if (key->tween)
        need(state, key, ATTRIBUTE_NORMAL1, 3);
    bool any = key->attribute[ATTRIBUTE_NORMAL] || key->attribute[ATTRIBUTE_NORMAL1];
    key->normalize = any && GET(state, normalizenormals);
}

/* Without highlights the specular colour is black whatever the lights are. */
static bool lights_matter(const struct state *state, const struct vertex_key *key)
{
    return key->varying[VARYING_diffuse] || GET(state, specularenable);
}

/* Without lights the normal is not read. */
static void derive_lighting(const struct state *state, struct vertex_key *key)
{
    int count = 0;
    key->lighting = 1;
    for (int i = 0; i < LIGHT_COUNT && lights_matter(state, key); i++)
        if (state->light_enabled[i])
            key->light[count++] = derive_light(&state->light[i]);
    if (count) {
        derive_normal(state, key);
        derive_highlight(state, key);
    }
    derive_reflectances(state, key);
}

static void derive_colors(const struct state *state, struct vertex_key *key)
{
    int diffuse = key->varying[VARYING_diffuse], specular = key->varying[VARYING_specular];
    if ((diffuse || specular) && GET(state, lighting) && !in_window(key)) {
        derive_lighting(state, key);
        return;
    }
    if (diffuse)
        need(state, key, ATTRIBUTE_DIFFUSE, 4);
    if (specular)
        need(state, key, ATTRIBUTE_SPECULAR, 4);
}

/* --- Fog --- */

static void derive_vertex_fog(const struct state *state, struct vertex_key *key)
{
    if (!key->varying[VARYING_fog])
        return;
    key->fog = in_window(key) ? VERTEX_FOG_SPECULAR_ALPHA : derive_fog_mode(GET(state, fogvertexmode));
    if (key->fog == VERTEX_FOG_SPECULAR_ALPHA)
        need(state, key, ATTRIBUTE_SPECULAR, 4);
    else
        key->fog_range = GET(state, rangefogenable) != 0;
}

/* --- Texture coordinates --- */

static bool reads_channel(const struct vertex_key *key, int channel)
{
    return key->varying[varying_texcoord(channel)] || key->varying[varying_third(channel)] ||
           key->varying[varying_divisor(channel)];
}

/* How many components of the set reach the pixel, or the matrix. */
static int coordinates_needed(const struct vertex_key *key, int channel)
{
    if (key->texture_matrix[channel] || key->varying[varying_divisor(channel)])
        return 4;
    return key->varying[varying_third(channel)] ? 3 : 2;
}

static uint32_t columns_of(const struct state *state, int stage)
{
    return STAGE(state, stage, texturetransformflags) & TEXTURETRANSFORM_COUNT_MASK;
}

/* The columns of the matrix that are read. Positions in the window are not transformed. */
static uint8_t derive_columns(const struct state *state, int stage, int channel, const struct vertex_key *key)
{
    uint32_t columns = columns_of(state, stage);
    uint32_t most = key->varying[varying_divisor(channel)] ? 4 : key->varying[varying_third(channel)] ? 3 : 2;
    if (in_window(key))
        return 0;
    return (uint8_t)(columns < most ? columns : most);
}

/* Shaders divide by themselves; after a matrix of three columns they get the third as the fourth too. */
static bool third_divides(const struct state *state, const struct pixel_key *pixel, int stage, int channel,
                          const struct vertex_key *key)
{
    bool stages = !key_program(pixel->shader);
    return key->varying[varying_divisor(channel)] &&
           (columns_of(state, stage) == 3 || (stages && derive_projection(state, stage) == PROJECTED_THIRD));
}

/* The numbers of Direct3D 9's generators are the high half of the state, from 1. */
static void derive_coordinates(const struct state *state, const struct pixel_key *pixel, int stage,
                               int channel, struct vertex_key *key)
{
    uint32_t index = STAGE(state, stage, texcoordindex), generator = index >> 16;
    key->texture_matrix[channel] = derive_columns(state, stage, channel, key);
    key->third_divides[channel] = third_divides(state, pixel, stage, channel, key);
    if (generator && !in_window(key)) {
        key->texcoord[channel] = (uint8_t)(COORDINATE_NORMAL + generator - 1);
        if (key->texcoord[channel] != COORDINATE_POSITION)
            derive_normal(state, key);
        return;
    }
    key->texcoord[channel] = index & (TEXCOORD_SETS - 1);
    enum attribute attribute = ATTRIBUTE_TEXCOORD + key->texcoord[channel];
    uint8_t format = key->attribute[attribute];
    need(state, key, attribute, coordinates_needed(key, channel));
    if (format > key->attribute[attribute]) /* another channel needs more of it */
        key->attribute[attribute] = format;
}

/* A point sprite's texture coordinates are setup's. */
static bool is_read(const struct setup_key *setup, int varying)
{
    bool smooth = setup->varying[varying] == INTERPOLATION_SMOOTH;
    return setup->varying[varying] != INTERPOLATION_NONE && !(smooth && primitive_is_point(setup->primitive));
}

static void derive_fixed(const struct state *state, const struct pixel_key *pixel,
                         const struct setup_key *setup, struct vertex_key *key)
{
    derive_position(state, key);
    derive_colors(state, key);
    derive_vertex_fog(state, key);
    if (key->varying[VARYING_blending])
        derive_blending_inputs(state, key);
    key->point_size = (uint8_t)derive_point_size(state, setup->primitive);
    if (key->point_size != POINT_SIZE_CONSTANT)
        need(state, key, ATTRIBUTE_POINT_SIZE, 1);
    for (int channel = 0; channel < TEXTURE_STAGES; channel++) {
        int stage = derive_channel_set(state, pixel, channel);
        if (reads_channel(key, channel) && stage >= 0 && stage < TEXTURE_STAGES)
            derive_coordinates(state, pixel, stage, channel, key);
    }
}

void derive_vertex(const struct state *state, const struct pixel_key *pixel, const struct setup_key *setup,
                   struct vertex_key *key)
{
    const struct program *program = derive_vertex_program(state);
    for (int v = 0; v < VARYING_COUNT; v++)
        key->varying[v] = (uint8_t)is_read(setup, v);
    if (program)
        derive_vertex_shader(state, program, setup, key);
    else
        derive_fixed(state, pixel, setup, key);
    if (GET(state, clipping) && !in_window(key))
        key->clip_planes = (uint8_t)__builtin_popcount(GET(state, clipplaneenable));
    derive_links(state, pixel, key);
}
