#include "draw/derive.h"

#include "base/mxcsr.h"
#include "draw/call.h"

#include <math.h>
#include <string.h>

_Static_assert((int)ATTRIBUTE_FORMAT_COUNT == (int)TRIPTYCH_FORMAT_COUNT,
               "formats agree with the public ones");
_Static_assert((int)ATTRIBUTE_COUNT == (int)TRIPTYCH_ATTRIBUTE_COUNT,
               "attributes agree with the public ones");
_Static_assert((int)LIGHT_COUNT == (int)TRIPTYCH_LIGHTS, "as many lights as the public ones");
_Static_assert((int)LIGHT_POINT == TRIPTYCH_LIGHT_POINT + 1, "light types follow the public ones");
_Static_assert((int)TARGET_SIZE_MAXIMUM == (int)TRIPTYCH_TARGET_MAXIMUM, "one limit of the target");

/* Words of def/value.def that the code names. */
enum {
#define VALUE(kind, word, number) kind##_##word = number,
#include "def/value.def"
#undef VALUE
};

static uint32_t get(const struct state *state, enum triptych_state which)
{
    return state->value[which];
}

#define GET(name) get(state, TRIPTYCH_STATE_##name)

/* --- Keys -------------------------------------------------------------------------------------------------
 */

/* EQUAL never changes the stored depth: both are clamped to 0..1 without denormals or -0, so equal means the
 * same bits. NEVER changes nothing at all. */
static void derive_depth(const struct state *state, struct pixel_key *key)
{
    key->depth_function = COMPARE_ALWAYS;
    if (!GET(zenable))
        return;
    key->depth_function = (uint8_t)(GET(zfunc) - COMPARE_never);
    key->depth_write = GET(zwriteenable) && key->depth_function != COMPARE_EQUAL;
}

/* One channel's blending, as the key has it. */
struct blending {
    uint8_t blend, source, target;
};

/* Direct3D's numbers up to INVDESTCOLOR are ours and 1; the later ones are in another order. */
static uint8_t derive_factor(uint32_t factor)
{
    if (factor <= SRCBLEND_invdestcolor)
        return (uint8_t)(factor - SRCBLEND_zero);
    if (factor == SRCBLEND_srcalphasat)
        return FACTOR_SATURATED_ALPHA;
    return (uint8_t)(factor - SRCBLEND_blendfactor + FACTOR_CONSTANT);
}

/* A difference with a term that is zero is a sum or zero, and a sum of the new colour alone a copy. */
static struct blending reduce_blending(struct blending b)
{
    if (b.blend == BLEND_MINIMUM || b.blend == BLEND_MAXIMUM)
        return (struct blending){.blend = b.blend};
    if (b.blend == BLEND_SUBTRACT && b.source == FACTOR_ZERO)
        b.target = FACTOR_ZERO;
    if (b.blend == BLEND_REVERSE_SUBTRACT && b.target == FACTOR_ZERO)
        b.source = FACTOR_ZERO;
    if ((b.blend == BLEND_SUBTRACT && b.target == FACTOR_ZERO) ||
        (b.blend == BLEND_REVERSE_SUBTRACT && b.source == FACTOR_ZERO))
        b.blend = BLEND_ADD;
    if (b.blend == BLEND_ADD && b.source == FACTOR_ONE && b.target == FACTOR_ZERO)
        return (struct blending){BLEND_COPY, 0, 0};
    return b;
}

/* The BOTH factors override the target's (Direct3D 9, D3DBLEND). */
static struct blending make_blending(uint32_t operation, uint32_t source, uint32_t target)
{
    if (source == SRCBLEND_bothsrcalpha || source == SRCBLEND_bothinvsrcalpha) {
        int inverse = source == SRCBLEND_bothinvsrcalpha;
        source = inverse ? SRCBLEND_invsrcalpha : SRCBLEND_srcalpha;
        target = inverse ? SRCBLEND_srcalpha : SRCBLEND_invsrcalpha;
    }
    return reduce_blending((struct blending){(uint8_t)(operation - BLENDOP_add + BLEND_ADD),
                                             derive_factor(source), derive_factor(target)});
}

