/* Offsets and sizes of the structures that the stitcher's fragments read and write. */
#include "contract/arguments.h"

#define OFFSET(name, value) __asm__ volatile(".ascii \"@" #name " %c0\"" : : "i"((int)(value)))

void offsets(void);
void offsets(void)
{
    OFFSET(PLANE_VALUE, offsetof(struct plane, value));
    OFFSET(PLANE_DX, offsetof(struct plane, dx));
    OFFSET(PLANE_DY, offsetof(struct plane, dy));
    OFFSET(PLANE_BYTES, sizeof(struct plane));
    OFFSET(HEAD_VISIBLE, offsetof(struct triangle_head, visible));
    OFFSET(HEAD_Y, offsetof(struct triangle_head, y));
    OFFSET(HEAD_ORIGIN_Y, offsetof(struct triangle_head, origin_y));
    OFFSET(ENTRY_SHIFT, __builtin_ctz(sizeof(struct entry)));
    OFFSET(VIEWPORT_SCALE_X, 0);
    OFFSET(VIEWPORT_OFFSET_X, offsetof(struct job, offset_x) - offsetof(struct job, scale_x));
    OFFSET(VIEWPORT_SCALE_Y, offsetof(struct job, scale_y) - offsetof(struct job, scale_x));
    OFFSET(VIEWPORT_OFFSET_Y, offsetof(struct job, offset_y) - offsetof(struct job, scale_x));
    OFFSET(VIEWPORT_DEPTH_OFFSET, offsetof(struct job, depth_offset) - offsetof(struct job, depth_scale));
}
