/* The vertex routine: fetch, transform, light, clip code; one lane a vertex (draw/call.h, struct
 * vertex_call).
 *
 * Bases: JOB; INPUT is the lanes' vertex indices; OUTPUT the lanes' place in the vertex batch. Outputs that
 * the pixel routine does not read are not in the key's varyings: their whole computation is dead. */

static inline void store_slot(struct env *e, int slot, flt value)
{
    store_f(E, BASE_OUTPUT, slot * VERTEX_SLOT_BYTES, value);
}

static inline flt clamp_unit(struct env *e, flt value)
{
    flt low = max_f(E, value, lit_f(E, 0.0f));
    return min_f(E, low, lit_f(E, 1.0f));
}

static inline void vertex_diffuse(struct env *e, const struct vertex_key *k, const struct vector4 *position)
{
    struct vector4 color;
    if (k->lighting)
        color = light_vertex(E, k, position);
    else
        color = fetch(E, k, ATTRIBUTE_DIFFUSE, 1.0f);
    for (int c = 0; c < 4; c++) {
        flt clamped = clamp_unit(E, color.v[c]);
        store_slot(E, SLOT_diffuse + c, clamped);
    }
}

/* Where the vertex is: in clip space, or in the window if it was transformed before. */
static inline void vertex_position(struct env *e, const struct vertex_key *k, struct vector4 *position)
{
    int window = k->attribute[ATTRIBUTE_POSITIONT] != ATTRIBUTE_FORMAT_NONE;
    *position = fetch(E, k, window ? ATTRIBUTE_POSITIONT : ATTRIBUTE_POSITION, 0.0f);
    int one = !has_fourth(k, ATTRIBUTE_POSITION);
    flt to[4];
    for (int c = 0; c < 4; c++) {
        to[c] = window ? position->v[c]
                       : transform_component(E, position, one,
                                             (int)offsetof(struct job, world_view_projection), c);
        store_slot(E, SLOT_X + c, to[c]);
    }
    itg code = window ? clip_code_window(E, to) : clip_code(E, k, to);
    store_i(E, BASE_OUTPUT, SLOT_CODE * VERTEX_SLOT_BYTES, code);
}

/* The coordinates of a channel, from its set: two, and a third where it is read. */
static inline void vertex_texcoord(struct env *e, const struct vertex_key *k, int channel)
{
    int varying = varying_texcoord(channel);
    if (!k->varying[varying])
        return;
    struct vector4 uv = fetch(E, k, ATTRIBUTE_TEXCOORD + k->texcoord[channel], 0.0f);
    for (int c = 0; c < 2; c++)
        store_slot(E, varying_slot[varying] + c, uv.v[c]);
    if (k->varying[varying_third(channel)])
        store_slot(E, varying_slot[varying_third(channel)], uv.v[2]);
}

/* What nothing computes yet: no highlights, no fog, no division. */
static inline void vertex_constants(struct env *e, const struct vertex_key *k)
{
    for (int v = 0; v < VARYING_COUNT; v++) {
        for (int c = 0; c < varying_components[v]; c++)
            if (k->varying[v] && (varying_is_divisor(v) || v >= VARYING_specular))
                store_slot(E, varying_slot[v] + c, lit_f(E, v == VARYING_specular ? 0.0f : 1.0f));
    }
}

static void spec_vertex(struct env *e, const struct vertex_key *k)
{
    struct vector4 position;
    vertex_position(E, k, &position);
    if (k->varying[VARYING_diffuse])
        vertex_diffuse(E, k, &position);
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        vertex_texcoord(E, k, channel);
    vertex_constants(E, k);
}