/* The factor that is the same for alpha: its colour is itself. */
static uint8_t alpha_factor(uint8_t factor)
{
    if (factor == FACTOR_SOURCE_COLOR || factor == FACTOR_INVERSE_SOURCE_COLOR)
        return factor - FACTOR_SOURCE_COLOR + FACTOR_SOURCE_ALPHA;
    if (factor == FACTOR_TARGET_COLOR || factor == FACTOR_INVERSE_TARGET_COLOR)
        return factor - FACTOR_TARGET_COLOR + FACTOR_TARGET_ALPHA;
    return factor == FACTOR_SATURATED_ALPHA ? FACTOR_ONE : factor;
}

/* The blending that is the same for alpha, unless it would be rounded otherwise. */
static struct blending alpha_blending(struct blending b)
{
    struct blending r = {b.blend, alpha_factor(b.source), alpha_factor(b.target)};
    int same = blend_is_lerp(r.blend, r.source, r.target) == blend_is_lerp(b.blend, b.source, b.target);
    return b.blend == BLEND_COPY || !same ? b : reduce_blending(r);
}

static bool same_blending(struct blending a, struct blending b)
{
    return a.blend == b.blend && a.source == b.source && a.target == b.target;
}

static bool keeps_target(struct blending b)
{
    return b.blend == BLEND_ADD && b.source == FACTOR_ZERO && b.target == FACTOR_ONE;
}

static void store_blending(struct pixel_key *key, int channel, struct blending b)
{
    key->blend[channel] = b.blend;
    key->source_factor[channel] = b.source;
    key->target_factor[channel] = b.target;
}

enum { MASK_COLOR = 7, MASK_ALPHA = 8 };

/* Channels that stay as they are need not be written; those that are not written are blended like the others.
 */
static void derive_blend(const struct state *state, struct pixel_key *key)
{
    struct blending color = {BLEND_COPY, 0, 0}, alpha;
    if (GET(alphablendenable))
        color = make_blending(GET(blendop), GET(srcblend), GET(destblend));
    alpha = color;
    if (GET(alphablendenable) && GET(separatealphablendenable))
        alpha = alpha_blending(make_blending(GET(blendopalpha), GET(srcblendalpha), GET(destblendalpha)));
    if (keeps_target(color))
        key->write_mask &= MASK_ALPHA;
    if (keeps_target(alpha))
        key->write_mask &= MASK_COLOR;
    if (!(key->write_mask & MASK_ALPHA) || same_blending(alpha, alpha_blending(color)))
        alpha = color;
    if (!(key->write_mask & MASK_COLOR))
        color = alpha;
    store_blending(key, BLEND_COLOR, color);
    store_blending(key, BLEND_ALPHA, alpha);
}

/* What the test discards is the opposite of what it keeps. */
static uint8_t derive_alpha_discard(const struct state *state)
{
    return GET(alphatestenable) ? (uint8_t)(COMPARE_always - GET(alphafunc)) : COMPARE_NEVER;
}

static uint8_t derive_address(uint32_t address, uint32_t size)
{
    int power = !(size & (size - 1));
    switch (address) {
    case ADDRESS_mirror: return power ? ADDRESS_MIRROR_POWER : ADDRESS_MIRROR;
    case ADDRESS_clamp: return ADDRESS_CLAMP;
    case ADDRESS_border: return ADDRESS_BORDER;
    case ADDRESS_mirroronce: return ADDRESS_MIRROR_ONCE;
    default: return power ? ADDRESS_WRAP_POWER : ADDRESS_WRAP;
    }
}

static void derive_texture(const struct state *state, struct pixel_key *key)
{
    if (!stage_reads(key, SOURCE_TEXTURE))
        return;
    key->texture = 1;
    key->filter = GET(texturefilter) == FILTER_linear ? FILTER_LINEAR : FILTER_POINT;
    key->address_u = derive_address(GET(addressu), state->texture->width);
    key->address_v = derive_address(GET(addressv), state->texture->height);
}

