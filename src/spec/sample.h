/* Texture sampling of an RGBA8 image: addressing, point and bilinear filtering, in integers.
 *
 * A coordinate becomes texels in 24.8 fixed point, round(u * width * 256), so positions and bilinear weights
 * have 8 bits. Point takes the texel that contains the position; bilinear blends the four texels whose
 * centres surround it, horizontally then vertically, each step round((a * (256 - f) + b * f) / 256). Every
 * texel index ends within the image whatever the coordinate (NaN and infinity too): gathers need no mask.
 *
 * Addressing turns each tap's index i into one from 0 to size - 1:
 *
 *   WRAP         i modulo size
 *   MIRROR       j = i modulo 2 * size; j, or 2 * size - 1 - j where j >= size
 *   MIRROR_ONCE  i or -1 - i, whichever is not negative, at most size - 1
 *   CLAMP        the nearest of 0 to size - 1
 *   BORDER       as CLAMP; a texel whose index had to change, on this axis, is the border colour instead,
 * each of the four of bilinear filtering by itself
 *
 * On a power of two WRAP and MIRROR take bits of the index. Otherwise the coordinate's whole periods go
 * first, u - floor(u) or u - 2 * floor(u / 2), and an index that steps over an edge is brought back. */

struct axis {
    itg index[2];  /* of the texel and, bilinear only, its right or lower neighbour */
    itg wanted[2]; /* the same before addressing */
    fix weight;    /* of the neighbour, 0 to 255, in both halves; bilinear only */
};

/* The job's fields of one axis. */
struct axis_fields {
    int size, size_256, last;
};

/* A field of the texture's description in the job. */
static inline int texture_field(int stage, size_t field)
{
    return (int)(offsetof(struct job, texture) + (size_t)stage * sizeof(struct texture_job) + field);
}

#define TEXTURE_FIELD(stage, field) texture_field(stage, offsetof(struct texture_job, field))

static inline struct axis_fields axis_fields(int stage, int vertical)
{
    struct axis_fields across = {TEXTURE_FIELD(stage, width), TEXTURE_FIELD(stage, width_256),
                                 TEXTURE_FIELD(stage, last_u)};
    struct axis_fields down = {TEXTURE_FIELD(stage, height), TEXTURE_FIELD(stage, height_256),
                               TEXTURE_FIELD(stage, last_v)};
    return vertical ? down : across;
}

static inline itg clamp_index(struct env *e, itg index, itg last)
{
    itg low = max_i(E, index, lit_i(E, 0));
    return min_i(E, low, last);
}

/* Brings index from [-size, 2 * size) into [0, size), and anything else to an edge. */
static inline itg wrap_index(struct env *e, itg index, itg size, itg last)
{
    msk below = gt_i(E, lit_i(E, 0), index);
    itg raised = add_i(E, index, size);
    itg r = select_i(E, below, raised, index);
    msk above = gt_i(E, r, last);
    itg lowered = sub_i(E, r, size);
    r = select_i(E, above, lowered, r);
    return clamp_index(E, r, last);
}

/* The index reflected at the image's lower edge: -1 is 0. */
static inline itg fold_index(struct env *e, itg index)
{
    itg reflected = xor_i(E, index, lit_i(E, -1));
    return max_i(E, index, reflected);
}

/* From [-2 * size, 2 * size) as defined; 2 * size, which is 0 again, and anything else to 0. */
static inline itg mirror_index(struct env *e, itg index, itg size, itg last)
{
    itg folded = fold_index(E, index);
    itg end = add_i(E, size, last);
    itg reflected = sub_i(E, end, folded);
    itg r = min_i(E, folded, reflected);
    return max_i(E, r, lit_i(E, 0));
}

/* The bit `size` of the index tells the images that are reflected. */
static inline itg mirror_power_index(struct env *e, itg index, itg size, itg last)
{
    itg bit = and_i(E, index, size);
    msk odd = eq_i(E, bit, size);
    itg flip = mask_i(E, odd);
    itg turned = xor_i(E, index, flip);
    return and_i(E, turned, last);
}

static inline itg address_index(struct env *e, int address, itg index, const struct axis_fields *fields)
{
    itg last = uniform_i(E, BASE_JOB, fields->last);
    if (address == ADDRESS_WRAP_POWER)
        return and_i(E, index, last);
    if (address == ADDRESS_CLAMP || address == ADDRESS_BORDER)
        return clamp_index(E, index, last);
    if (address == ADDRESS_MIRROR_ONCE) {
        itg folded = fold_index(E, index);
        return min_i(E, folded, last);
    }
    itg size = uniform_i(E, BASE_JOB, fields->size);
    switch (address) {
    case ADDRESS_MIRROR: return mirror_index(E, index, size, last);
    case ADDRESS_MIRROR_POWER: return mirror_power_index(E, index, size, last);
    default: return wrap_index(E, index, size, last);
    }
}

