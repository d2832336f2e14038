#include "surface.h"

#include "attributes.h"
#include "calls.h"
#include "front/gl/image.h"
#include "thread.h"

static bool make_image(struct egl_surface *surface, const struct triptych_image_description *description,
                       struct triptych_surface *made)
{
    *made = (struct triptych_surface){0};
    return !triptych_image_create(surface->gl.device->renderer, description, &made->image);
}

/* The colour of a pbuffer that a texture can get is a texture itself. */
static bool make_color(struct egl_surface *surface, const struct triptych_image_description *description,
                       struct triptych_surface *made)
{
    if (surface->texture_format == EGL_NO_TEXTURE)
        return make_image(surface, description, made);
    surface->texture = gl_image_of_color(surface->gl.device, surface->config->format, description->width,
                                         description->height);
    if (surface->texture)
        *made = gl_image_surface(surface->texture);
    return surface->texture;
}

static void destroy_color(struct egl_surface *surface, const struct triptych_surface *color)
{
    triptych_image_destroy(surface->gl.device->renderer, color->image);
    gl_image_drop(surface->texture);
    surface->texture = NULL;
}

static bool make_images(struct egl_surface *surface, unsigned width, unsigned height,
                        struct triptych_surface made[2])
{
    const struct egl_config *config = surface->config;
    struct triptych_image_description description = {
        .format = config->format, .width = width, .height = height, .samples = config->samples};
    made[1] = (struct triptych_surface){0};
    if (!make_color(surface, &description, &made[0]))
        return false;
    if (config->depth_format == TRIPTYCH_DEPTH_NONE)
        return true;
    description.format = 0;
    description.depth_format = config->depth_format;
    if (make_image(surface, &description, &made[1]))
        return true;
    destroy_color(surface, &made[0]);
    return false;
}

static void destroy_images(struct egl_surface *surface)
{
    triptych_device *renderer = surface->gl.device->renderer;
    if (!surface->gl.color.image && !surface->gl.color.texture)
        return;
    destroy_color(surface, &surface->gl.color);
    triptych_image_destroy(renderer, surface->gl.depth.image);
    gl_device_forget(surface->gl.device);
}

/* A window keeps its left top corner, so a preserved surface does. */
static void keep_corner(struct egl_surface *surface, const struct triptych_surface *to, unsigned columns,
                        unsigned rows)
{
    const struct gl_surface *gl = &surface->gl;
    const unsigned width = columns < gl->width ? columns : gl->width;
    const unsigned height = rows < gl->height ? rows : gl->height;
    const struct triptych_rectangle from_part = {0, gl->height - height, width, height};
    const struct triptych_rectangle to_part = {0, rows - height, width, height};
    triptych_copy(gl->device->renderer, &gl->color, &from_part, to, &to_part, TRIPTYCH_COPY_POINT);
}

/* Creates the images of a new size and frees the old ones. The contents are undefined, unless swaps preserve
 * those of the colour. */
static bool resize(struct egl_surface *surface, EGLint width, EGLint height)
{
    struct gl_surface *gl = &surface->gl;
    struct triptych_surface made[2];
    const unsigned columns = width > 0 ? (unsigned)width : 1, rows = height > 0 ? (unsigned)height : 1;
    gl_device_enter(gl->device, NULL);
    const bool good = make_images(surface, columns, rows, made);
    if (good) {
        if (surface->behavior == EGL_BUFFER_PRESERVED && gl->color.image)
            keep_corner(surface, &made[0], columns, rows);
        destroy_images(surface);
        gl->color = made[0];
        gl->depth = made[1];
        gl->width = columns;
        gl->height = rows;
        gl->generation++;
        surface->width = width;
        surface->height = height;
        surface->shown = false;
    }
    gl_device_leave(gl->device);
    return good;
}

