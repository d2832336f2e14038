#include "x11.h"

#include <X11/Xlib-xcb.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <xcb/shm.h>
#include <xcb/xcb.h>

static bool find_shared(xcb_connection_t *connection)
{
    xcb_shm_query_version_reply_t *reply =
        xcb_shm_query_version_reply(connection, xcb_shm_query_version(connection), NULL);
    free(reply);
    return reply != NULL;
}

static int default_screen(void *display, bool is_xcb, int given)
{
    return given >= 0 ? given : display && !is_xcb ? XDefaultScreen(display) : 0;
}

bool egl_x11_open(struct egl_x11 *x11, void *display, bool is_xcb, int screen)
{
    int preferred = default_screen(display, is_xcb, screen);
    xcb_connection_t *connection =
        display ? is_xcb ? display : XGetXCBConnection(display) : xcb_connect(NULL, &preferred);
    *x11 = (struct egl_x11){connection, !display, false, screen >= 0 ? screen : preferred};
    const bool good = connection && !xcb_connection_has_error(connection) && x11->screen >= 0 &&
                      x11->screen < xcb_setup_roots_length(xcb_get_setup(connection));
    if (good)
        x11->shared = find_shared(connection);
    else
        egl_x11_close(x11);
    return good;
}

void egl_x11_close(struct egl_x11 *x11)
{
    if (x11->owned && x11->connection)
        xcb_disconnect(x11->connection);
    *x11 = (struct egl_x11){0};
}

static const xcb_screen_t *screen_of(const struct egl_x11 *x11)
{
    xcb_screen_iterator_t screen = xcb_setup_roots_iterator(xcb_get_setup(x11->connection));
    for (int i = 0; i < x11->screen; i++)
        xcb_screen_next(&screen);
    return screen.data;
}

static uint32_t visual_of_depth(const xcb_depth_t *depth)
{
    const xcb_visualtype_t *visual = xcb_depth_visuals(depth);
    const uint32_t red = depth->depth == 16 ? 0xf800 : 0xff0000;
    for (int i = 0; i < xcb_depth_visuals_length(depth); i++)
        if (visual[i]._class == XCB_VISUAL_CLASS_TRUE_COLOR && visual[i].red_mask == red)
            return visual[i].visual_id;
    return 0;
}

/* The visual of the root window is the one that most programs use. */
uint32_t egl_x11_visual(const struct egl_x11 *x11, unsigned bits)
{
    const xcb_screen_t *screen = screen_of(x11);
    uint32_t visual = 0;
    for (xcb_depth_iterator_t depth = xcb_screen_allowed_depths_iterator(screen); depth.rem;
         xcb_depth_next(&depth))
        if (depth.data->depth == bits && !visual)
            visual = visual_of_depth(depth.data);
    return visual && screen->root_depth == bits ? screen->root_visual : visual;
}

static bool read_size(const struct egl_x11 *x11, xcb_get_geometry_cookie_t cookie, struct egl_x11_size *size)
{
    xcb_generic_error_t *error = NULL;
    xcb_get_geometry_reply_t *reply = xcb_get_geometry_reply(x11->connection, cookie, &error);
    free(error);
    if (!reply)
        return false;
    *size = (struct egl_x11_size){reply->width, reply->height, reply->depth};
    free(reply);
    return true;
}

bool egl_x11_size(const struct egl_x11 *x11, uint32_t drawable, struct egl_x11_size *size)
{
    return read_size(x11, xcb_get_geometry(x11->connection, drawable), size);
}

bool egl_x11_shows(const struct egl_x11_size *size, int bits)
{
    return (int)size->depth == bits;
}

static bool succeeded(const struct egl_x11 *x11, xcb_void_cookie_t cookie)
{
    xcb_generic_error_t *error = xcb_request_check(x11->connection, cookie);
    free(error);
    return !error;
}

/* Bytes of a pixel in images of the server; 0 for a depth whose pixels EGL does not write. */
static unsigned pixel_bytes(const struct egl_x11 *x11, unsigned depth)
{
    const xcb_setup_t *setup = xcb_get_setup(x11->connection);
    const unsigned bits = depth == 16 ? 16 : depth == 24 || depth == 32 ? 32 : 0;
    for (xcb_format_iterator_t format = xcb_setup_pixmap_formats_iterator(setup); format.rem;
         xcb_format_next(&format))
        if (format.data->depth == depth && format.data->bits_per_pixel == bits)
            return bits / 8;
    return 0;
}

static void *attach_memory(int id)
{
    void *memory = shmat(id, NULL, 0);
    return memory == (void *)-1 ? NULL : memory;
}

/* The segment is marked for removal after the server has attached it, so that none remains after a crash. */
static bool make_shared(const struct egl_x11 *x11, struct egl_x11_picture *picture, size_t bytes)
{
    const int id = shmget(IPC_PRIVATE, bytes, IPC_CREAT | 0600);
    if (id < 0)
        return false;
    const uint32_t segment = xcb_generate_id(x11->connection);
    uint8_t *memory = attach_memory(id);
    bool good = memory && succeeded(x11, xcb_shm_attach_checked(x11->connection, segment, (uint32_t)id, 0));
    shmctl(id, IPC_RMID, NULL);
    if (good) {
        picture->pixels = memory;
        picture->segment = segment;
    } else if (memory) {
        shmdt(memory);
    }
    return good;
}

