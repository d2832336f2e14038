#include "tests/support/picture/texture_model.h"

#include "base/bits.h"
#include "tests/support/picture/canvas.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static int side_of(int level)
{
    return MODEL_SIDE >> level;
}

static int slices_of(const struct model_texture *t, int level)
{
    if (t->type == TRIPTYCH_TEXTURE_CUBE)
        return 6;
    return t->type == TRIPTYCH_TEXTURE_VOLUME ? side_of(level) : 1;
}

/* --- Making -------------------------------------------------------------------------------------------- */

/* Writes one image of a face or a slice to the device's texture. */
static void update(struct model_texture *t, triptych_device *to, int level, int slice)
{
    static uint8_t bytes[MODEL_SIDE * MODEL_SIDE * 4];
    static float floats[MODEL_SIDE * MODEL_SIDE * 4];
    int side = side_of(level), volume = t->type == TRIPTYCH_TEXTURE_VOLUME;
    for (int i = 0; i < 4 * side * side; i++) {
        float value = t->texel[level][slice][i / 4 / side][i / 4 % side][i % 4];
        floats[i] = value;
        bytes[i] = (uint8_t)value;
    }
    size_t pixel = t->floats ? 16 : 4;
    const struct triptych_box box = {
        .z = (unsigned)slice, .width = (unsigned)side, .height = (unsigned)side, .depth = 1};
    OK(triptych_texture_update(to, t->texture, volume ? 0 : (unsigned)slice, (unsigned)level,
                               volume ? &box : NULL, t->floats ? (const void *)floats : bytes,
                               pixel * (size_t)side, pixel * (size_t)(side * side)));
}

void model_make(struct model_texture *t, triptych_device *to, unsigned sampler,
                enum triptych_texture_type type, int floats)
{
    unsigned format = floats ? TRIPTYCH_SURFACE_A32B32G32R32F : TRIPTYCH_SURFACE_A8B8G8R8;
    unsigned depth = type == TRIPTYCH_TEXTURE_VOLUME ? MODEL_SIDE : 1;
    const struct triptych_texture_description description = {
        type, (enum triptych_surface_format)format, MODEL_SIDE, MODEL_SIDE, depth, MODEL_LEVELS};
    memset(t, 0, sizeof *t);
    t->type = type;
    t->floats = floats;
    OK(triptych_texture_define(to, &description, &t->texture));
    for (int level = 0; level < MODEL_LEVELS; level++)
        for (int slice = 0; slice < slices_of(t, level); slice++) {
            for (int i = 0; i < 4 * side_of(level) * side_of(level); i++) {
                float *texel = t->texel[level][slice][i / 4 / side_of(level)][i / 4 % side_of(level)];
                texel[i % 4] =
                    floats ? (float)(int)(random_word() % 1024) / 64 - 8 : (float)(random_word() % 256);
            }
            update(t, to, level, slice);
        }
    OK(triptych_set_texture(to, sampler, t->texture));
}

static void set_word(triptych_device *to, unsigned number, enum triptych_sampler_state state,
                     const char *word)
{
    const struct triptych_state_row *row = triptych_state_at(TRIPTYCH_SAMPLER_STATES, state);
    uint32_t value = 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, triptych_value_number(row->kind, word, &value), word);
    OK(triptych_set_sampler_state(to, number, state, value));
}

void model_set(triptych_device *to, unsigned number, const struct model_sampler *s)
{
    static const char *const filter[] = {"point", "linear"}, *const mip[] = {"none", "point", "linear"};
    float bias = (float)s->bias;
    uint32_t bits = bits_of_float(bias);
    set_word(to, number, TRIPTYCH_SAMPLER_MAGFILTER, filter[s->mag]);
    set_word(to, number, TRIPTYCH_SAMPLER_MINFILTER, filter[s->min]);
    set_word(to, number, TRIPTYCH_SAMPLER_MIPFILTER, mip[s->mip]);
    OK(triptych_set_sampler_state(to, number, TRIPTYCH_SAMPLER_MAXMIPLEVEL, (uint32_t)s->first));
    OK(triptych_set_sampler_state(to, number, TRIPTYCH_SAMPLER_MIPMAPLODBIAS, bits));
}

/* --- Levels -------------------------------------------------------------------------------------------- */

static double length_in_texels(const double change[3], int axes)
{
    double sum = 0;
    for (int a = 0; a < axes; a++)
        sum += change[a] * MODEL_SIDE * change[a] * MODEL_SIDE;
    return sqrt(sum);
}

