#include "front/gl/texture/depth.h"

#include <stdlib.h>

enum { STENCIL = 0xff, ROWS = 64 }; /* of a strip */

/* --- Words --- */

/* Rows of two surfaces. */
struct strips {
    triptych_device *renderer;
    const struct gl_depth *image[2];
    uint32_t *words[2];
    struct triptych_rectangle part;
};

static bool read_strip(const struct strips *strips, int i)
{
    return triptych_read_rectangle(strips->renderer, &strips->image[i]->surface, &strips->part, 0,
                                   strips->words[i], strips->part.width * sizeof(uint32_t)) == TRIPTYCH_OK;
}

static bool write_strip(const struct strips *strips, int i)
{
    return triptych_write_rectangle(strips->renderer, &strips->image[i]->surface, &strips->part, 0,
                                    strips->words[i], strips->part.width * sizeof(uint32_t)) == TRIPTYCH_OK;
}

static void exchange_bits(const struct strips *strips)
{
    uint32_t *a = strips->words[0], *b = strips->words[1];
    for (size_t i = 0, count = (size_t)strips->part.width * strips->part.height; i < count; i++) {
        uint32_t different = (a[i] ^ b[i]) & STENCIL;
        a[i] ^= different;
        b[i] ^= different;
    }
}

/* Bits without a meaning need not be written. */
static bool exchange_strips(struct strips *strips, bool writes[2])
{
    unsigned height = strips->image[0]->height;
    struct triptych_rectangle *part = &strips->part;
    for (; part->y < height; part->y += ROWS) {
        part->height = height - part->y < ROWS ? height - part->y : ROWS;
        if (!read_strip(strips, 0) || !read_strip(strips, 1))
            return false;
        exchange_bits(strips);
        for (int i = 0; i < 2; i++)
            if (writes[i] && !write_strip(strips, i))
                return false;
    }
    return true;
}

static bool exchange_words(triptych_device *renderer, const struct gl_depth *a, const struct gl_depth *b,
                           bool writes[2])
{
    uint32_t *words = malloc(2 * sizeof *words * a->width * ROWS);
    struct strips strips = {renderer, {a, b}, {words, words + (size_t)a->width * ROWS}, {0, 0, a->width, 0}};
    bool exchanged = words && exchange_strips(&strips, writes);
    free(words);
    return exchanged;
}

/* --- Places --- */

static void place(struct gl_depth *host, struct gl_depth *guest)
{
    host->guest = guest == host ? NULL : guest;
    guest->host = host == guest ? NULL : host;
}

/* Two surfaces exchange their stencil. */
static bool exchange(struct gl_share *share, struct gl_depth *a, struct gl_depth *b)
{
    struct gl_depth *of_a = gl_depth_guest(a), *of_b = gl_depth_guest(b);
    bool writes[2] = {of_b->has_stencil, of_a->has_stencil};
    place(a, of_b);
    place(b, of_a);
    share->moves++;
    return (!writes[0] && !writes[1]) || exchange_words(share->renderer, a, b, writes);
}

bool gl_depth_join(struct gl_share *share, struct gl_depth *depth, struct gl_depth *stencil)
{
    struct gl_depth *host = gl_depth_host(stencil);
    return host == depth || exchange(share, depth, host);
}

bool gl_depth_part(struct gl_share *share, struct gl_depth *image)
{
    return gl_depth_join(share, image, image);
}
