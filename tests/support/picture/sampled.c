#include "sampled.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const filter_word[] = {"point", "linear", "anisotropic"};
static const char *const mip_word[] = {"none", "point", "linear"};
static const char *const address_word[] = {"wrap", "mirror", "clamp", "border", "mirroronce"};

enum { LEVELS = 8, TEXELS = 1 << 16 };

struct sampled sampled;

const struct sampled_coordinates sampled_magnified = {
    {0.5, 0.5, 0.5}, {0.25, 0.0625, 0.5}, {-0.125, 0.25, 0.0625}};
const struct sampled_coordinates sampled_minified = {{0.5, 0.25, -0.25}, {5, 1, 3}, {-2, 7, 1}};

static uint32_t store[6][LEVELS][TEXELS / 8]; /* images' words */
static uint32_t border;

static int level_side(int level, int axis)
{
    return sampled.size[axis] >> level ? sampled.size[axis] >> level : 1;
}

static void bind_texture(void)
{
    triptych_texture *texture;
    const struct triptych_texture_description description = {sampled.type,
                                                             TRIPTYCH_SURFACE_A8B8G8R8,
                                                             (unsigned)sampled.size[0],
                                                             (unsigned)sampled.size[1],
                                                             (unsigned)sampled.size[2],
                                                             (unsigned)sampled.levels};
    OK(triptych_texture_define(device, &description, &texture));
    for (int f = 0; f < sampled.faces; f++)
        for (int l = 0; l < sampled.levels; l++) {
            size_t row = 4 * (size_t)level_side(l, 0), slice = row * (size_t)level_side(l, 1);
            size_t words = slice / 4 * (size_t)level_side(l, 2);
            TEST_ASSERT_LESS_OR_EQUAL(sizeof store[f][l] / 4, words);
            for (size_t i = 0; i < words; i++)
                store[f][l][i] = random_word();
            OK(triptych_texture_update(device, texture, (unsigned)f, (unsigned)l, NULL, store[f][l], row,
                                       slice));
        }
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
}

static void set_sampling(void)
{
    const enum triptych_sampler_state address[3] = {TRIPTYCH_SAMPLER_ADDRESSU, TRIPTYCH_SAMPLER_ADDRESSV,
                                                    TRIPTYCH_SAMPLER_ADDRESSW};
    float bias = (float)sampled.bias;
    uint32_t bits, color = random_word();
    for (int a = 0; a < 3; a++)
        set_sampler(0, address[a], address_word[sampled.address[a]]);
    set_sampler(0, TRIPTYCH_SAMPLER_MAGFILTER, filter_word[sampled.mag]);
    set_sampler(0, TRIPTYCH_SAMPLER_MINFILTER, filter_word[sampled.min]);
    set_sampler(0, TRIPTYCH_SAMPLER_MIPFILTER, mip_word[sampled.mip]);
    memcpy(&bits, &bias, sizeof bits);
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MIPMAPLODBIAS, bits));
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MAXMIPLEVEL, (uint32_t)sampled.first));
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MAXANISOTROPY,
                                  (uint32_t)(sampled.taps ? sampled.taps : 1)));
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_BORDERCOLOR, color));
    border = image_word(color);
    OK(triptych_set_convention(device, TRIPTYCH_MAGNIFY_LIMIT, sampled.late));
    OK(triptych_set_convention(device, TRIPTYCH_CUBE_ADDRESS, sampled.wrapped));
}

uint32_t sampled_word(int face, int level, int index)
{
    return store[face][level][index];
}

/* --- The definition ------------------------------------------------------------------------------------ */

static int unsure; /* rounding decides between two texels or levels of the pixel */

static long nearest(double value, double margin)
{
    if (fabs(value - floor(value) - 0.5) < margin)
        unsure = 1;
    return lrint(value);
}

static int modulo(long index, int size)
{
    return (int)((index % size + size) % size);
}

static int clamped(long index, int size)
{
    return index < 0 ? 0 : index >= size ? size - 1 : (int)index;
}

/* Returns the index in the image, or -1 for the border. */
static int addressed(long index, int size, int mode)
{
    int within_two = modulo(index, 2 * size);
    if (sampled.type == TRIPTYCH_TEXTURE_CUBE && !sampled.wrapped)
        mode = SAMPLED_CLAMP;
    switch (mode) {
    case SAMPLED_WRAP: return modulo(index, size);
    case SAMPLED_MIRROR: return within_two < size ? within_two : 2 * size - 1 - within_two;
    case SAMPLED_CLAMP: return clamped(index, size);
    case SAMPLED_BORDER: return index < 0 || index >= size ? -1 : (int)index;
    default: return clamped(index < 0 ? -1 - index : index, size);
    }
}

static unsigned mix(unsigned a, unsigned b, unsigned weight)
{
    return (a * (256 - weight) + b * weight + 128) >> 8;
}