int model_lambda(const struct model_texture *t, const struct model_sampler *s, const double across[3],
                 const double down[3], double more)
{
    int axes = t->type == TRIPTYCH_TEXTURE_VOLUME ? 3 : 2;
    double rho = fmax(length_in_texels(across, axes), length_in_texels(down, axes));
    double lambda = 256 * (log2(rho) + s->bias + more);
    if (rho == 0)
        return -100000;
    return fabs(fabs(lambda - floor(lambda)) - 0.5) < 1e-3 ? INT_MIN : (int)rint(lambda);
}

int model_face(const double v[3], double place[2])
{
    int axis = fabs(v[0]) >= fabs(v[1]) && fabs(v[0]) >= fabs(v[2]) ? 0 : fabs(v[1]) >= fabs(v[2]) ? 1 : 2;
    double m = fabs(v[axis]), sign = v[axis] < 0 ? -1 : 1;
    const double s[3] = {-sign * v[2], v[0], sign * v[0]}, t[3] = {-v[1], sign * v[2], -v[1]};
    place[0] = (s[axis] / m + 1) / 2;
    place[1] = (t[axis] / m + 1) / 2;
    return 2 * axis + (sign < 0);
}

/* --- Filters ------------------------------------------------------------------------------------------- */

/* Returns a + (b - a) * fraction / 256, rounded as the specification rounds bytes or binary32 texels. */
static float blend(const struct model_texture *t, float a, float b, int fraction)
{
    if (!t->floats)
        return (float)(((int)a * (256 - fraction) + (int)b * fraction + 128) >> 8);
    double weight = fraction / 256.0;
    float first = (float)((double)a * (1 - weight));
    return fraction ? (float)((double)b * weight + (double)first) : a;
}

struct place {
    int index[2], fraction;
};

static int address(const struct model_texture *t, int index, int size)
{
    if (t->type == TRIPTYCH_TEXTURE_CUBE)
        return index < 0 ? 0 : index >= size ? size - 1 : index;
    return (index % size + size) % size;
}

static struct place place_of(const struct model_texture *t, double coordinate, int size, int linear)
{
    int position = (int)rint(coordinate * size * 256) - (linear ? 128 : 0);
    int index = (int)floor(position / 256.0);
    return (struct place){{address(t, index, size), address(t, index + 1, size)},
                          linear ? position - 256 * index : 0};
}

static float image_channel(const struct model_texture *t, int level, int face, const double at[3], int linear,
                           int c)
{
    struct place p[3];
    int volume = t->type == TRIPTYCH_TEXTURE_VOLUME;
    float slice[2];
    for (int a = 0; a < (volume ? 3 : 2); a++)
        p[a] = place_of(t, at[a], side_of(level), linear);
    for (int k = 0; k < (volume ? 2 : 1); k++) {
        int z = volume ? p[2].index[k] : face;
        float row[2];
        for (int j = 0; j < 2; j++) {
            const float(*texel)[4] = t->texel[level][z][p[1].index[j]];
            row[j] = blend(t, texel[p[0].index[0]][c], texel[p[0].index[1]][c], p[0].fraction);
        }
        slice[k] = blend(t, row[0], row[1], p[1].fraction);
    }
    return volume ? blend(t, slice[0], slice[1], p[2].fraction) : slice[0];
}

void model_sample(const struct model_texture *t, const struct model_sampler *s, const double v[3], int lambda,
                  float result[4])
{
    int first = 256 * s->first, last = 256 * (MODEL_LEVELS - 1), face = 0;
    int linear = lambda > 0 ? s->min : s->mag;
    int clamped = lambda < first ? first : lambda > last ? last : lambda;
    int near = clamped >> 8, fraction = clamped & 255;
    double at[3] = {v[0], v[1], v[2]};
    if (t->type == TRIPTYCH_TEXTURE_CUBE)
        face = model_face(v, at);
    if (s->mip == MODEL_MIP_NONE)
        near = fraction = 0;
    if (s->mip == MODEL_MIP_POINT)
        near = (clamped + 128) >> 8, fraction = 0;
    int next = near + 1 < MODEL_LEVELS ? near + 1 : MODEL_LEVELS - 1;
    for (int c = 0; c < 4; c++) {
        float a = image_channel(t, near, face, at, linear, c),
              b = image_channel(t, next, face, at, linear, c);
        float value = s->mip == MODEL_MIP_LINEAR ? blend(t, a, b, fraction) : a;
        result[c] = t->floats ? value : (float)((double)value / 255);
    }
}