/* One half of stage 0 as the state has it: an operation of Direct3D 9 and arguments 1, 2 and 0. */
struct half_stage {
    uint32_t operation;
    uint32_t argument[STAGE_ARGUMENTS];
};

enum { COMPLEMENT = ARGUMENT_diffuse_complement, REPLICATE = ARGUMENT_diffuse_alphareplicate };

/* What current is in the first stage: diffuse. */
static uint8_t derive_argument(uint32_t argument)
{
    static const uint8_t source[4] = {[ARGUMENT_diffuse] = SOURCE_DIFFUSE,
                                      [ARGUMENT_current] = SOURCE_DIFFUSE,
                                      [ARGUMENT_texture] = SOURCE_TEXTURE,
                                      [ARGUMENT_tfactor] = SOURCE_FACTOR};
    unsigned flags =
        (argument & COMPLEMENT ? ARGUMENT_COMPLEMENT : 0) + (argument & REPLICATE ? ARGUMENT_REPLICATE : 0);
    return (uint8_t)(source[argument & ARGUMENT_tfactor] + flags);
}

/* Where an argument of a reduced operation comes from: argument 1, 2 or 0 of the state, or a source; with
 * REPLICATE to be set, COMPLEMENT to be turned. */
enum { FIRST, SECOND, THIRD, DIFFUSE, CURRENT, TEXTURE, FACTOR, ORIGIN = 7 };

/* Operations that are others with particular arguments: blends are interpolations by an alpha, and all that
 * end in an addition of a product are one. ADDSMOOTH, a + b - a * b, is a + (1 - a) * b, and rounds alike. */
static const struct reduction {
    uint8_t stage;
    uint8_t argument[STAGE_ARGUMENTS];
} reductions[] = {
    [TEXTUREOP_disable] = {STAGE_SELECT, {CURRENT}},
    [TEXTUREOP_selectarg1] = {STAGE_SELECT, {FIRST}},
    [TEXTUREOP_selectarg2] = {STAGE_SELECT, {SECOND}},
    [TEXTUREOP_modulate] = {STAGE_MODULATE, {FIRST, SECOND}},
    [TEXTUREOP_modulate2x] = {STAGE_MODULATE_2X, {FIRST, SECOND}},
    [TEXTUREOP_modulate4x] = {STAGE_MODULATE_4X, {FIRST, SECOND}},
    [TEXTUREOP_add] = {STAGE_ADD, {FIRST, SECOND}},
    [TEXTUREOP_addsigned] = {STAGE_ADD_SIGNED, {FIRST, SECOND}},
    [TEXTUREOP_addsigned2x] = {STAGE_ADD_SIGNED_2X, {FIRST, SECOND}},
    [TEXTUREOP_subtract] = {STAGE_SUBTRACT, {FIRST, SECOND}},
    [TEXTUREOP_addsmooth] = {STAGE_MULTIPLY_ADD, {FIRST | COMPLEMENT, SECOND, FIRST}},
    [TEXTUREOP_blenddiffusealpha] = {STAGE_LERP, {FIRST, SECOND, DIFFUSE | REPLICATE}},
    [TEXTUREOP_blendtexturealpha] = {STAGE_LERP, {FIRST, SECOND, TEXTURE | REPLICATE}},
    [TEXTUREOP_blendfactoralpha] = {STAGE_LERP, {FIRST, SECOND, FACTOR | REPLICATE}},
    [TEXTUREOP_blendcurrentalpha] = {STAGE_LERP, {FIRST, SECOND, CURRENT | REPLICATE}},
    [TEXTUREOP_blendtexturealphapm] = {STAGE_MULTIPLY_ADD, {TEXTURE | COMPLEMENT | REPLICATE, SECOND, FIRST}},
    [TEXTUREOP_modulatealpha_addcolor] = {STAGE_MULTIPLY_ADD, {FIRST | REPLICATE, SECOND, FIRST}},
    [TEXTUREOP_modulatecolor_addalpha] = {STAGE_MULTIPLY_ADD, {FIRST, SECOND, FIRST | REPLICATE}},
    [TEXTUREOP_modulateinvalpha_addcolor] = {STAGE_MULTIPLY_ADD,
                                             {FIRST | COMPLEMENT | REPLICATE, SECOND, FIRST}},
    [TEXTUREOP_modulateinvcolor_addalpha] = {STAGE_MULTIPLY_ADD,
                                             {FIRST | COMPLEMENT, SECOND, FIRST | REPLICATE}},
    [TEXTUREOP_dotproduct3] = {STAGE_DOT, {FIRST, SECOND}},
    [TEXTUREOP_multiplyadd] = {STAGE_MULTIPLY_ADD, {FIRST, SECOND, THIRD}},
    [TEXTUREOP_lerp] = {STAGE_LERP, {FIRST, SECOND, THIRD}},
};

