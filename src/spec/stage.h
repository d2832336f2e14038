/* Texture stage 0: combines diffuse and texture, all four channels alike. */

static inline struct color stage(struct env *e, const struct pixel_key *k, struct color diffuse,
                                 struct color texture)
{
    struct color r = diffuse;
    switch (k->stage) {
    case STAGE_REPLACE: r = texture; break;
    case STAGE_MODULATE:
        r.rb = modulate(E, texture.rb, diffuse.rb);
        r.ga = modulate(E, texture.ga, diffuse.ga);
        break;
    case STAGE_ADD:
        r.rb = add_saturated(E, texture.rb, diffuse.rb);
        r.ga = add_saturated(E, texture.ga, diffuse.ga);
        break;
    }
    return r;
}
