/* Samplers: addressing and filters as the textures bound need them, and the channels that coordinates come
 * in. */
#include "draw/derive_part.h"

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

static void derive_sampler(const struct state *state, int stage, struct pixel_key *key)
{
    const struct triptych_texture *texture = state->texture[stage];
    key->filter[stage] = SAMPLER(stage, magfilter) == FILTER_linear ? FILTER_LINEAR : FILTER_POINT;
    key->address_u[stage] = derive_address(SAMPLER(stage, addressu), texture->width);
    key->address_v[stage] = derive_address(SAMPLER(stage, addressv), texture->height);
}

static bool same_coordinates(const struct state *state, int a, int b)
{
    return STAGE(a, texcoordindex) == STAGE(b, texcoordindex);
}

/* Stages with the same coordinates share a channel; channels are numbered in the order of their first stages.
 */
static void derive_channel(const struct state *state, int stage, struct pixel_key *key)
{
    uint8_t next = 0;
    for (int i = 0; i < stage; i++) {
        if (!key->texture[i])
            continue;
        if (same_coordinates(state, i, stage)) {
            key->coordinates[stage] = key->coordinates[i];
            return;
        }
        if (key->coordinates[i] >= next)
            next = key->coordinates[i] + 1;
    }
    key->coordinates[stage] = next;
    key->varying[varying_texcoord(next)] = INTERPOLATION_SMOOTH;
}

void derive_texture(const struct state *state, struct pixel_key *key)
{
    for (int i = 0; i < key->stages; i++) {
        if (!stage_reads(key, i, SOURCE_TEXTURE) && !key->premodulate[i])
            continue;
        key->texture[i] = 1;
        derive_sampler(state, i, key);
        derive_channel(state, i, key);
    }
}

int derive_channel_stage(const struct pixel_key *key, int channel)
{
    for (int i = 0; i < key->stages; i++)
        if (key->texture[i] && key->coordinates[i] == channel)
            return i;
    return -1;
}