static uint32_t reduced_argument(const struct half_stage *half, unsigned which)
{
    unsigned origin = which & ORIGIN;
    uint32_t argument = origin < DIFFUSE ? half->argument[origin] : ARGUMENT_diffuse + origin - DIFFUSE;
    return (argument | (which & REPLICATE)) ^ (which & COMPLEMENT);
}

/* `flags` are those that mean something: alpha replicated is alpha. */
static uint8_t derive_half(const struct half_stage *half, uint32_t flags, uint8_t argument[STAGE_ARGUMENTS])
{
    const struct reduction *reduction = &reductions[half->operation];
    for (int i = 0; i < stage_arguments[reduction->stage]; i++) {
        uint32_t reduced = reduced_argument(half, reduction->argument[i]);
        argument[i] = derive_argument(reduced & (ARGUMENT_tfactor | flags));
    }
    return reduction->stage;
}

static void derive_stage(const struct state *state, struct pixel_key *key)
{
    struct half_stage color = {GET(colorop), {GET(colorarg1), GET(colorarg2), GET(colorarg0)}};
    struct half_stage alpha = {GET(alphaop), {GET(alphaarg1), GET(alphaarg2), GET(alphaarg0)}};
    if (color.operation == TEXTUREOP_disable)
        return;
    key->color_stage = derive_half(&color, COMPLEMENT | REPLICATE, key->color_argument);
    if (key->color_stage != STAGE_DOT)
        key->alpha_stage = derive_half(&alpha, COMPLEMENT, key->alpha_argument);
    if (state->texture || !stage_reads(key, SOURCE_TEXTURE))
        return;
    key->color_stage = key->alpha_stage = STAGE_SELECT; /* without its texture the stage is off */
    memset(key->color_argument, 0, sizeof key->color_argument);
    memset(key->alpha_argument, 0, sizeof key->alpha_argument);
}

static void derive_pixel(const struct state *state, struct pixel_key *key)
{
    derive_depth(state, key);
    key->write_mask = (uint8_t)GET(colorwriteenable);
    key->alpha_discard = derive_alpha_discard(state);
    derive_blend(state, key);
    if (key->depth_function == COMPARE_NEVER || key->alpha_discard == COMPARE_ALWAYS)
        key->depth_write = key->write_mask = 0;
    if (!derive_effective(key)) { /* one key for all that draw nothing */
        key->depth_function = COMPARE_ALWAYS;
        key->alpha_discard = COMPARE_NEVER;
    }
    if (!key->write_mask) {
        store_blending(key, BLEND_COLOR, (struct blending){BLEND_COPY, 0, 0});
        store_blending(key, BLEND_ALPHA, (struct blending){BLEND_COPY, 0, 0});
    }
    if (!pixel_shades(key))
        return;
    derive_stage(state, key);
    if (!key->write_mask && key->color_stage != STAGE_DOT) { /* alpha alone is looked at */
        key->color_stage = key->alpha_stage;
        memcpy(key->color_argument, key->alpha_argument, sizeof key->color_argument);
    }
    derive_texture(state, key);
    if (key->texture)
        key->varying[VARYING_texcoord] = INTERPOLATION_SMOOTH;
    if (stage_reads(key, SOURCE_DIFFUSE))
        key->varying[VARYING_diffuse] =
            GET(shademode) == SHADEMODE_flat ? INTERPOLATION_FLAT : INTERPOLATION_SMOOTH;
}

