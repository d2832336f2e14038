/* Texture sampling of an RGBA8 image: addressing, point and bilinear filtering, in integers.
 *
 * A coordinate becomes texels in 24.8 fixed point, round(u * width * 256), so positions and bilinear weights
 * have 8 bits. Point takes the texel that contains the position; bilinear blends the four texels whose
 * centres surround it, horizontally then vertically, each step round((a * (256 - f) + b * f) / 256). Every
 * texel index ends within the image whatever the coordinate (NaN and infinity too): gathers need no mask.
 *
 * Wrap on a power of two masks the index. Otherwise u - floor(u) comes first and an index that steps over an
 * edge is brought back by one width. */

struct axis {
    itg first;  /* texel index */
    itg second; /* its right or lower neighbour; bilinear only */
    fix weight; /* of second, 0 to 255, in both halves; bilinear only */
};

/* The job's fields of one axis. */
struct axis_fields {
    int size, size_256, last;
};

static inline struct axis_fields axis_fields(int vertical)
{
    static const struct axis_fields fields[2] = {
        {offsetof(struct job, texture.width), offsetof(struct job, texture.width_256),
         offsetof(struct job, texture.last_u)},
        {offsetof(struct job, texture.height), offsetof(struct job, texture.height_256),
         offsetof(struct job, texture.last_v)}};
    return fields[vertical];
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

static inline itg address_index(struct env *e, int address, itg index, const struct axis_fields *fields)
{
    itg last = uniform_i(E, BASE_JOB, fields->last);
    if (address == ADDRESS_WRAP_POWER)
        return and_i(E, index, last);
    if (address == ADDRESS_CLAMP)
        return clamp_index(E, index, last);
    itg size = uniform_i(E, BASE_JOB, fields->size);
    return wrap_index(E, index, size, last);
}

static inline struct axis address_axis(struct env *e, const struct pixel_key *k, int address, flt coordinate,
                                       int vertical)
{
    struct axis r;
    struct axis_fields fields = axis_fields(vertical);
    if (address == ADDRESS_WRAP) {
        flt whole = floor_f(E, coordinate);
        coordinate = sub_f(E, coordinate, whole);
    }
    flt size_256 = uniform_f(E, BASE_JOB, fields.size_256);
    flt scaled = mul_f(E, coordinate, size_256);
    itg position = round_i(E, scaled);
    if (k->filter == FILTER_LINEAR)
        position = sub_i(E, position, lit_i(E, 128));
    itg index = shr_i(E, position, 8);
    r.first = address_index(E, address, index, &fields);
    r.second = r.first;
    r.weight = lit_x(E, 0);
    if (k->filter == FILTER_LINEAR) {
        itg next = add_i(E, index, lit_i(E, 1));
        r.second = address_index(E, address, next, &fields);
        itg fraction = and_i(E, position, lit_i(E, 255));
        r.weight = both_halves(E, fraction);
    }
    return r;
}

static inline itg texel(struct env *e, itg row, itg column)
{
    itg index = add_i(E, row, column);
    return gather_i(E, BASE_JOB, (int)offsetof(struct job, texture.texels), index, 4, 0);
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

static inline struct color sample_bilinear(struct env *e, const struct axis *u, const struct axis *v,
                                           itg width)
{
    itg upper_row = dot_i(E, v->first, width);
    itg upper_left = texel(E, upper_row, u->first);
    itg upper_right = texel(E, upper_row, u->second);
    itg lower_row = dot_i(E, v->second, width);
    itg lower_left = texel(E, lower_row, u->first);
    itg lower_right = texel(E, lower_row, u->second);
    fix inverse_u = sub_x(E, lit_x(E, 256), u->weight);
    fix inverse_v = sub_x(E, lit_x(E, 256), v->weight);
    struct color upper = lerp_color(E, upper_left, upper_right, inverse_u, u->weight);
    struct color lower = lerp_color(E, lower_left, lower_right, inverse_u, u->weight);
    struct color r;
    r.rb = lerp_256(E, upper.rb, lower.rb, inverse_v, v->weight);
    r.ga = lerp_256(E, upper.ga, lower.ga, inverse_v, v->weight);
    return r;
}

static inline struct color sample(struct env *e, const struct pixel_key *k, flt u, flt v)
{
    struct axis across = address_axis(E, k, k->address_u, u, 0);
    struct axis down = address_axis(E, k, k->address_v, v, 1);
    itg width = uniform_i(E, BASE_JOB, (int)offsetof(struct job, texture.width));
    if (k->filter == FILTER_LINEAR)
        return sample_bilinear(E, &across, &down, width);
    itg row = dot_i(E, down.first, width);
    itg word = texel(E, row, across.first);
    return color_unpack(E, word);
}