static uint32_t mix_words(uint32_t a, uint32_t b, unsigned weight)
{
    uint32_t word = 0;
    for (int c = 0; c < 4; c++)
        word |= mix(channel(a, c), channel(b, c), weight) << 8 * c;
    return word;
}

static uint32_t texel_at(int face, int level, const long index[3])
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        at[a] = a == 2 && sampled.type != TRIPTYCH_TEXTURE_VOLUME
                    ? 0
                    : addressed(index[a], level_side(level, a), sampled.address[a]);
        if (at[a] < 0)
            return border;
    }
    return store[face][level][(at[2] * level_side(level, 1) + at[1]) * level_side(level, 0) + at[0]];
}

/* Blends along the first `axis` axes. `index` has the indices of the other axes. */
static uint32_t blend_axes(int face, int level, int axis, long index[3], const unsigned weight[3])
{
    if (axis == 0)
        return texel_at(face, level, index);
    uint32_t first = blend_axes(face, level, axis - 1, index, weight);
    index[axis - 1]++;
    uint32_t second = blend_axes(face, level, axis - 1, index, weight);
    index[axis - 1]--;
    return mix_words(first, second, weight[axis - 1]);
}

static uint32_t expected_image(int face, int level, const double at[3], int linear)
{
    int axes = sampled.type == TRIPTYCH_TEXTURE_VOLUME ? 3 : 2;
    long index[3] = {0};
    unsigned weight[3] = {0};
    for (int a = 0; a < axes; a++) {
        double scaled = at[a] * level_side(level, a) * 256;
        long position =
            nearest(scaled, sampled.type == TRIPTYCH_TEXTURE_CUBE ? 2e-2 : 0) - (linear ? 128 : 0);
        index[a] = position >> 8;
        weight[a] = linear ? position & 255 : 0;
    }
    return blend_axes(face, level, axes, index, weight);
}

static uint32_t expected_levels(int face, const double at[3], int linear, long lambda)
{
    int last = sampled.levels - 1, first = sampled.first < last ? sampled.first : last;
    if (sampled.mip == SAMPLED_MIP_NO)
        return expected_image(face, 0, at, linear);
    lambda = lambda < 256 * first ? 256 * first : lambda > 256 * last ? 256 * last : lambda;
    if (sampled.mip == SAMPLED_MIP_NEAREST)
        return expected_image(face, (int)(lambda + 128) >> 8, at, linear);
    int level = (int)lambda >> 8, next = level < last ? level + 1 : last;
    return mix_words(expected_image(face, level, at, linear), expected_image(face, next, at, linear),
                     lambda & 255);
}

static double length_of(const double change[3])
{
    double sum = 0;
    for (int a = 0; a < 3; a++)
        sum += change[a] * change[a] * sampled.size[a] * sampled.size[a];
    return sqrt(sum);
}

static long lambda_of(double rho)
{
    double lambda = 256 * (log2(rho) + sampled.bias);
    return rho > 0 ? nearest(lambda, 2e-2) : -1000000;
}

/* Returns the expected texel for coordinates of a face and their changes to the next pixel in x and in y. */
static uint32_t expected_sample(int face, const double at[3], const double across[3], const double down[3])
{
    double a = length_of(across), d = length_of(down), rho = fmax(a, d);
    int matters = sampled.mip != SAMPLED_MIP_NO || sampled.min != sampled.mag;
    long lambda = matters ? lambda_of(rho) : 0;
    bool late = sampled.late && sampled.mip != SAMPLED_MIP_NO && sampled.mag == SAMPLED_LINEAR &&
                sampled.min == SAMPLED_POINT;
    if (late && lambda <= 128)
        lambda = 0;
    int filter = lambda > 0 ? sampled.min : sampled.mag;
    if (sampled.min != SAMPLED_ANISOTROPIC || sampled.taps < 2)
        return expected_levels(face, at, filter != SAMPLED_POINT, lambda);
    const double *step = a >= d ? across : down;
    double count = fmin(floor(rho / fmin(a, d) + 255.0 / 256), sampled.taps);
    int taps = lambda > 0 ? (int)fmax(count, 1) : 1;
    unsigned sum[4] = {0};
    for (int i = 1; i <= taps; i++) {
        double tap[3];
        for (int k = 0; k < 3; k++)
            tap[k] = at[k] + step[k] * ((double)i / (taps + 1) - 0.5);
        uint32_t word = expected_levels(face, tap, filter != SAMPLED_POINT, lambda_of(rho / taps));
        for (int c = 0; c < 4; c++)
            sum[c] += channel(word, c);
    }
    uint32_t word = 0;
    for (int c = 0; c < 4; c++)
        word |= (2 * sum[c] + (unsigned)taps) / (2 * (unsigned)taps) << 8 * c;
    return word;
}

