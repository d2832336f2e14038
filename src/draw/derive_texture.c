/* Samplers: addressing and filters as the texture bound needs them. */
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

void derive_texture(const struct state *state, struct pixel_key *key)
{
    if (!stage_reads(key, SOURCE_TEXTURE))
        return;
    key->texture = 1;
    key->filter = SAMPLER(0, magfilter) == FILTER_linear ? FILTER_LINEAR : FILTER_POINT;
    key->address_u = derive_address(SAMPLER(0, addressu), state->texture->width);
    key->address_v = derive_address(SAMPLER(0, addressv), state->texture->height);
}
