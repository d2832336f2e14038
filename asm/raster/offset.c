/* Offsets of the structures that the rasterizer's kernel for tiny triangles reads. */
#include "render/raster/raster.h"

#define OFFSET(name, value) __asm__ volatile(".ascii \"@" #name " %c0\"" : : "i"((int)(value)))

void offsets(void);
void offsets(void)
{
    OFFSET(LIMIT_LOW, offsetof(struct raster_site, limit.low));
    OFFSET(LIMIT_HIGH, offsetof(struct raster_site, limit.high));
    OFFSET(COLUMN, offsetof(struct raster_site, column));
    OFFSET(ROW, offsetof(struct raster_site, row));
    OFFSET(HEAD_X, offsetof(struct triangle_head, x));
    OFFSET(HEAD_Y, offsetof(struct triangle_head, y));
}
