/* Windows and pixmaps of X11, over xcb: their sizes, and pictures in them.
 *
 * Every request has a check of its own, so that an error never reaches the error handler of the program. */
#ifndef EGL_X11_H
#define EGL_X11_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct xcb_connection_t;

/* The value of EGL_NATIVE_VISUAL_TYPE: X11's class of visuals. */
enum { EGL_X11_TRUE_COLOR = 4 };

struct egl_x11 {
    struct xcb_connection_t *connection;
    bool owned;  /* opened by EGL */
    bool shared; /* the server has the extension for shared memory */
    int screen;
};

struct egl_x11_size {
    unsigned width, height, depth; /* pixels, bits per pixel of the colours */
};

/* A picture of a drawable in memory: rows from the top, `stride` bytes apart. */
struct egl_x11_picture {
    struct egl_x11_size size;
    uint32_t drawable, gc;
    uint32_t segment; /* of shared memory; 0: the memory is the process's own */
    uint8_t *pixels;  /* null: none */
    size_t stride;
    unsigned bytes;     /* per pixel */
    unsigned unproved;  /* the request of the last put, whose end is not known; 0: none */
    unsigned requested; /* the request for its size that is not answered; 0: none */
};

/* Connects: `display` is Xlib's Display, or with `is_xcb` a connection; null: a new connection to DISPLAY. A
 * negative screen is the default one. Returns false if there is no server. */
bool egl_x11_open(struct egl_x11 *, void *display, bool is_xcb, int screen);
void egl_x11_close(struct egl_x11 *);

/* Returns a visual of true colour with 24 or 16 bits, in the order of the words that the renderer writes; 0
 * if the screen has none. */
uint32_t egl_x11_visual(const struct egl_x11 *, unsigned bits);

/* Reads the size of a window or a pixmap. Returns false if it does not exist. */
bool egl_x11_size(const struct egl_x11 *, uint32_t drawable, struct egl_x11_size *);
/* Returns true if a pixmap of this depth has the format of a config with `bits` bits of colour and alpha. */
bool egl_x11_shows(const struct egl_x11_size *, int bits);

/* Make a picture with the size of the drawable; free it, and its connection with the drawable. Without shared
 * memory, pixels are sent with the requests. */
bool egl_x11_begin(const struct egl_x11 *, struct egl_x11_picture *, uint32_t drawable);
void egl_x11_end(const struct egl_x11 *, struct egl_x11_picture *);
/* Copies a part of the picture to the drawable. Returns false if it fails. With shared memory on the
 * program's connection it does not wait for the server: egl_x11_settle() does, and finds a failure. */
bool egl_x11_put(const struct egl_x11 *, struct egl_x11_picture *, unsigned x, unsigned y, unsigned width,
                 unsigned height);
/* Waits until the server has read the last put's pixels, which may not change before. Returns false if that
 * put has failed. */
bool egl_x11_settle(const struct egl_x11 *, struct egl_x11_picture *);
/* Request the drawable's size, and wait for the answer. It settles all puts before the request without
 * another one. Returns false if the drawable does not exist, or such a put has failed. */
void egl_x11_request_size(const struct egl_x11 *, struct egl_x11_picture *);
bool egl_x11_receive_size(const struct egl_x11 *, struct egl_x11_picture *, struct egl_x11_size *);
/* Copies the drawable to the picture. */
bool egl_x11_get(const struct egl_x11 *, struct egl_x11_picture *);

#endif
