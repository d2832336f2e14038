/* SDL 2, loaded when it is needed: the command neither links it nor needs its headers.
 *
 * The structures, numbers and functions are those of SDL's stable binary interface, from SDL 2.0.5 on
 * (SDL_events.h, SDL_keycode.h, SDL_pixels.h, SDL_video.h). */
#ifndef COMMAND_VIEW_SDL_H
#define COMMAND_VIEW_SDL_H

#include "base/error.h"

#include <stdint.h>

typedef struct sdl_window sdl_window;
typedef struct sdl_surface sdl_surface;

struct sdl_rectangle {
    int x, y, w, h;
};

enum {
    SDL_VIDEO = 0x20,               /* SDL_INIT_VIDEO */
    SDL_UNDEFINED = 0x1fff0000,     /* SDL_WINDOWPOS_UNDEFINED */
    SDL_RESIZABLE = 0x20,           /* SDL_WINDOW_RESIZABLE */
    SDL_RGBA8 = 0x16762004,         /* SDL_PIXELFORMAT_ABGR8888: red in the low byte */
    SDL_EVENT_QUIT = 0x100,         /* SDL_QUIT */
    SDL_EVENT_WINDOW = 0x200,       /* SDL_WINDOWEVENT */
    SDL_EVENT_KEY = 0x300,          /* SDL_KEYDOWN */
    SDL_EVENT_MOTION = 0x400,       /* SDL_MOUSEMOTION */
    SDL_EVENT_WHEEL = 0x403,        /* SDL_MOUSEWHEEL */
    SDL_LEFT_BUTTON = 1,            /* SDL_BUTTON_LMASK */
    SDL_SHIFT = 3,                  /* KMOD_SHIFT */
    SDL_KEY_RIGHT = 79 | 1 << 30,   /* SDLK_RIGHT */
    SDL_KEY_LEFT = 80 | 1 << 30,    /* SDLK_LEFT */
    SDL_KEY_DOWN = 81 | 1 << 30,    /* SDLK_DOWN */
    SDL_KEY_UP = 82 | 1 << 30,      /* SDLK_UP */
    SDL_KEY_HOME = 74 | 1 << 30,    /* SDLK_HOME */
    SDL_KEY_PAGEUP = 75 | 1 << 30,  /* SDLK_PAGEUP */
    SDL_KEY_PAGEDOWN = 78 | 1 << 30 /* SDLK_PAGEDOWN */
};

union sdl_event {
    uint32_t type;
    struct {
        uint32_t type, timestamp, window;
        uint8_t state, repeat, reserved[2];
        int32_t scancode, key;
        uint16_t modifiers;
        uint32_t unused;
    } key;
    struct {
        uint32_t type, timestamp, window, which, buttons;
        int32_t x, y, dx, dy;
    } motion;
    struct {
        uint32_t type, timestamp, window, which;
        int32_t x, y;
    } wheel;
    uint8_t reserved[128];
};

struct sdl {
    void *library;
#define SDL(result, name, parameters) result(*name) parameters;
#include "command/view/sdl.def"
#undef SDL
};

/* Loads the library. Returns 0, or -1 with the reason: it is not installed, or it lacks a function. */
int sdl_load(struct sdl *sdl, struct error *error);
void sdl_unload(struct sdl *sdl);

#endif
