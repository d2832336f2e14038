#include "tests/command/fuzz/targets/gl/canvas.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

enum { ENGINES = 8, INPUTS = 1000 };

static struct kept {
    const char *engine;
    struct gl_device *device;
} kept[ENGINES];

static struct kept *find(const char *engine)
{
    for (unsigned i = 0; i < ENGINES; i++)
        if (!kept[i].engine || !strcmp(kept[i].engine, engine))
            return kept + i;
    return NULL;
}

struct gl_device *canvas_device(const char *engine)
{
    struct kept *found = find(engine);
    expect(found, "room for %s", engine);
    if (found->device)
        return found->device;
    setenv("TRIPTYCH_ENGINE", engine, 1);
    setenv("TRIPTYCH_THREADS", "1", 1);
    *found = (struct kept){engine, gl_device_create()};
    unsetenv("TRIPTYCH_ENGINE");
    unsetenv("TRIPTYCH_THREADS");
    expect(found->device, "a device of %s", engine);
    return found->device;
}

void canvas_next(void)
{
    static unsigned inputs;
    bool drops = ++inputs % INPUTS == 0;
    for (unsigned i = 0; i < ENGINES && drops; i++) {
        gl_device_drop(kept[i].device);
        kept[i].device = NULL;
    }
}

static triptych_image *make_image(struct gl_device *device, enum triptych_surface_format format,
                                  enum triptych_depth_format depth)
{
    const struct triptych_image_description description = {.format = format,
                                                           .depth_format = depth,
                                                           .width = CANVAS_WIDTH,
                                                           .height = CANVAS_HEIGHT,
                                                           .samples = 1};
    triptych_image *image;
    expect(!triptych_image_create(device->renderer, &description, &image), "%s",
           triptych_error(device->renderer));
    return image;
}

void canvas_begin(struct canvas *canvas, struct gl_device *device, enum gl_interface interface,
                  const struct canvas *share)
{
    const struct gl_context_options options = {.device = device, .interface = interface};
    canvas->surface =
        (struct gl_surface){.device = device,
                            .color.image = make_image(device, TRIPTYCH_SURFACE_A8B8G8R8, TRIPTYCH_DEPTH_NONE),
                            .depth.image = make_image(device, 0, TRIPTYCH_DEPTH_D24S8),
                            .width = CANVAS_WIDTH,
                            .height = CANVAS_HEIGHT,
                            .samples = 1,
                            .format = TRIPTYCH_SURFACE_A8B8G8R8,
                            .depth_format = TRIPTYCH_DEPTH_D24S8,
                            .red = 8,
                            .green = 8,
                            .blue = 8,
                            .alpha = 8,
                            .depth_bits = 24,
                            .stencil_bits = 8};
    canvas->context = gl_context_create(share ? gl_context_share(share->context) : NULL, &options);
    expect(canvas->context && gl_context_bind(canvas->context, &canvas->surface, &canvas->surface),
           "a context");
}

void canvas_end(struct canvas *canvas)
{
    struct gl_device *device = canvas->surface.device;
    gl_context_bind(canvas->context, NULL, NULL);
    gl_context_destroy(canvas->context);
    gl_device_enter(device, NULL);
    triptych_image_destroy(device->renderer, canvas->surface.color.image);
    triptych_image_destroy(device->renderer, canvas->surface.depth.image);
    gl_device_forget(device);
    gl_device_leave(device);
}
