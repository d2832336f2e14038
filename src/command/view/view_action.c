/* The state of the viewer, and what each key does. */
#include "base/clock.h"
#include "command/view/view_part.h"
#include "engines/list.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 800 /* a picture is enlarged up to this many pixels across */ };

static const float turn_step = 0.1f, move_step = 0.1f;

const struct view_key view_keys[ACTION_COUNT] = {
#define KEY(action, label, code, meaning) {#action, label, code, meaning},
#include "command/view/key.def"
#undef KEY
};

/* --- Engines -------------------------------------------------------------------------------------------- */

/* An engine's name without its number of lanes: of "specialize-8", "specialize". */
static const char *family_of(unsigned engine, char name[VIEW_NAME_CAPACITY])
{
    snprintf(name, VIEW_NAME_CAPACITY, "%s", triptych_engine_name(engine));
    char *dash = strrchr(name, '-');
    if (dash && dash[1] && !dash[1 + strspn(dash + 1, "0123456789")])
        *dash = 0;
    return name;
}

static bool is_related(unsigned a, unsigned b)
{
    char first[VIEW_NAME_CAPACITY], second[VIEW_NAME_CAPACITY];
    return !strcmp(family_of(a, first), family_of(b, second));
}

/* The next engine that can run here: of the same family, or the first of another one that runs without being
 * named. */
static unsigned next_engine(unsigned engine, bool related)
{
    unsigned count = 0;
    while (triptych_engine_name(count))
        count++;
    for (unsigned step = 1; step < count; step++) {
        unsigned i = (engine + step) % count;
        bool first = (!i || !is_related(i, i - 1)) && !engine_at(i)->on_request;
        if (!triptych_engine_unavailable(i) && (related ? is_related(i, engine) : first))
            return i;
    }
    return engine;
}

unsigned view_processors(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > VIEW_THREADS_MAXIMUM ? VIEW_THREADS_MAXIMUM : (unsigned)count;
}

/* --- Pictures ------------------------------------------------------------------------------------------- */

static void tell(struct view *view, const char *text)
{
    snprintf(view->message, sizeof view->message, "%s", text);
}

static unsigned zoom_of(const struct view *view)
{
    unsigned width = scene_picture(view->scene)->width, zoom = width ? SIDE / width : 1;
    if (view->settings->zoom)
        return view->settings->zoom;
    return zoom < 1 ? 1 : zoom > VIEW_ZOOM_MAXIMUM ? VIEW_ZOOM_MAXIMUM : zoom;
}

/* Draws the scene again if that is necessary. A failure is shown, and the last picture stays. */
void view_draw(struct view *view)
{
    struct error error = {""};
    if (view->stale && !scene_draw(view->scene, &view->choice, &error))
        view->recent[view->pictures++ % VIEW_RECENT] = scene_picture(view->scene)->ms;
    view->unobserved |= view->stale;
    view->stale = false;
    if (view->show.mode != SHOW_PICTURE && view->unobserved && !*error.text) {
        scene_analyse(view->scene, &view->choice, &error);
        view->unobserved = false;
    }
    if (*error.text)
        tell(view, error.text);
}

int view_make(struct view *view)
{
    struct error error = {""};
    view->text.lines = 0;
    view->show.zoom = zoom_of(view);
    view->show.text = view->with_text || view->with_help ? &view->text : NULL;
    view->show.message = view->message;
    if (view->with_text)
        view_describe(view);
    if (view->with_help)
        view_list_keys(view);
    if (scene_picture(view->scene)->width && !show_make(&view->show, view->scene, &error))
        return STATUS_OK;
    return tool_fail(view->self, "%s", *error.text ? error.text : view->message);
}

static void save_shot(struct view *view)
{
    struct error error = {""};
    char path[VIEW_PATH_CAPACITY];
    snprintf(path, sizeof path, "%s-%u.png", view->settings->shots, ++view->shots);
    view_draw(view); /* events before this one may have changed the scene */
    if (view_make(view))
        return;
    if (png_save(path, view->show.width, view->show.height, view->show.color, &error))
        tell(view, error.text);
    else
        snprintf(view->message, sizeof view->message, "saved %s", path);
}

/* --- Actions -------------------------------------------------------------------------------------------- */