bool egl_surface_fit(struct egl_surface *surface, const struct egl_x11_size *size)
{
    const struct egl_x11 *x11 = &surface->object.display->x11;
    if ((EGLint)size->width == surface->width && (EGLint)size->height == surface->height)
        return true;
    struct egl_x11_picture picture;
    if (!egl_x11_begin(x11, &picture, surface->drawable))
        return false;
    /* The size can change between two requests: that of the picture counts. */
    if (!resize(surface, (EGLint)picture.size.width, (EGLint)picture.size.height)) {
        egl_x11_end(x11, &picture);
        return false;
    }
    egl_x11_end(x11, &surface->picture);
    surface->picture = picture;
    return true;
}

bool egl_surface_follow(struct egl_surface *surface)
{
    struct egl_x11_size size;
    return egl_x11_size(&surface->object.display->x11, surface->drawable, &size) &&
           egl_surface_fit(surface, &size);
}

static void free_surface(struct egl_object *object)
{
    struct egl_surface *surface = (struct egl_surface *)object;
    struct gl_device *device = surface->gl.device;
    if (!device)
        return;
    gl_device_enter(device, NULL);
    destroy_images(surface);
    gl_device_leave(device);
    gl_device_drop(device);
}

static void describe(struct egl_surface *surface, const struct egl_config *config)
{
    const EGLint *value = config->value;
    surface->config = config;
    surface->gl.samples = config->samples;
    surface->gl.format = config->format;
    surface->gl.depth_format = config->depth_format;
    surface->gl.red = (unsigned)value[EGL_INDEX_RED_SIZE];
    surface->gl.green = (unsigned)value[EGL_INDEX_GREEN_SIZE];
    surface->gl.blue = (unsigned)value[EGL_INDEX_BLUE_SIZE];
    surface->gl.alpha = (unsigned)value[EGL_INDEX_ALPHA_SIZE];
    surface->gl.depth_bits = (unsigned)value[EGL_INDEX_DEPTH_SIZE];
    surface->gl.stencil_bits = (unsigned)value[EGL_INDEX_STENCIL_SIZE];
    surface->gl.owner = surface;
}

static struct egl_surface *begin(struct egl_display *display, const struct egl_config *config, EGLint kind)
{
    struct egl_surface *surface = egl_object_make(display, EGL_KIND_SURFACE, sizeof *surface, free_surface);
    if (!surface)
        return NULL;
    surface->kind = kind;
    surface->gl.device = gl_device_hold(display->device);
    surface->gl.single = kind == EGL_PIXMAP_BIT;
    surface->behavior = EGL_BUFFER_DESTROYED;
    surface->resolve = EGL_MULTISAMPLE_RESOLVE_DEFAULT;
    surface->texture_format = surface->texture_target = EGL_NO_TEXTURE;
    describe(surface, config);
    return surface;
}

/* Returns null, after an error, if the creation of the images failed. */
static struct egl_surface *complete(struct egl_surface *surface, EGLint width, EGLint height)
{
    if (resize(surface, width, height))
        return surface;
    egl_object_destroy(&surface->object);
    egl_fail(EGL_BAD_ALLOC);
    return NULL;
}

/* --- Pbuffers --- */

struct pbuffer {
    EGLAttrib width, height, largest, texture_format, texture_target, mipmap;
};

static bool is_boolean(EGLAttrib value)
{
    return value == EGL_TRUE || value == EGL_FALSE;
}