/* Returns the face of a vector, and replaces the vectors by their s, t and m on this face. */
static int cube_face(const double v[3])
{
    double x = fabs(v[0]), y = fabs(v[1]), z = fabs(v[2]);
    int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return 2 * axis + (v[axis] < 0);
}

static void turn(int face, const double v[3], double out[3])
{
    const double s[6] = {-v[2], v[2], v[0], v[0], v[0], -v[0]},
                 u[6] = {-v[1], -v[1], v[2], -v[2], -v[1], -v[1]};
    out[0] = s[face];
    out[1] = u[face];
    out[2] = face % 2 ? -v[face / 2] : v[face / 2];
}

static uint32_t expected_cube(const double v[3], const double across[3], const double down[3])
{
    int face = cube_face(v);
    double c[3], d[2][3], at[3] = {0}, change[2][3] = {{0}};
    turn(face, v, c);
    turn(face, across, d[0]);
    turn(face, down, d[1]);
    for (int a = 0; a < 2; a++) {
        at[a] = (c[a] / c[2] + 1) / 2;
        for (int k = 0; k < 2; k++)
            change[k][a] = (d[k][a] - c[a] / c[2] * d[k][2]) / c[2] / 2;
    }
    for (int a = 0; a < 3; a++) /* edges of faces */
        unsure |= fabs(fabs(v[a]) - c[2]) < 1e-5 && a != face / 2;
    return expected_sample(face, at, change[0], change[1]);
}

/* --- Pictures ------------------------------------------------------------------------------------------ */

static void draw_coordinates(const struct sampled_coordinates *c)
{
    struct {
        float position[2], texcoord[3];
    } vertex[4];
    triptych_buffer *buffer;
    for (int i = 0; i < 4; i++) {
        double x = i % 2 ? 0.5 : -0.5, y = i / 2 ? 0.5 : -0.5;
        vertex[i].position[0] = (float)(2 * x);
        vertex[i].position[1] = (float)(-2 * y);
        for (int a = 0; a < 3; a++)
            vertex[i].texcoord[a] = (float)(c->centre[a] + x * c->across[a] + y * c->down[a]);
    }
    OK(triptych_buffer_create(device, vertex, sizeof vertex, &buffer));
    const struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT2, buffer, 0, sizeof vertex[0]};
    const struct triptych_element texcoord = {TRIPTYCH_FORMAT_FLOAT3, buffer, sizeof vertex[0].position,
                                              sizeof vertex[0]};
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_element(device, TRIPTYCH_TEXCOORD, &texcoord));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
}

static void describe(char what[192])
{
    snprintf(what, 192,
             "%dx%dx%d, type %d, %d levels, address %d %d %d, mag %s, min %s (%d), mip %s from %d, bias %g",
             sampled.size[0], sampled.size[1], sampled.size[2], (int)sampled.type, sampled.levels,
             sampled.address[0], sampled.address[1], sampled.address[2], filter_word[sampled.mag],
             filter_word[sampled.min], sampled.taps, mip_word[sampled.mip], sampled.first, sampled.bias);
}

static int left_out, looked_at;

static void check_pixel(int x, int y, const struct sampled_coordinates *c, const char *what)
{
    double at[3], across[3], down[3];
    for (int a = 0; a < 3; a++) {
        across[a] = c->across[a] / SIZE;
        down[a] = c->down[a] / SIZE;
        at[a] = c->centre[a] + (x + 0.5 - SIZE / 2) * across[a] + (y + 0.5 - SIZE / 2) * down[a];
        if (a == 2 && sampled.type == TRIPTYCH_TEXTURE_2D)
            at[a] = across[a] = down[a] = 0;
    }
    unsure = 0;
    uint32_t expected = sampled.type == TRIPTYCH_TEXTURE_CUBE ? expected_cube(at, across, down)
                                                              : expected_sample(0, at, across, down);
    looked_at++;
    left_out += unsure;
    if (!unsure)
        expect_pixel(x, y, expected, what);
}

void sampled_show(const struct sampled_coordinates *c)
{
    set_sampling();
    draw_coordinates(c);
    OK(triptych_read_color(device, image, sizeof image));
}

void sampled_check(const struct sampled_coordinates *c)
{
    char what[192];
    describe(what);
    sampled_show(c);
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
        check_pixel(p % SIZE, p / SIZE, c, what);
}

void sampled_define(enum triptych_texture_type type, int width, int height, int depth, int levels)
{
    sampled = (struct sampled){.type = type,
                               .size = {width, height, depth},
                               .levels = levels,
                               .faces = type == TRIPTYCH_TEXTURE_CUBE ? 6 : 1};
    bind_texture();
}

void sampled_expect_few_left_out(double share)
{
    TEST_ASSERT_TRUE_MESSAGE(left_out <= looked_at * share, "too many pixels were left out");
    left_out = looked_at = 0;
}
