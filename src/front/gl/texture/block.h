/* Compressed blocks of 4x4 texels: bytes to RGBA8 texels, block[y][x]. */
#ifndef FRONT_GL_TEXTURE_BLOCK_H
#define FRONT_GL_TEXTURE_BLOCK_H

#include <stdbool.h>
#include <stdint.h>

/* ETC1: OES_compressed_ETC1_RGB8_texture. */
void gl_block_etc1(const uint8_t data[8], uint8_t block[4][4][4]);
/* DXT1: EXT_texture_compression_dxt1. Without alpha, the texels that are transparent otherwise are black. */
void gl_block_dxt1(const uint8_t data[8], bool alpha, uint8_t block[4][4][4]);

#endif
