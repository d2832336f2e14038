/* Configs: the formats of surfaces. */
#ifndef EGL_CONFIG_H
#define EGL_CONFIG_H

#include "triptych.h"
#include "types.h"

enum {
#define EGL_ATTRIBUTE(name, criterion, initial) EGL_INDEX_##name,
#include "config_attribute.def"
#undef EGL_ATTRIBUTE
    EGL_ATTRIBUTES
};

/* Six formats of colours, five of depth and stencil, with one sample and with four. */
enum { EGL_CONFIGS = 60 };

struct egl_config {
    EGLint value[EGL_ATTRIBUTES];
    enum triptych_surface_format format;
    enum triptych_depth_format depth_format; /* TRIPTYCH_DEPTH_NONE: no depth */
    unsigned samples;                        /* 1 or 4 */
};

struct egl_display;

/* Makes the configs of a display whose platform and X11 connection are known. */
void egl_config_make(struct egl_display *);
/* Finds a config; null, without an error, if there is none. */
const struct egl_config *egl_config_find(const struct egl_display *, EGLConfig);

#endif