/* The coordinate without its whole periods, where they are not a power of two of texels. */
static inline flt address_period(struct env *e, int address, flt coordinate)
{
    if (address == ADDRESS_WRAP) {
        flt whole = floor_f(E, coordinate);
        return sub_f(E, coordinate, whole);
    }
    if (address == ADDRESS_MIRROR) {
        flt half = mul_f(E, coordinate, lit_f(E, 0.5f));
        flt whole = floor_f(E, half);
        flt even = add_f(E, whole, whole);
        return sub_f(E, coordinate, even);
    }
    return coordinate;
}

static inline struct axis address_axis(struct env *e, const struct pixel_key *k, int stage, int address,
                                       flt coordinate, int vertical)
{
    struct axis r;
    struct axis_fields fields = axis_fields(stage, vertical);
    flt inner = address_period(E, address, coordinate);
    flt size_256 = uniform_f(E, BASE_JOB, fields.size_256);
    flt scaled = mul_f(E, inner, size_256);
    itg position = round_i(E, scaled);
    if (k->filter[stage] == FILTER_LINEAR)
        position = sub_i(E, position, lit_i(E, 128));
    itg index = shr_i(E, position, 8);
    r.index[0] = address_index(E, address, index, &fields);
    r.index[1] = r.index[0];
    r.wanted[0] = r.wanted[1] = index;
    r.weight = lit_x(E, 0);
    if (k->filter[stage] == FILTER_LINEAR) {
        itg next = add_i(E, index, lit_i(E, 1));
        r.index[1] = address_index(E, address, next, &fields);
        r.wanted[1] = next;
        itg fraction = and_i(E, position, lit_i(E, 255));
        r.weight = both_halves(E, fraction);
    }
    return r;
}

/* The texel, or the border colour where one of the axes has a border and its index is not the one that was
 * wanted. */
static inline itg border_texel(struct env *e, int stage, const struct axis *axis, int tap, itg texel)
{
    msk inside = eq_i(E, axis->wanted[tap], axis->index[tap]);
    itg border = uniform_i(E, BASE_JOB, TEXTURE_FIELD(stage, border));
    return select_i(E, inside, texel, border);
}

/* The texel of column tap `i` and row tap `j`, whose row starts at texel number `row`. */
static inline itg texel(struct env *e, const struct pixel_key *k, int stage, const struct axis *u, int i,
                        const struct axis *v, int j, itg row)
{
    itg index = add_i(E, row, u->index[i]);
    itg word = gather_i(E, BASE_JOB, TEXTURE_FIELD(stage, texels), index, 4, 0);
    if (k->address_u[stage] == ADDRESS_BORDER)
        word = border_texel(E, stage, u, i, word);
    if (k->address_v[stage] == ADDRESS_BORDER)
        word = border_texel(E, stage, v, j, word);
    return word;
}

static inline fix lerp_256(struct env *e, fix a, fix b, fix inverse, fix weight)
{
    fix left = mul_x(E, a, inverse);
    fix right = mul_x(E, b, weight);
    fix sum = add_x(E, left, right);
    fix rounded = add_x(E, sum, lit_x(E, 128));
    return ushr_x(E, rounded, 8);
}

static inline struct color lerp_color(struct env *e, itg a, itg b, fix inverse, fix weight)
{
    struct color left = color_unpack(E, a);
    struct color right = color_unpack(E, b);
    struct color r;
    r.rb = lerp_256(E, left.rb, right.rb, inverse, weight);
    r.ga = lerp_256(E, left.ga, right.ga, inverse, weight);
    return r;
}

static inline struct color sample_bilinear(struct env *e, const struct pixel_key *k, int stage,
                                           const struct axis *u, const struct axis *v, itg width)
{
    itg upper_row = dot_i(E, v->index[0], width);
    itg upper_left = texel(E, k, stage, u, 0, v, 0, upper_row);
    itg upper_right = texel(E, k, stage, u, 1, v, 0, upper_row);
    itg lower_row = dot_i(E, v->index[1], width);
    itg lower_left = texel(E, k, stage, u, 0, v, 1, lower_row);
    itg lower_right = texel(E, k, stage, u, 1, v, 1, lower_row);
    fix inverse_u = sub_x(E, lit_x(E, 256), u->weight);
    fix inverse_v = sub_x(E, lit_x(E, 256), v->weight);
    struct color upper = lerp_color(E, upper_left, upper_right, inverse_u, u->weight);
    struct color lower = lerp_color(E, lower_left, lower_right, inverse_u, u->weight);
    struct color r;
    r.rb = lerp_256(E, upper.rb, lower.rb, inverse_v, v->weight);
    r.ga = lerp_256(E, upper.ga, lower.ga, inverse_v, v->weight);
    return r;
}

/* The texture of a stage at u, v. */
static inline struct color sample(struct env *e, const struct pixel_key *k, int stage, flt u, flt v)
{
    struct axis across = address_axis(E, k, stage, k->address_u[stage], u, 0);
    struct axis down = address_axis(E, k, stage, k->address_v[stage], v, 1);
    itg width = uniform_i(E, BASE_JOB, TEXTURE_FIELD(stage, width));
    if (k->filter[stage] == FILTER_LINEAR)
        return sample_bilinear(E, k, stage, &across, &down, width);
    itg row = dot_i(E, down.index[0], width);
    itg word = texel(E, k, stage, &across, 0, &down, 0, row);
    return color_unpack(E, word);
}
