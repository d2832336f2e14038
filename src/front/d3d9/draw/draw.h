/* Functions that the draws of a device share. */
#ifndef D3D9_DRAW_DRAW_H
#define D3D9_DRAW_DRAW_H

#include "front/d3d9/device.h"

/* The needs of a draw among the device's bindings. */
enum {
    D3D9_NEEDS_STREAMS = 1, /* all streams of the declaration; otherwise all but stream 0 */
    D3D9_NEEDS_INDICES = 2,
    D3D9_NEEDS_INSTANCES = 4 /* stream frequencies count */
};

/* Passes on what the renderer lacks before a draw or before a clear. Returns false if nothing can be drawn:
 * there is no target, or no memory. */
bool d3d9_draw_prepare(struct d3d9_device *, unsigned needs);
bool d3d9_draw_prepare_targets(struct d3d9_device *);
/* The format of targets that keep nothing (NULL). */
enum { D3D9_DRAW_NOTHING = 0x4c4c554e };
/* The target with this number; null if there is none or it keeps nothing. */
struct d3d9_surface *d3d9_draw_target(const struct d3d9_device *, unsigned index);
/* Passes on the viewport and the scissor rectangle. */
void d3d9_draw_pass_areas(struct d3d9_device *);

#endif