static void derive_setup(const struct state *state, const struct pixel_key *pixel, struct setup_key *key)
{
    key->cull = (uint8_t)(GET(cullmode) - CULLMODE_none);
    key->depth = pixel->depth_function != COMPARE_ALWAYS || pixel->depth_write;
    memcpy(key->varying, pixel->varying, sizeof key->varying);
}

/* The bound format, cut to the components that the vertex routine can read. */
static uint8_t derive_format(const struct state *state, enum attribute attribute, int components)
{
    int format = (int)state->element[attribute].format;
    int last = ATTRIBUTE_FORMAT_FLOAT1 + components - 1;
    return (uint8_t)(format != ATTRIBUTE_FORMAT_COLOR && format > last ? last : format);
}

/* Without lights nobody reads the normal. Without a normal it is zero, of length one or not: a cosine of a
 * zero vector is a zero or a NaN, and either gives no light. */
static void derive_lighting(const struct state *state, struct vertex_key *key)
{
    int count = 0;
    key->lighting = 1;
    for (int i = 0; i < LIGHT_COUNT; i++)
        if (state->light_enabled[i])
            key->light[count++] = (uint8_t)(state->light[i].type + LIGHT_DIRECTIONAL);
    if (!count)
        return;
    key->attribute[ATTRIBUTE_NORMAL] = derive_format(state, ATTRIBUTE_NORMAL, 3);
    key->normalize = key->attribute[ATTRIBUTE_NORMAL] && GET(normalizenormals);
}

static void derive_vertex(const struct state *state, const struct pixel_key *pixel, struct vertex_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++)
        key->varying[v] = pixel->varying[v] != INTERPOLATION_NONE;
    key->attribute[ATTRIBUTE_POSITION] = derive_format(state, ATTRIBUTE_POSITION, 4);
    if (key->varying[VARYING_texcoord])
        key->attribute[ATTRIBUTE_TEXCOORD] = derive_format(state, ATTRIBUTE_TEXCOORD, 2);
    if (key->varying[VARYING_diffuse] && GET(lighting))
        derive_lighting(state, key);
    else if (key->varying[VARYING_diffuse])
        key->attribute[ATTRIBUTE_DIFFUSE] = derive_format(state, ATTRIBUTE_DIFFUSE, 4);
}

bool derive_effective(const struct pixel_key *key)
{
    return key->write_mask || key->depth_write;
}

void derive_keys(const struct state *state, union key key[UNIT_COUNT])
{
    memset(key, 0, UNIT_COUNT * sizeof *key);
    derive_pixel(state, &key[UNIT_PIXEL].pixel);
    derive_setup(state, &key[UNIT_PIXEL].pixel, &key[UNIT_SETUP].setup);
    derive_vertex(state, &key[UNIT_PIXEL].pixel, &key[UNIT_VERTEX].vertex);
}

/* --- Job --------------------------------------------------------------------------------------------------
 */

/* Products are summed in double precision, first row first, and rounded once when stored in the job. */
struct matrix {
    double m[4][4];
};

static struct matrix matrix_of(const float source[4][4])
{
    struct matrix r;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = (double)source[i][j];
    return r;
}

static struct matrix multiply(const struct matrix *a, const struct matrix *b)
{
    struct matrix r;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j] +
                        a->m[i][3] * b->m[3][j];
    return r;
}

/* The nearest finite float: a matrix element that overflowed must not turn zeros into NaNs. */
static float narrow(double value)
{
    return (float)fmax(-(double)__FLT_MAX__, fmin(value, (double)__FLT_MAX__));
}

