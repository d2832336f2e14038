/* Vertex fetch: attributes of W vertices from the application's buffers into lanes.
 *
 * A vertex index times the stream's stride gives the byte offset; indices were checked against the buffers
 * when the draw was recorded. Missing components read as (0, 0, 0, 1) (Direct3D 9, vertex declarations); a
 * missing normal is (0, 0, 0), a missing diffuse colour opaque white, missing texture coordinates (0, 0). */

struct vector4 {
    flt v[4];
};

static inline flt fetch_float(struct env *e, int attribute, itg offset, int component)
{
    return gather_f(E, BASE_JOB, (int)offsetof(struct job, attribute[attribute].data), offset, 1,
                    4 * component);
}

/* One channel of a packed 0xAARRGGBB as 0 to 1; shift is its lowest bit. */
static inline flt fetch_channel(struct env *e, itg packed, int shift)
{
    itg down = shift ? ushr_i(E, packed, shift) : packed;
    itg byte = shift < 24 ? and_i(E, down, lit_i(E, 255)) : down;
    flt value = float_f(E, byte);
    return mul_f(E, value, lit_f(E, 1.0f / 255.0f));
}

static inline struct vector4 fetch_color(struct env *e, int attribute, itg offset)
{
    static const uint8_t shift[4] = {16, 8, 0, 24};
    struct vector4 r;
    itg packed = gather_i(E, BASE_JOB, (int)offsetof(struct job, attribute[attribute].data), offset, 1, 0);
    for (int c = 0; c < 4; c++)
        r.v[c] = fetch_channel(E, packed, shift[c]);
    return r;
}

static inline struct vector4 fetch(struct env *e, const struct vertex_key *k, int attribute, float absent)
{
    struct vector4 r;
    int format = k->attribute[attribute];
    for (int c = 0; c < 4; c++)
        r.v[c] = lit_f(E, absent);
    if (format == ATTRIBUTE_FORMAT_NONE)
        return r;
    itg index = load_i(E, BASE_INPUT, 0);
    itg stride = uniform_i(E, BASE_JOB, (int)offsetof(struct job, attribute[attribute].stride));
    itg offset = mul_i(E, index, stride);
    if (format == ATTRIBUTE_FORMAT_COLOR)
        return fetch_color(E, attribute, offset);
    int components = format - ATTRIBUTE_FORMAT_FLOAT1 + 1;
    for (int c = 0; c < 4; c++)
        if (c < components)
            r.v[c] = fetch_float(E, attribute, offset, c);
        else
            r.v[c] = lit_f(E, c == 3 ? 1.0f : 0.0f);
    return r;
}
