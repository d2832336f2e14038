#include "render/device/key_source.h"

#include "render/derive/change.h"
#include "render/derive/derive_part.h"
#include "shader/program/program.h"

#include <emmintrin.h>
#include <string.h>

/* --- The rest --- */

static uint8_t light_class(const struct state *state, unsigned i)
{
    const struct triptych_light *light = &state->light[i];
    return state->light_enabled[i] ? (uint8_t)(1 + 2 * (int)light->type + (light->falloff == 1)) : 0;
}

static uint8_t power_class(float power)
{
    return power == 0 ? 0 : power == 1 ? 1 : 2;
}

static uint8_t clip_mask_class(const struct state *state)
{
    return derive_has_clip_mask(state) ? (uint8_t)(1 + state->clip_mask.texture->tiled) : 0;
}

static uint32_t side_class(uint32_t size)
{
    return size & (size - 1) ? size : 0;
}

static struct key_source_texture texture_class(const struct triptych_texture *texture, unsigned sampler)
{
    return (struct key_source_texture){
        .format = texture->format,
        .side = {side_class(texture->width), side_class(texture->height), side_class(texture->depth)},
        .type = (uint8_t)texture->type,
        .tiled = texture->tiled,
        .levels = (uint8_t)texture->levels,
        .sampler = (uint8_t)sampler};
}

static void take_programs(const struct state *state, struct key_source_rest *rest)
{
    for (int i = 0; i < SHADER_STAGES; i++) {
        const struct program *program = state->program[i];
        rest->program[i] = program ? program->number : 0;
        rest->booleans[i] = program ? state->booleans[i] & program->booleans : 0;
    }
}

static void take_textures(const struct state *state, struct key_source_rest *rest)
{
    struct key_source_texture *texture = rest->texture;
    rest->bound = 0;
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (state->texture[i]) {
            rest->bound |= 1u << i;
            *texture++ = texture_class(state->texture[i], i);
        }
}

static void take_elements(const struct state *state, struct key_source_rest *rest)
{
    for (int i = 0; i < TRIPTYCH_ATTRIBUTE_COUNT; i++)
        rest->format[i] = (uint8_t)state->element[i].format;
    rest->others = (uint8_t)state->others;
    for (unsigned i = 0; i < state->others; i++)
        rest->other[i] = (struct key_source_other){state->other[i].usage, state->other[i].usage_index,
                                                   (uint8_t)state->other[i].element.format};
}

void device_source_take_rest(const struct state *state, enum primitive primitive,
                             struct key_source_rest *rest)
{
    memset(rest, 0, offsetof(struct key_source_rest, texture));
    rest->primitive = (uint8_t)primitive;
    rest->power = power_class(state->material.power);
    rest->fog_by_w = derive_fog_by_w(state);
    rest->samples = state->samples;
    rest->counting = state->counting;
    rest->late_tests = state->late_tests;
    rest->depth_format = (uint8_t)state->depth_format;
    rest->clip_mask = clip_mask_class(state);
    memcpy(rest->convention, state->convention, sizeof rest->convention);
    memcpy(rest->target, state->target, sizeof rest->target);
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS; i++)
        rest->light[i] = light_class(state, i);
    take_programs(state, rest);
    take_textures(state, rest);
    take_elements(state, rest);
}

static bool same_rest(const struct key_source_rest *a, const struct key_source_rest *b)
{
    size_t textures = (size_t)__builtin_popcount(b->bound) * sizeof *b->texture;
    return !memcmp(a, b, offsetof(struct key_source_rest, texture)) &&
           !memcmp(a->texture, b->texture, textures) &&
           !memcmp(a->other, b->other, b->others * sizeof *b->other);
}

/* --- The tables --- */

/* Returns the bits of words that count and differ, as four words. */
static inline __m128i difference_at(const uint32_t *a, const uint32_t *b, const uint32_t *mask, unsigned i)
{
    __m128i x = _mm_loadu_si128((const __m128i *)(a + i)), y = _mm_loadu_si128((const __m128i *)(b + i));
    return _mm_and_si128(_mm_xor_si128(x, y), _mm_loadu_si128((const __m128i *)(mask + i)));
}

/* The same of a row of at least four words. The last four overlap those before. */
static inline __m128i difference(const uint32_t *a, const uint32_t *b, const uint32_t *mask, unsigned words)
{
    __m128i bits = difference_at(a, b, mask, words - 4);
    for (unsigned i = 0; i + 4 < words; i += 4)
        bits = _mm_or_si128(bits, difference_at(a, b, mask, i));
    return bits;
}

static inline bool is_zero(__m128i bits)
{
    return _mm_movemask_epi8(_mm_cmpeq_epi8(bits, _mm_setzero_si128())) == 0xffff;
}

static bool same_values(const struct key_source *source, const struct state *state)
{
    return is_zero(difference(source->value, state->value, change_value_mask, TRIPTYCH_STATE_COUNT));
}

static bool same_stages(const struct key_source *source, const struct state *state)
{
    __m128i bits = _mm_setzero_si128();
    for (unsigned i = 0; i < TRIPTYCH_STAGES; i++)
        bits = _mm_or_si128(bits, difference(source->stage[i], state->stage[i], change_stage_mask,
                                             TRIPTYCH_STAGE_STATE_COUNT));
    return is_zero(bits);
}

/* Of samplers with a texture. Others are not read. */
static bool same_samplers(const struct key_source *source, const struct state *state)
{
    __m128i bits = _mm_setzero_si128();
    for (uint32_t left = source->rest.bound; left; left &= left - 1) {
        int i = __builtin_ctz(left);
        bits = _mm_or_si128(bits, difference(source->sampler[i], state->sampler[i], change_sampler_mask,
                                             TRIPTYCH_SAMPLER_STATE_COUNT));
    }
    return is_zero(bits);
}

/* --- Sources --- */

static uint32_t mix(uint32_t hash, uint32_t word)
{
    return (hash ^ word) * 0x9e3779b1u;
}

/* The states that programs change most often, and what is bound. */
uint32_t device_source_hash(const struct state *state, const struct key_source_rest *rest)
{
    static const uint8_t rows[] = {STATE_zenable,          STATE_zwriteenable, STATE_alphatestenable,
                                   STATE_srcblend,         STATE_destblend,    STATE_cullmode,
                                   STATE_alphablendenable, STATE_lighting,     STATE_colorwriteenable,
                                   STATE_stencilenable};
    uint32_t hash = rest->primitive;
    for (unsigned i = 0; i < sizeof rows; i++)
        hash = mix(hash, state->value[rows[i]]);
    for (int i = 0; i < SHADER_STAGES; i++)
        hash = mix(hash, rest->program[i]);
    for (int i = 0; i < 2; i++)
        hash = mix(mix(hash, STAGE(state, i, colorop)), STAGE(state, i, alphaop));
    hash = mix(hash, rest->bound);
    for (int i = 0; i < __builtin_popcount(rest->bound); i++)
        hash = mix(hash, rest->texture[i].format->number);
    return hash;
}

void device_source_take(const struct state *state, const struct key_source_rest *rest,
                        struct key_source *source)
{
    memcpy(&source->rest, rest, sizeof *rest);
    memcpy(source->value, state->value, sizeof source->value);
    memcpy(source->stage, state->stage, sizeof source->stage);
    memcpy(source->sampler, state->sampler, sizeof source->sampler);
}

bool device_source_is(const struct key_source *source, const struct state *state,
                      const struct key_source_rest *rest)
{
    return same_rest(&source->rest, rest) && same_values(source, state) && same_stages(source, state) &&
           same_samplers(source, state);
}
