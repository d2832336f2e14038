/* The bitmap through which a swap chain's pixels reach a window. */
#ifndef D3D9_PE_BITMAP_H
#define D3D9_PE_BITMAP_H

#include "front/d3d9/host.h"
#include <windows.h>

/* All zero: there is none. */
struct bitmap {
    HDC dc;
    HBITMAP bitmap;
    void *bits;
    UINT width, height;
};

void bitmap_free(struct bitmap *);
/* Makes it the size of the picture's buffer. Returns FALSE without memory. */
BOOL bitmap_fit(struct bitmap *, const struct d3d9_host_picture *);
/* Describes the bitmap to the Linux side. */
void bitmap_describe(const struct bitmap *, struct d3d9_host_picture *);
/* Draws a rectangle of the bitmap, null: the picture, into a rectangle of the window's client area, null: all
 * of it. Without stretching, only the region's pixels are drawn; null: all. The region is in the bitmap's
 * coordinates. */
void bitmap_draw(const struct bitmap *, const struct d3d9_host_picture *, const RECT *source,
                 const RECT *destination, const RGNDATA *region);

#endif