static void reload(struct view *view)
{
    struct error error = {""};
    int bad = scene_reload(view->scene, &error);
    tell(view, bad ? error.text : "read again");
    if (bad)
        return;
    if (view->choice.frame >= scene_frames(view->scene))
        view->choice.frame = scene_frames(view->scene) - 1;
    view->stale = true;
}

void view_step_frame(struct view *view, uint32_t step)
{
    uint32_t frames = scene_frames(view->scene);
    view->choice.frame = (view->choice.frame + step) % frames;
    view->choice.draw = SCENE_ALL;
    view->stale = true;
}

static void step_draw(struct view *view, int step)
{
    uint32_t draws = scene_draws(view->scene, view->choice.frame);
    uint32_t now = view->choice.draw == SCENE_ALL ? draws - 1 : view->choice.draw;
    if (draws && step < 0 && now)
        view->choice.draw = now - 1;
    if (draws && step > 0)
        view->choice.draw = now + 1 < draws ? now + 1 : SCENE_ALL;
    view->stale = true;
}

void view_move_camera(struct view *view, float yaw, float pitch, float nearer)
{
    struct camera *camera = &view->choice.camera;
    camera->yaw += yaw;
    camera->pitch = fmaxf(-1.5f, fminf(1.5f, camera->pitch + pitch));
    camera->nearer = fmaxf(-3, fminf(3, camera->nearer + nearer));
    if (!scene_has_camera(view->scene))
        tell(view, "the stream has no transform of the view or the projection that could be turned");
    view->stale = true;
}

static void set_mode(struct view *view, enum show_mode mode)
{
    view->show.mode = view->show.mode == mode ? SHOW_PICTURE : mode;
}

static void change_engine(struct view *view, bool related)
{
    view->choice.engine = next_engine(view->choice.engine, related);
    view->pictures = 0;
    view->stale = true;
}

static void change_threads(struct view *view)
{
    view->choice.threads = view->choice.threads * 2 <= view_processors() ? view->choice.threads * 2 : 1;
    view->pictures = 0;
    view->stale = true;
}

void view_perform(struct view *view, enum view_action action)
{
    view->message[0] = 0;
    switch (action) {
    case ACTION_engine: change_engine(view, false); break;
    case ACTION_width: change_engine(view, true); break;
    case ACTION_threads: change_threads(view); break;
    case ACTION_left: view_move_camera(view, -turn_step, 0, 0); break;
    case ACTION_right: view_move_camera(view, turn_step, 0, 0); break;
    case ACTION_up: view_move_camera(view, 0, turn_step, 0); break;
    case ACTION_down: view_move_camera(view, 0, -turn_step, 0); break;
    case ACTION_nearer: view_move_camera(view, 0, 0, move_step); break;
    case ACTION_farther: view_move_camera(view, 0, 0, -move_step); break;
    case ACTION_home:
        view->choice.camera = (struct camera){0};
        view->stale = true;
        break;
    case ACTION_next_frame: view_step_frame(view, 1); break;
    case ACTION_previous_frame: view_step_frame(view, scene_frames(view->scene) - 1); break;
    case ACTION_play: view->playing = !view->playing; break;
    case ACTION_next_draw: step_draw(view, 1); break;
    case ACTION_previous_draw: step_draw(view, -1); break;
    case ACTION_all_draws:
        view->choice.draw = SCENE_ALL;
        view->stale = true;
        break;
    case ACTION_overdraw: set_mode(view, SHOW_OVERDRAW); break;
    case ACTION_triangles: set_mode(view, SHOW_TRIANGLES); break;
    case ACTION_tiles: view->show.tiles = !view->show.tiles; break;
    case ACTION_text: view->with_text = !view->with_text; break;
    case ACTION_help: view->with_help = !view->with_help; break;
    case ACTION_shot: save_shot(view); break;
    case ACTION_reload: reload(view); break;
    case ACTION_quit: view->done = true; break;
    case ACTION_COUNT: break;
    }
}

void view_poll_files(struct view *view)
{
    uint64_t now = clock_ns();
    if (now - view->polled < VIEW_POLL_MS * 1000000ull)
        return;
    view->polled = now;
    if (scene_has_changed(view->scene))
        reload(view);
}