/* Returns the error of a value, or EGL_SUCCESS. */
static EGLint read_pbuffer(struct pbuffer *pbuffer, const EGLAttrib *list)
{
    for (; *list != EGL_NONE; list += 2) {
        EGLAttrib value = list[1];
        bool good = true;
        switch (list[0]) {
        case EGL_WIDTH: good = (pbuffer->width = value) >= 0; break;
        case EGL_HEIGHT: good = (pbuffer->height = value) >= 0; break;
        case EGL_LARGEST_PBUFFER: good = is_boolean(pbuffer->largest = value); break;
        case EGL_MIPMAP_TEXTURE: good = is_boolean(pbuffer->mipmap = value); break;
        case EGL_TEXTURE_FORMAT:
            pbuffer->texture_format = value;
            good = value == EGL_NO_TEXTURE || value == EGL_TEXTURE_RGB || value == EGL_TEXTURE_RGBA;
            break;
        case EGL_TEXTURE_TARGET:
            pbuffer->texture_target = value;
            good = value == EGL_NO_TEXTURE || value == EGL_TEXTURE_2D;
            break;
        case EGL_GL_COLORSPACE:
            if (value != EGL_GL_COLORSPACE_LINEAR)
                return value == EGL_GL_COLORSPACE_SRGB ? EGL_BAD_MATCH : EGL_BAD_ATTRIBUTE;
            break;
        case EGL_VG_COLORSPACE:
        case EGL_VG_ALPHA_FORMAT: return EGL_BAD_MATCH;
        default: return EGL_BAD_ATTRIBUTE;
        }
        if (!good)
            return list[0] == EGL_WIDTH || list[0] == EGL_HEIGHT ? EGL_BAD_PARAMETER : EGL_BAD_ATTRIBUTE;
    }
    return EGL_SUCCESS;
}

/* A config with alpha has pbuffers for textures with alpha, one without has those for textures without. */
static EGLint check_texture(const struct egl_config *config, const struct pbuffer *pbuffer)
{
    const EGLAttrib format = pbuffer->texture_format;
    if ((format == EGL_NO_TEXTURE) != (pbuffer->texture_target == EGL_NO_TEXTURE))
        return EGL_BAD_MATCH;
    const bool fits = format == EGL_NO_TEXTURE    ? true
                      : format == EGL_TEXTURE_RGB ? config->value[EGL_INDEX_BIND_TO_TEXTURE_RGB]
                                                  : config->value[EGL_INDEX_BIND_TO_TEXTURE_RGBA];
    return fits ? EGL_SUCCESS : EGL_BAD_MATCH;
}

static EGLint check_pbuffer(const struct egl_config *config, struct pbuffer *pbuffer)
{
    const EGLint error = check_texture(config, pbuffer);
    if (error != EGL_SUCCESS)
        return error;
    if (pbuffer->largest && pbuffer->width > TRIPTYCH_TARGET_MAXIMUM)
        pbuffer->width = TRIPTYCH_TARGET_MAXIMUM;
    if (pbuffer->largest && pbuffer->height > TRIPTYCH_TARGET_MAXIMUM)
        pbuffer->height = TRIPTYCH_TARGET_MAXIMUM;
    return pbuffer->width > TRIPTYCH_TARGET_MAXIMUM || pbuffer->height > TRIPTYCH_TARGET_MAXIMUM
               ? EGL_BAD_ALLOC
               : EGL_SUCCESS;
}

static EGLSurface create_pbuffer(struct egl_display *display, EGLConfig handle, const EGLint *words)
{
    struct pbuffer pbuffer = {.texture_format = EGL_NO_TEXTURE, .texture_target = EGL_NO_TEXTURE};
    struct egl_list list;
    const struct egl_config *config = egl_config_find(display, handle);
    if (!config)
        return egl_fail(EGL_BAD_CONFIG), EGL_NO_SURFACE;
    EGLint error = read_pbuffer(&pbuffer, egl_list_widen(&list, words));
    if (error == EGL_SUCCESS)
        error = check_pbuffer(config, &pbuffer);
    if (error != EGL_SUCCESS)
        return egl_fail(error), EGL_NO_SURFACE;
    struct egl_surface *surface = begin(display, config, EGL_PBUFFER_BIT);
    if (!surface)
        return EGL_NO_SURFACE;
    surface->largest = (EGLint)pbuffer.largest;
    surface->mipmap = (EGLint)pbuffer.mipmap;
    surface->texture_format = (EGLint)pbuffer.texture_format;
    surface->texture_target = (EGLint)pbuffer.texture_target;
    return complete(surface, (EGLint)pbuffer.width, (EGLint)pbuffer.height);
}

