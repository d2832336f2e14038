/* Fixed-function lighting in camera space (Direct3D 9, "Mathematics of Lighting"), diffuse and ambient terms.
 *
 *   colour = base + sum over lights of attenuation * (ambient + diffuse * max(0, normal . to_light))
 *
 * base, ambient and diffuse have the material multiplied in already (draw/job.h); alpha is the material's. A
 * point light's attenuation is 1 / (a0 + d * (a1 + d * a2)), and 0 beyond its range. */

static inline int light_field(int light, size_t field)
{
    return (int)(offsetof(struct job, light) + (size_t)light * sizeof(struct light_job) + field);
}

static inline flt light_value(struct env *e, int light, size_t field)
{
    return uniform_f(E, BASE_JOB, light_field(light, field));
}

static inline flt light_facing(struct env *e, const flt normal[3], const flt to_light[3])
{
    flt cosine = dot3(E, normal, to_light);
    return max_f(E, cosine, lit_f(E, 0.0f));
}

static inline void light_directional(struct env *e, int light, const flt normal[3], flt color[3])
{
    flt to_light[3];
    for (int c = 0; c < 3; c++)
        to_light[c] = light_value(E, light, offsetof(struct light_job, position) + 4 * (size_t)c);
    flt facing = light_facing(E, normal, to_light);
    for (int c = 0; c < 3; c++) {
        flt diffuse = light_value(E, light, offsetof(struct light_job, diffuse) + 4 * (size_t)c);
        color[c] = mad_f(E, facing, diffuse, color[c]);
    }
}

static inline flt light_attenuation(struct env *e, int light, flt distance)
{
    flt a0 = light_value(E, light, offsetof(struct light_job, attenuation0));
    flt a1 = light_value(E, light, offsetof(struct light_job, attenuation1));
    flt a2 = light_value(E, light, offsetof(struct light_job, attenuation2));
    flt range = light_value(E, light, offsetof(struct light_job, range));
    flt inner = mad_f(E, distance, a2, a1);
    flt denominator = mad_f(E, distance, inner, a0);
    flt attenuation = div_f(E, lit_f(E, 1.0f), denominator);
    msk reached = le_f(E, distance, range);
    return select_f(E, reached, attenuation, lit_f(E, 0.0f));
}

static inline void light_point(struct env *e, int light, const flt position[3], const flt normal[3],
                               flt color[3])
{
    flt to_light[3];
    for (int c = 0; c < 3; c++) {
        flt at = light_value(E, light, offsetof(struct light_job, position) + 4 * (size_t)c);
        to_light[c] = sub_f(E, at, position[c]);
    }
    flt squared = dot3(E, to_light, to_light);
    flt inverse = reciprocal_length(E, squared);
    flt distance = mul_f(E, squared, inverse);
    for (int c = 0; c < 3; c++)
        to_light[c] = mul_f(E, to_light[c], inverse);
    flt attenuation = light_attenuation(E, light, distance);
    flt facing = light_facing(E, normal, to_light);
    for (int c = 0; c < 3; c++) {
        flt diffuse = light_value(E, light, offsetof(struct light_job, diffuse) + 4 * (size_t)c);
        flt ambient = light_value(E, light, offsetof(struct light_job, ambient) + 4 * (size_t)c);
        flt lit = mad_f(E, facing, diffuse, ambient);
        color[c] = mad_f(E, attenuation, lit, color[c]);
    }
}

static inline void camera_normal(struct env *e, const struct vertex_key *k, flt normal[3])
{
    struct vector4 n = fetch(E, k, ATTRIBUTE_NORMAL, 0.0f);
    for (int c = 0; c < 3; c++)
        normal[c] = transform_direction(E, n.v, (int)offsetof(struct job, normal), c);
    if (!k->normalize)
        return;
    flt squared = dot3(E, normal, normal);
    flt inverse = reciprocal_length(E, squared);
    for (int c = 0; c < 3; c++)
        normal[c] = mul_f(E, normal[c], inverse);
}

static inline struct vector4 light_vertex(struct env *e, const struct vertex_key *k,
                                          const struct vector4 *position)
{
    flt camera[3], normal[3];
    struct vector4 color;
    for (int c = 0; c < 4; c++)
        color.v[c] = uniform_f(E, BASE_JOB, (int)offsetof(struct job, base_color) + 4 * c);
    int one = !has_fourth(k, ATTRIBUTE_POSITION);
    for (int c = 0; c < 3; c++)
        camera[c] = transform_component(E, position, one, (int)offsetof(struct job, world_view), c);
    camera_normal(E, k, normal);
    for (int i = 0; i < LIGHT_COUNT; i++)
        switch (k->light[i]) {
        case LIGHT_DIRECTIONAL: light_directional(E, i, normal, color.v); break;
        case LIGHT_POINT: light_point(E, i, camera, normal, color.v); break;
        }
    return color;
}
