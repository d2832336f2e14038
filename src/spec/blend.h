/* Blending of the new colour s with the stored colour d by the new alpha a, all four channels alike.
 *
 *   OVER           round((s * a + d * (255 - a)) / 255)
 *   PREMULTIPLIED  min(255, s + round(d * (255 - a) / 255))
 *   SOURCE         round(s * a / 255) */

static inline fix blend_channel_pair(struct env *e, int blend, fix s, fix d, fix alpha, fix inverse)
{
    switch (blend) {
    case BLEND_OVER: {
        fix new = mul_x(E, s, alpha);
        fix old = mul_x(E, d, inverse);
        fix sum = add_x(E, new, old);
        return divide_255(E, sum);
    }
    case BLEND_PREMULTIPLIED: {
        fix old = modulate(E, d, inverse);
        return add_saturated(E, s, old);
    }
    case BLEND_SOURCE: return modulate(E, s, alpha);
    default: return s;
    }
}

static inline struct color blend(struct env *e, const struct pixel_key *k, struct color s, itg stored)
{
    if (k->blend == BLEND_COPY)
        return s;
    struct color d = color_unpack(E, stored);
    fix alpha = color_alpha(E, s);
    fix inverse = sub_x(E, lit_x(E, 255), alpha);
    struct color r;
    r.rb = blend_channel_pair(E, k->blend, s.rb, d.rb, alpha, inverse);
    r.ga = blend_channel_pair(E, k->blend, s.ga, d.ga, alpha, inverse);
    return r;
}
