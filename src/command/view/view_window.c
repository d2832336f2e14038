/* The window and its events. */
#include "command/view/view_part.h"

#include <stdlib.h>
#include <string.h>

static const float drag_step = 0.008f, wheel_step = 0.1f;

/* Without a display, SDL chooses a driver whose windows exist only in memory. */
static bool is_invisible(const char *driver)
{
    return driver && (!strcmp(driver, "offscreen") || !strcmp(driver, "dummy"));
}

/* Without one, libraries that SDL loads print lines of their own. */
static bool has_display(void)
{
    static const char *const names[] = {"DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (getenv(names[i]) && *getenv(names[i]))
            return true;
    return false;
}

int view_open_window(struct view *view)
{
    struct error error = {""};
    if (!view->settings->keys && !has_display())
        return tool_fail(view->self,
                         "no display for a window, expected DISPLAY or WAYLAND_DISPLAY, or --keys");
    const struct sdl *sdl = &view->sdl;
    char title[VIEW_PATH_CAPACITY];
    if (sdl_load(&view->sdl, &error))
        return tool_fail(view->self, "%s", error.text);
    if (sdl->Init(SDL_VIDEO))
        return tool_fail(view->self, "SDL cannot open a display: %s", sdl->GetError());
    if (!view->settings->keys && is_invisible(sdl->GetCurrentVideoDriver()))
        return tool_fail(view->self, "no display for a window (SDL's driver is %s), expected one, or --keys",
                         sdl->GetCurrentVideoDriver());
    tool_path_stem(view->path, title, sizeof title);
    view->window = sdl->CreateWindow(title, SDL_UNDEFINED, SDL_UNDEFINED, (int)view->show.width,
                                     (int)view->show.height, SDL_RESIZABLE);
    return view->window ? STATUS_OK : tool_fail(view->self, "SDL cannot open a window: %s", sdl->GetError());
}

void view_close_window(struct view *view)
{
    if (view->window)
        view->sdl.DestroyWindow(view->window);
    if (view->sdl.library)
        view->sdl.Quit();
    sdl_unload(&view->sdl);
}

void view_present(struct view *view)
{
    const struct sdl *sdl = &view->sdl;
    struct show *show = &view->show;
    sdl->GetWindowSize(view->window, &view->window_width, &view->window_height);
    sdl_surface *surface = sdl->GetWindowSurface(view->window);
    sdl_surface *picture = sdl->CreateRGBSurfaceWithFormatFrom(
        show->color, (int)show->width, (int)show->height, 32, (int)show->width * 4, SDL_RGBA8);
    if (surface && picture) {
        sdl->SetSurfaceBlendMode(picture, 0);
        sdl->UpperBlitScaled(picture, NULL, surface, NULL);
        sdl->UpdateWindowSurface(view->window);
    }
    if (picture)
        sdl->FreeSurface(picture);
}

static void take_event(struct view *view, const union sdl_event *event)
{
    switch (event->type) {
    case SDL_EVENT_QUIT: view->done = true; break;
    case SDL_EVENT_KEY:
        for (int i = 0; i < ACTION_COUNT; i++)
            if (event->key.key == view_keys[i].code)
                view_perform(view, (enum view_action)i);
        break;
    case SDL_EVENT_MOTION:
        view->pointer_x = event->motion.x;
        view->pointer_y = event->motion.y;
        if (event->motion.buttons & SDL_LEFT_BUTTON)
            view_move_camera(view, drag_step * (float)event->motion.dx, drag_step * (float)event->motion.dy,
                             0);
        break;
    case SDL_EVENT_WHEEL: view_move_camera(view, 0, 0, wheel_step * (float)event->wheel.y); break;
    default: break;
    }
}

void view_take_pending(struct view *view)
{
    union sdl_event event;
    while (view->sdl.PollEvent(&event))
        take_event(view, &event);
}

/* Waits for an event. */
static void take_events(struct view *view)
{
    union sdl_event event;
    if (!view->sdl.WaitEventTimeout(&event, view->playing || view->stale ? 1 : VIEW_POLL_MS))
        return;
    take_event(view, &event);
    view_take_pending(view);
}

int view_show_window(struct view *view)
{
    while (!view->done) {
        if (view_make(view))
            return STATUS_BAD;
        view_present(view);
        take_events(view);
        view_poll_files(view);
        if (view->playing)
            view_step_frame(view, 1);
        view_draw(view);
    }
    return STATUS_OK;
}
