/* Texture stage 0: combines diffuse, texture and the texture factor.
 *
 * Colour and alpha each have an operation and up to three arguments. All channels are 0 to 255; a, b, c are
 * the arguments that Direct3D 9 calls 1, 2 and 0, and every result is clamped to 0..255:
 *
 *   SELECT         a
 *   MODULATE       p = round(a * b / 255); 2X and 4X: 2 * p, 4 * p
 *   ADD            a + b
 *   ADD_SIGNED     a + b - 128; 2X: 2 * (a + b - 128)
 *   SUBTRACT       a - b
 *   MULTIPLY_ADD   c + round(a * b / 255)
 *   LERP           round((a * c + b * (255 - c)) / 255)
 *   DOT            floor(sum over red, green, blue of (a - 128) * (b - 128) / 64), in all four channels
 *
 * A half is 127.5 of 255 and not a channel's value; 128 is what signed maps store for zero, so adding one
 * changes nothing and its dot product is 0. An argument's complement is 255 minus it, after its alpha was
 * replicated. */

static inline struct color stage_source(struct env *e, int source, struct color diffuse, struct color texture)
{
    switch (source) {
    case SOURCE_DIFFUSE: return diffuse;
    case SOURCE_TEXTURE: return texture;
    }
    itg factor = uniform_i(E, BASE_JOB, (int)offsetof(struct job, texture_factor));
    return color_unpack(E, factor);
}

static inline struct color stage_argument(struct env *e, int argument, struct color diffuse,
                                          struct color texture)
{
    struct color r = stage_source(E, argument % SOURCE_COUNT, diffuse, texture);
    if (argument / ARGUMENT_REPLICATE & 1)
        r.rb = r.ga = color_alpha(E, r);
    if (argument / ARGUMENT_COMPLEMENT) {
        r.rb = sub_x(E, lit_x(E, 255), r.rb);
        r.ga = sub_x(E, lit_x(E, 255), r.ga);
    }
    return r;
}

static inline fix double_saturated(struct env *e, fix a)
{
    return add_saturated(E, a, a);
}

static inline fix stage_lerp(struct env *e, fix a, fix b, fix weight)
{
    fix inverse = sub_x(E, lit_x(E, 255), weight);
    fix first = mul_x(E, a, weight);
    fix second = mul_x(E, b, inverse);
    fix sum = add_x(E, first, second);
    return divide_255(E, sum);
}

static inline fix add_signed(struct env *e, fix a, fix b)
{
    fix sum = add_x(E, a, b);
    return subtract_saturated(E, sum, lit_x(E, 128));
}

static inline fix stage_multiply_add(struct env *e, fix a, fix b, fix addend)
{
    fix product = modulate(E, a, b);
    return add_saturated(E, addend, product);
}

static inline fix stage_modulate(struct env *e, int operation, fix a, fix b)
{
    fix r = modulate(E, a, b);
    if (operation != STAGE_MODULATE)
        r = double_saturated(E, r);
    if (operation == STAGE_MODULATE_4X)
        r = double_saturated(E, r);
    return r;
}

/* One pair of channels; an operation reads as many arguments as stage_arguments says. */
static inline fix stage_combine(struct env *e, int operation, fix a, fix b, fix c)
{
    switch (operation) {
    case STAGE_ADD: return add_saturated(E, a, b);
    case STAGE_ADD_SIGNED: {
        fix sum = add_signed(E, a, b);
        return min_x(E, sum, lit_x(E, 255));
    }
    case STAGE_ADD_SIGNED_2X: {
        fix sum = add_signed(E, a, b);
        return double_saturated(E, sum);
    }
    case STAGE_SUBTRACT: return subtract_saturated(E, a, b);
    case STAGE_MULTIPLY_ADD: return stage_multiply_add(E, a, b, c);
    case STAGE_LERP: return stage_lerp(E, a, b, c);
    case STAGE_SELECT: return a;
    default: return stage_modulate(E, operation, a, b);
    }
}

static inline itg signed_pair(struct env *e, fix channels)
{
    fix r = sub_x(E, channels, lit_x(E, 128));
    return int_of(E, r);
}

/* Signed products of red and blue, then of green alone: alpha is taken out before. */
static inline struct color stage_dot(struct env *e, struct color a, struct color b)
{
    itg a_rb = signed_pair(E, a.rb);
    itg b_rb = signed_pair(E, b.rb);
    itg red_and_blue = dot_i(E, a_rb, b_rb);
    itg a_ga = signed_pair(E, a.ga);
    itg a_green = and_i(E, a_ga, lit_i(E, 0xffff));
    itg b_ga = signed_pair(E, b.ga);
    itg green = dot_i(E, a_green, b_ga);
    itg sum = add_i(E, red_and_blue, green);
    itg scaled = shr_i(E, sum, 6);
    itg low = max_i(E, scaled, lit_i(E, 0));
    itg limited = min_i(E, low, lit_i(E, 255));
    struct color r;
    r.rb = r.ga = both_halves(E, limited);
    return r;
}

static inline struct color stage_half(struct env *e, int operation, const uint8_t argument[STAGE_ARGUMENTS],
                                      struct color diffuse, struct color texture)
{
    struct color v[STAGE_ARGUMENTS], r;
    for (int i = 0; i < STAGE_ARGUMENTS; i++)
        v[i] = i < stage_arguments[operation] ? stage_argument(E, argument[i], diffuse, texture) : v[0];
    if (operation == STAGE_DOT)
        return stage_dot(E, v[0], v[1]);
    r.rb = stage_combine(E, operation, v[0].rb, v[1].rb, v[2].rb);
    r.ga = stage_combine(E, operation, v[0].ga, v[1].ga, v[2].ga);
    return r;
}

static inline struct color stage(struct env *e, const struct pixel_key *k, struct color diffuse,
                                 struct color texture)
{
    struct color color = stage_half(E, k->color_stage, k->color_argument, diffuse, texture);
    if (stage_is_joint(k))
        return color;
    struct color alpha = stage_half(E, k->alpha_stage, k->alpha_argument, diffuse, texture);
    itg color_ga = int_of(E, color.ga);
    itg alpha_ga = int_of(E, alpha.ga);
    itg green = and_i(E, color_ga, lit_i(E, 0x0000ffff));
    itg top = and_i(E, alpha_ga, lit_i(E, -0x10000));
    itg both = or_i(E, green, top);
    color.ga = fix_of(E, both);
    return color;
}