EGLSurface egl_CreatePbufferSurface(EGLDisplay dpy, EGLConfig config, const EGLint *list)
{
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_NO_SURFACE;
    EGLSurface surface = create_pbuffer(display, config, list);
    egl_display_leave(display);
    return surface;
}

/* Only OpenVG has buffers for it. */
EGLSurface egl_CreatePbufferFromClientBuffer(EGLDisplay dpy, EGLenum type, EGLClientBuffer buffer,
                                             EGLConfig config, const EGLint *list)
{
    struct egl_display *display = egl_display_enter(dpy);
    (void)type, (void)buffer, (void)list;
    if (!display)
        return EGL_NO_SURFACE;
    egl_fail(egl_config_find(display, config) ? EGL_BAD_PARAMETER : EGL_BAD_CONFIG);
    egl_display_leave(display);
    return EGL_NO_SURFACE;
}

/* --- Windows and pixmaps --- */

static EGLint read_drawable(EGLint kind, const EGLAttrib *list)
{
    for (; *list != EGL_NONE; list += 2)
        switch (list[0]) {
        case EGL_RENDER_BUFFER:
            if (kind != EGL_WINDOW_BIT || (list[1] != EGL_BACK_BUFFER && list[1] != EGL_SINGLE_BUFFER))
                return EGL_BAD_ATTRIBUTE;
            break;
        case EGL_GL_COLORSPACE:
            if (list[1] != EGL_GL_COLORSPACE_LINEAR)
                return list[1] == EGL_GL_COLORSPACE_SRGB ? EGL_BAD_MATCH : EGL_BAD_ATTRIBUTE;
            break;
        case EGL_VG_COLORSPACE:
        case EGL_VG_ALPHA_FORMAT: return EGL_BAD_MATCH;
        default: return EGL_BAD_ATTRIBUTE;
        }
    return EGL_SUCCESS;
}

/* A window may have more bits than the config: an alpha, which is then the config's or 1. */
static EGLint check_drawable(const struct egl_display *display, const struct egl_config *config, EGLint kind,
                             uint32_t drawable)
{
    struct egl_x11_size size;
    if (!(config->value[EGL_INDEX_SURFACE_TYPE] & kind))
        return EGL_BAD_MATCH;
    if (!egl_x11_size(&display->x11, drawable, &size))
        return kind == EGL_WINDOW_BIT ? EGL_BAD_NATIVE_WINDOW : EGL_BAD_NATIVE_PIXMAP;
    const bool wide = config->value[EGL_INDEX_RED_SIZE] == 8;
    const bool fits = kind == EGL_PIXMAP_BIT ? egl_x11_shows(&size, config->value[EGL_INDEX_BUFFER_SIZE])
                                             : wide == (size.depth >= 24);
    return fits ? EGL_SUCCESS : EGL_BAD_MATCH;
}

/* Two surfaces of one window would show their frames in turns. */
static bool has_surface(const struct egl_display *display, uint32_t drawable)
{
    for (struct egl_object *object = display->objects; object; object = object->next)
        if (object->kind == EGL_KIND_SURFACE && ((struct egl_surface *)object)->drawable == drawable)
            return true;
    return false;
}

static void free_drawable(struct egl_object *object)
{
    struct egl_surface *surface = (struct egl_surface *)object;
    egl_x11_end(&object->display->x11, &surface->picture);
    free_surface(object);
}

static EGLSurface attach(struct egl_display *display, const struct egl_config *config, EGLint kind,
                         uint32_t drawable)
{
    struct egl_surface *surface = begin(display, config, kind);
    if (!surface)
        return EGL_NO_SURFACE;
    surface->object.free = free_drawable;
    surface->drawable = drawable;
    if (!egl_x11_begin(&display->x11, &surface->picture, drawable)) {
        egl_object_destroy(&surface->object);
        return egl_fail(EGL_BAD_ALLOC), EGL_NO_SURFACE;
    }
    const struct egl_x11_size *size = &surface->picture.size;
    surface = complete(surface, (EGLint)size->width, (EGLint)size->height);
    if (surface && kind == EGL_PIXMAP_BIT && !egl_surface_load(surface)) {
        egl_object_destroy(&surface->object);
        return egl_fail(EGL_BAD_ALLOC), EGL_NO_SURFACE;
    }
    return surface;
}