static void store_matrix(const struct matrix *source, float target[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            target[i][j] = narrow(source->m[i][j]);
}

static double cofactor(const struct matrix *m, int row, int column)
{
    int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
    return m->m[r1][c1] * m->m[r2][c2] - m->m[r1][c2] * m->m[r2][c1];
}

/* Inverse transpose of the upper left 3x3: cofactors over the determinant; the cofactors alone, which have
 * the right directions as far as there are any, when there is no inverse. */
static void store_normal_matrix(const struct matrix *world_view, float target[3][4])
{
    double determinant = 0;
    for (int c = 0; c < 3; c++)
        determinant += world_view->m[0][c] * cofactor(world_view, 0, c);
    double scale = determinant != 0 ? 1 / determinant : 1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            target[i][j] = narrow(cofactor(world_view, i, j) * scale);
}

/* A point (w = 1) or a direction (w = 0) times the matrix. */
static void transform(const float source[3], double w, const struct matrix *matrix, double target[3])
{
    for (int c = 0; c < 3; c++)
        target[c] = (double)source[0] * matrix->m[0][c] + (double)source[1] * matrix->m[1][c] +
                    (double)source[2] * matrix->m[2][c] + w * matrix->m[3][c];
}

static void fill_direction(const struct triptych_light *light, const struct matrix *view,
                           struct light_job *job)
{
    double d[3];
    transform(light->direction, 0, view, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int c = 0; c < 3; c++)
        job->position[c] = length > 0 ? (float)(-d[c] / length) : 0;
}

static void fill_point(const struct triptych_light *light, const struct triptych_material *material,
                       const struct matrix *view, struct light_job *job)
{
    double p[3];
    transform(light->position, 1, view, p);
    for (int c = 0; c < 3; c++) {
        job->position[c] = narrow(p[c]);
        job->ambient[c] = narrow((double)light->ambient[c] * (double)material->ambient[c]);
    }
    job->range = light->range;
    job->attenuation0 = light->attenuation[0];
    job->attenuation1 = light->attenuation[1];
    job->attenuation2 = light->attenuation[2];
}

/* The lights, packed to the front like the key's, and the base colour with the directional ones' ambient
 * part. */
static void fill_lighting(const struct state *state, const struct matrix *view, struct job *job)
{
    const struct triptych_material *material = &state->material;
    double ambient[3];
    for (int c = 0; c < 3; c++)
        ambient[c] = (GET(ambient) >> (16 - 8 * c) & 255) / 255.0;
    struct light_job *to = job->light;
    for (int i = 0; i < LIGHT_COUNT; i++) {
        const struct triptych_light *light = state->light + i;
        if (!state->light_enabled[i])
            continue;
        for (int c = 0; c < 3; c++)
            to->diffuse[c] = narrow((double)light->diffuse[c] * (double)material->diffuse[c]);
        if (light->type == TRIPTYCH_LIGHT_POINT)
            fill_point(light, material, view, to);
        else
            fill_direction(light, view, to);
        for (int c = 0; c < 3 && light->type == TRIPTYCH_LIGHT_DIRECTIONAL; c++)
            ambient[c] += (double)light->ambient[c];
        to++;
    }
    for (int c = 0; c < 3; c++)
        job->base_color[c] =
            narrow((double)material->emissive[c] + (double)material->ambient[c] * ambient[c]);
    job->base_color[3] = material->diffuse[3];
}

/* |x| <= guard * w keeps |x / w * half + centre| <= GUARD_BAND_PIXELS. The bound on guard only matters for
 * viewports of a fraction of a pixel; it keeps guard * w from overflowing where w does not. */
static float guard_band(double half, double centre)
{
    return (float)fmin((GUARD_BAND_PIXELS - centre) / half, 0x1p20);
}

static void fill_viewport(const struct triptych_viewport *viewport, struct job *job)
{
    double half_width = (double)viewport->width / 2, half_height = (double)viewport->height / 2;
    double centre_x = (double)viewport->x + half_width, centre_y = (double)viewport->y + half_height;
    double subpixels = 1 << SUBPIXEL_BITS;
    job->guard_x = guard_band(half_width, centre_x);
    job->guard_y = guard_band(half_height, centre_y);
    job->scale_x = (float)(half_width * subpixels);
    job->offset_x = (float)(centre_x * subpixels);
    job->scale_y = (float)(-half_height * subpixels);
    job->offset_y = (float)(centre_y * subpixels);
    job->depth_scale = viewport->depth_far - viewport->depth_near;
    job->depth_offset = viewport->depth_near;
}

/* 0xAARRGGBB with red and blue exchanged. */
static uint32_t rgba_word(uint32_t color)
{
    return (color & 0xff00ff00) | (color >> 16 & 255) | (color & 255) << 16;
}

static void fill_texture(const struct state *state, const struct pixel_key *key, struct texture_job *job)
{
    const struct triptych_texture *texture = state->texture;
    job->texels = texture->texels;
    job->width = (int32_t)texture->width;
    job->height = (int32_t)texture->height;
    job->width_256 = (float)texture->width * 256;
    job->height_256 = (float)texture->height * 256;
    job->last_u = job->width - 1;
    job->last_v = job->height - 1;
    if (key->address_u == ADDRESS_BORDER || key->address_v == ADDRESS_BORDER)
        job->border = rgba_word(GET(bordercolor));
}

static void fill_attributes(const struct state *state, const struct vertex_key *key, struct job *job)
{
    for (int i = 0; i < ATTRIBUTE_COUNT; i++)
        if (key->attribute[i] != ATTRIBUTE_FORMAT_NONE) {
            const struct triptych_element *element = state->element + i;
            job->attribute[i].data = element->buffer->data + element->offset;
            job->attribute[i].stride = (int32_t)element->stride;
        }
}

/* Not inlined: the compiler may move arithmetic over a change of MXCSR, but not a call. */
__attribute__((noinline)) static void fill_job(const struct state *state, const struct vertex_key *vertex,
                                               const struct pixel_key *pixel, struct job *job)
{
    struct matrix world = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_WORLD]);
    struct matrix view = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_VIEW]);
    struct matrix projection = matrix_of((const float(*)[4])state->transform[TRIPTYCH_TRANSFORM_PROJECTION]);
    struct matrix world_view = multiply(&world, &view);
    struct matrix world_view_projection = multiply(&world_view, &projection);
    fill_attributes(state, vertex, job);
    store_matrix(&world_view_projection, job->world_view_projection);
    if (vertex->lighting) {
        store_matrix(&world_view, job->world_view);
        store_normal_matrix(&world_view, job->normal);
        fill_lighting(state, &view, job);
    }
    fill_viewport(&state->viewport, job);
    if (pixel->texture)
        fill_texture(state, pixel, &job->texture);
    if (stage_reads(pixel, SOURCE_FACTOR))
        job->texture_factor = rgba_word(GET(texturefactor));
    if (pixel->alpha_discard)
        job->alpha_reference = (int32_t)GET(alpharef);
    job->blend_constant = rgba_word(GET(blendfactor));
}

