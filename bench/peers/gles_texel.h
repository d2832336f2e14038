/* The texels of the streams' textures, computed again for GLES2. */
#ifndef BENCH_PEERS_GLES_TEXEL_H
#define BENCH_PEERS_GLES_TEXEL_H

#include <stdint.h>

uint32_t gles_rgba(uint32_t argb);
/* Of a texture of side x side texels. */
uint32_t gles_checker(unsigned x, unsigned y, unsigned side);
uint32_t gles_gradient(unsigned x, unsigned y, unsigned side);
/* A byte of a mask. */
uint8_t gles_mask(unsigned x, unsigned y);
void gles_halve(const uint32_t *from, uint32_t *to, unsigned side);

#endif