static EGLSurface create_drawable(struct egl_display *display, EGLConfig handle, EGLint kind,
                                  uint32_t drawable, const EGLAttrib *list)
{
    const struct egl_config *config = egl_config_find(display, handle);
    EGLint error = config ? read_drawable(kind, list) : EGL_BAD_CONFIG;
    if (error == EGL_SUCCESS && display->platform != EGL_PLATFORM_X11_KHR)
        error = kind == EGL_WINDOW_BIT ? EGL_BAD_NATIVE_WINDOW : EGL_BAD_NATIVE_PIXMAP;
    if (error == EGL_SUCCESS)
        error = check_drawable(display, config, kind, drawable);
    if (error == EGL_SUCCESS && has_surface(display, drawable))
        error = EGL_BAD_ALLOC;
    if (error != EGL_SUCCESS)
        return egl_fail(error), EGL_NO_SURFACE;
    return attach(display, config, kind, drawable);
}

static EGLSurface create(EGLDisplay dpy, EGLConfig config, EGLint kind, uint32_t drawable,
                         const EGLAttrib *list)
{
    static const EGLAttrib none[] = {EGL_NONE};
    struct egl_display *display = egl_display_enter(dpy);
    if (!display)
        return EGL_NO_SURFACE;
    EGLSurface surface = create_drawable(display, config, kind, drawable, list ? list : none);
    egl_display_leave(display);
    return surface;
}

EGLSurface egl_CreateWindowSurface(EGLDisplay dpy, EGLConfig config, EGLNativeWindowType window,
                                   const EGLint *words)
{
    struct egl_list list;
    return create(dpy, config, EGL_WINDOW_BIT, (uint32_t)window, egl_list_widen(&list, words));
}

EGLSurface egl_CreatePixmapSurface(EGLDisplay dpy, EGLConfig config, EGLNativePixmapType pixmap,
                                   const EGLint *words)
{
    struct egl_list list;
    return create(dpy, config, EGL_PIXMAP_BIT, (uint32_t)pixmap, egl_list_widen(&list, words));
}

/* Platform functions get the address of the window: a word of Xlib or of xcb. */
static uint32_t drawable_at(EGLDisplay dpy, const void *address)
{
    const struct egl_display *display = egl_display_find(dpy);
    if (!display || display->platform != EGL_PLATFORM_X11_KHR || !address)
        return 0;
    return display->is_xcb ? *(const uint32_t *)address : (uint32_t) * (const unsigned long *)address;
}

EGLSurface egl_CreatePlatformWindowSurface(EGLDisplay dpy, EGLConfig config, void *window,
                                           const EGLAttrib *list)
{
    return create(dpy, config, EGL_WINDOW_BIT, drawable_at(dpy, window), list);
}

EGLSurface egl_CreatePlatformPixmapSurface(EGLDisplay dpy, EGLConfig config, void *pixmap,
                                           const EGLAttrib *list)
{
    return create(dpy, config, EGL_PIXMAP_BIT, drawable_at(dpy, pixmap), list);
}

EGLSurface egl_CreatePlatformWindowSurfaceEXT(EGLDisplay dpy, EGLConfig config, void *window,
                                              const EGLint *words)
{
    struct egl_list list;
    return create(dpy, config, EGL_WINDOW_BIT, drawable_at(dpy, window), egl_list_widen(&list, words));
}

EGLSurface egl_CreatePlatformPixmapSurfaceEXT(EGLDisplay dpy, EGLConfig config, void *pixmap,
                                              const EGLint *words)
{
    struct egl_list list;
    return create(dpy, config, EGL_PIXMAP_BIT, drawable_at(dpy, pixmap), egl_list_widen(&list, words));
}
