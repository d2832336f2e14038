/* A vertex in camera space: what lighting, fog and generated texture coordinates start from, computed once.
 */

struct camera {
    flt position[3];
    flt normal[3];
};

/* The model's space and what leads out of it. */
struct body {
    struct vector4 position;
    int one; /* position has no w: it is 1 */
    struct skin skin;
    flt blended[4]; /* in camera space, when matrices are blended */
};

static inline int reads_channel(const struct vertex_key *k, int channel)
{
    return k->varying[varying_texcoord(channel)] || k->varying[varying_third(channel)] ||
           k->varying[varying_divisor(channel)];
}

static inline int lights_read(const struct vertex_key *k, int positioned)
{
    for (int i = 0; i < LIGHT_COUNT; i++)
        if (k->light[i] > (positioned ? LIGHT_DIRECTIONAL : LIGHT_NONE))
            return 1;
    return 0;
}

/* Whether a channel that the pixel routine reads is generated from what lies between two generators. */
static inline int channels_generate(const struct vertex_key *k, int first, int last)
{
    for (int channel = 0; channel < TEXTURE_STAGES; channel++)
        if (reads_channel(k, channel) && k->texcoord[channel] >= first && k->texcoord[channel] <= last)
            return 1;
    return 0;
}

static inline int reads_camera_position(const struct vertex_key *k)
{
    int highlights = k->highlight != HIGHLIGHT_NONE && k->local_viewer;
    return (k->lighting && (highlights || lights_read(k, 1))) ||
           (k->varying[VARYING_fog] && k->fog != VERTEX_FOG_SPECULAR_ALPHA) ||
           k->point_size == POINT_SIZE_SCALED || channels_generate(k, COORDINATE_POSITION, COORDINATE_SPHERE);
}

static inline int reads_camera_normal(const struct vertex_key *k)
{
    return (k->lighting && lights_read(k, 0)) || channels_generate(k, COORDINATE_NORMAL, COORDINATE_NORMAL) ||
           channels_generate(k, COORDINATE_REFLECTION, COORDINATE_SPHERE);
}

static inline void camera_normal(struct env *e, const struct vertex_key *k, const struct body *body,
                                 flt normal[3])
{
    struct vector4 n = tween(E, k, ATTRIBUTE_NORMAL, ATTRIBUTE_NORMAL1, 3);
    for (int c = 0; c < 3; c++)
        normal[c] = k->matrices ? skin_normal(E, k, &body->skin, n.v, c)
                                : transform_direction(E, n.v, (int)offsetof(struct job, normal), c);
    if (!k->normalize)
        return;
    flt squared = dot3(E, normal, normal);
    flt inverse = reciprocal_length(E, squared);
    for (int c = 0; c < 3; c++)
        normal[c] = mul_f(E, normal[c], inverse);
}

static inline void camera_space(struct env *e, const struct vertex_key *k, const struct body *body,
                                struct camera *camera)
{
    if (reads_camera_position(k))
        for (int c = 0; c < 3; c++)
            camera->position[c] = k->matrices ? body->blended[c]
                                              : transform_component(E, &body->position, body->one,
                                                                    (int)offsetof(struct job, world_view), c);
    if (reads_camera_normal(k))
        camera_normal(E, k, body, camera->normal);
}
