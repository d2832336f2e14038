/* A page (bench/streams/pages) as plain arrays, which bench/peers/gles/page.py makes. */
#ifndef BENCH_PEERS_PAGE_H
#define BENCH_PEERS_PAGE_H

#include <stdint.h>

enum page_shader { SOLID, IMAGE, MASK, SUBPIXEL, LINE, ROUNDED, ROUNDED_IMAGE, PAGE_SHADERS };
enum page_kind { FLAT_VERTICES, ROUND_VERTICES, PAGE_KINDS };
enum { PAGE_TEXTURES = 32, PAGE_NO_TEXTURE = 0xffffffff };

/* In the file, from the first field on. Blending is that of colours that are multiplied by alpha; SUBPIXEL
 * blends by its second colour. shaded: the colours at the corners of a triangle differ. */
struct page_draw {
    uint32_t shader, texture, linear, blend, shaded, kind, first, count;
};

/* A vertex is x and y in pixels from the top, four bytes of colour, u and v. A round one has five floats
 * more: its place from the centre, the half sides less the radius, and the radius and 1/2. */
enum { PAGE_FLAT_BYTES = 20, PAGE_ROUND_BYTES = 40 };

struct page_texture {
    uint32_t alpha, width, height; /* alpha: a byte a texel; otherwise RGBA8 */
    const uint8_t *texels;
};

struct page {
    uint8_t *file;
    uint32_t texture_count, draw_count, vertex_count[PAGE_KINDS], index_count[PAGE_KINDS];
    const float *clear;
    const struct page_draw *draws;
    const uint8_t *vertices[PAGE_KINDS];
    const uint16_t *indices[PAGE_KINDS];
    struct page_texture textures[PAGE_TEXTURES];
};

/* Reads NAME.page of the folder that the environment variable PAGES names. Returns null, or a reason. */
const char *workload_page_read(struct page *, const char *name);
void workload_page_free(struct page *);

#endif
