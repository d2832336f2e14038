/* Mip levels of a texture without a device. */
#ifndef TESTS_SUPPORT_BLIT_MIPS_H
#define TESTS_SUPPORT_BLIT_MIPS_H

#include "render/texture/texture.h"
#include "tests/support/blit/blits.h"
#include <unity.h>

static inline void make_mips(struct triptych_texture *texture)
{
    struct texture_mips mips;
    struct error reason = {{0}};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, texture_prepare_mips(texture, &emulated_blits, &mips, &reason),
                                  reason.text);
    texture_generate_mips(texture, &mips);
    texture_drop_mips(&emulated_blits, &mips);
}

#endif