bool egl_x11_begin(const struct egl_x11 *x11, struct egl_x11_picture *picture, uint32_t drawable)
{
    *picture = (struct egl_x11_picture){.drawable = drawable};
    if (!egl_x11_size(x11, drawable, &picture->size))
        return false;
    picture->bytes = pixel_bytes(x11, picture->size.depth);
    picture->stride = ((size_t)picture->size.width * picture->bytes + 3) & ~(size_t)3;
    const size_t bytes = picture->stride * picture->size.height;
    if (!bytes)
        return false;
    picture->gc = xcb_generate_id(x11->connection);
    if (!succeeded(x11, xcb_create_gc_checked(x11->connection, picture->gc, drawable, 0, NULL)))
        return false;
    if (!x11->shared || !make_shared(x11, picture, bytes))
        picture->pixels = malloc(bytes);
    if (!picture->pixels)
        succeeded(x11, xcb_free_gc_checked(x11->connection, picture->gc));
    return picture->pixels != NULL;
}

bool egl_x11_settle(const struct egl_x11 *x11, struct egl_x11_picture *picture)
{
    const xcb_void_cookie_t cookie = {picture->unproved};
    picture->unproved = 0;
    return !cookie.sequence || succeeded(x11, cookie);
}

void egl_x11_end(const struct egl_x11 *x11, struct egl_x11_picture *picture)
{
    struct egl_x11_size size;
    if (!picture->pixels)
        return;
    egl_x11_receive_size(x11, picture, &size);
    if (picture->segment) {
        succeeded(x11, xcb_shm_detach_checked(x11->connection, picture->segment));
        shmdt(picture->pixels);
    } else {
        free(picture->pixels);
    }
    succeeded(x11, xcb_free_gc_checked(x11->connection, picture->gc));
    *picture = (struct egl_x11_picture){0};
}

/* The program's own requests follow this one on its connection. Those of a program without one overtake it
 * unless the server has executed it. */
static bool put_shared(const struct egl_x11 *x11, struct egl_x11_picture *picture, unsigned x, unsigned y,
                       unsigned width, unsigned height)
{
    picture->unproved =
        xcb_shm_put_image_checked(x11->connection, picture->drawable, picture->gc,
                                  (uint16_t)(picture->stride / picture->bytes),
                                  (uint16_t)picture->size.height, (uint16_t)x, (uint16_t)y, (uint16_t)width,
                                  (uint16_t)height, (int16_t)x, (int16_t)y, (uint8_t)picture->size.depth,
                                  XCB_IMAGE_FORMAT_Z_PIXMAP, 0, picture->segment, 0)
            .sequence;
    return x11->owned ? egl_x11_settle(x11, picture) : xcb_flush(x11->connection) > 0;
}

/* Whole rows, in requests that the server accepts. */
static bool put_rows(const struct egl_x11 *x11, const struct egl_x11_picture *picture, unsigned y,
                     unsigned height)
{
    const size_t most = (size_t)xcb_get_maximum_request_length(x11->connection) * 4 - 64;
    const unsigned rows = (unsigned)(most / picture->stride ? most / picture->stride : 1);
    bool good = true;
    for (unsigned done = 0; done < height && good; done += rows) {
        const unsigned count = height - done < rows ? height - done : rows;
        good = succeeded(x11, xcb_put_image_checked(
                                  x11->connection, XCB_IMAGE_FORMAT_Z_PIXMAP, picture->drawable, picture->gc,
                                  (uint16_t)picture->size.width, (uint16_t)count, 0, (int16_t)(y + done), 0,
                                  (uint8_t)picture->size.depth, (uint32_t)(picture->stride * count),
                                  picture->pixels + picture->stride * (y + done)));
    }
    return good;
}

bool egl_x11_put(const struct egl_x11 *x11, struct egl_x11_picture *picture, unsigned x, unsigned y,
                 unsigned width, unsigned height)
{
    return picture->segment ? put_shared(x11, picture, x, y, width, height)
                            : put_rows(x11, picture, y, height);
}

void egl_x11_request_size(const struct egl_x11 *x11, struct egl_x11_picture *picture)
{
    picture->requested = xcb_get_geometry(x11->connection, picture->drawable).sequence;
    xcb_flush(x11->connection);
}

bool egl_x11_receive_size(const struct egl_x11 *x11, struct egl_x11_picture *picture,
                          struct egl_x11_size *size)
{
    const bool exists =
        picture->requested && read_size(x11, (xcb_get_geometry_cookie_t){picture->requested}, size);
    picture->requested = 0;
    return egl_x11_settle(x11, picture) && exists;
}

bool egl_x11_get(const struct egl_x11 *x11, struct egl_x11_picture *picture)
{
    xcb_generic_error_t *error = NULL;
    const xcb_get_image_cookie_t cookie =
        xcb_get_image(x11->connection, XCB_IMAGE_FORMAT_Z_PIXMAP, picture->drawable, 0, 0,
                      (uint16_t)picture->size.width, (uint16_t)picture->size.height, ~0u);
    xcb_get_image_reply_t *reply = xcb_get_image_reply(x11->connection, cookie, &error);
    const size_t bytes = picture->stride * picture->size.height;
    const bool good = reply && (size_t)xcb_get_image_data_length(reply) >= bytes;
    if (good)
        memcpy(picture->pixels, xcb_get_image_data(reply), bytes);
    free(error);
    free(reply);
    return good;
}