void derive_job(const struct state *state, const struct vertex_key *vertex, const struct pixel_key *pixel,
                struct job *job)
{
    unsigned saved = mxcsr_enter();
    memset(job, 0, sizeof *job);
    fill_job(state, vertex, pixel, job);
    mxcsr_leave(saved);
}

/* Column i's centre is at i + 1/2. */
static int32_t first_centre(double edge)
{
    return (int32_t)ceil(edge - 0.5);
}

static int32_t at_least(int32_t low, int32_t value)
{
    return value < low ? low : value;
}

static int32_t at_most(int32_t high, int32_t value)
{
    return value > high ? high : value;
}

struct rectangle derive_scissor(const struct state *state)
{
    double x = (double)state->viewport.x, y = (double)state->viewport.y;
    struct rectangle r = {first_centre(x), first_centre(y), first_centre(x + (double)state->viewport.width),
                          first_centre(y + (double)state->viewport.height)};
    if (!GET(scissortestenable))
        return r;
    const struct scissor *s = &state->scissor;
    r.x0 = at_least((int32_t)s->x, r.x0);
    r.y0 = at_least((int32_t)s->y, r.y0);
    r.x1 = at_least(r.x0, at_most((int32_t)(s->x + s->width), r.x1));
    r.y1 = at_least(r.y0, at_most((int32_t)(s->y + s->height), r.y1));
    return r;
}
