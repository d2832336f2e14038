/* `triptych view`: a window that shows a stream. */
#include "base/clock.h"
#include "command/support/choose.h"
#include "command/support/option.h"
#include "command/view/sdl.h"
#include "command/view/show.h"
#include "engines/list.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

enum {
    FRAME_MAXIMUM = 65535,
    THREADS_MAXIMUM = 256,
    WIDTH_MAXIMUM = 256,
    ZOOM_MAXIMUM = 16,
    SIDE = 800, /* a picture is enlarged up to this many pixels across */
    POLL_MS = 250,
    PATH_CAPACITY = 512,
    NAME_CAPACITY = 64,
    RECENT = 32
};

static const float turn_step = 0.1f, move_step = 0.1f, drag_step = 0.008f;

enum action {
#define KEY(action, label, code, meaning) ACTION_##action,
#include "command/view/key.def"
#undef KEY
    ACTION_COUNT
};

static const struct key_row {
    const char *action, *label;
    int32_t code;
    const char *meaning;
} keys[ACTION_COUNT] = {
#define KEY(action, label, code, meaning) {#action, label, code, meaning},
#include "command/view/key.def"
#undef KEY
};

struct settings {
    const char *engine, *keys, *shots;
    unsigned width, threads, frame, zoom;
    bool plain;
};

struct view {
    const struct command *self;
    const struct settings *settings;
    const char *path;
    struct scene *scene;
    struct scene_choice choice;
    struct show show;
    struct show_text text;
    char message[ERROR_CAPACITY + 16];
    bool with_text, with_help, playing, done;
    bool stale, unobserved;   /* the picture is to be drawn again; the analysis */
    int pointer_x, pointer_y; /* in the window; -1: unknown */
    double recent[RECENT];    /* milliseconds of the last pictures */
    unsigned pictures, shots;
    uint64_t polled; /* when files were last looked at, in nanoseconds */

    struct sdl sdl;
    sdl_window *window;
    int window_width, window_height;
};

/* --- Engines -------------------------------------------------------------------------------------------- */

/* An engine's name without its number of lanes: of "specialize-8", "specialize". */
static const char *family_of(unsigned engine, char name[NAME_CAPACITY])
{
    snprintf(name, NAME_CAPACITY, "%s", triptych_engine_name(engine));
    char *dash = strrchr(name, '-');
    if (dash && dash[1] && !dash[1 + strspn(dash + 1, "0123456789")])
        *dash = 0;
    return name;
}

static bool is_related(unsigned a, unsigned b)
{
    char first[NAME_CAPACITY], second[NAME_CAPACITY];
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

static unsigned processors(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > THREADS_MAXIMUM ? THREADS_MAXIMUM : (unsigned)count;
}

/* --- Text ----------------------------------------------------------------------------------------------- */

static void describe_lanes(const struct view *view, char text[NAME_CAPACITY])
{
    unsigned lanes = triptych_engine_width(view->choice.engine);
    if (lanes)
        snprintf(text, NAME_CAPACITY, "%u lanes", lanes);
    else
        snprintf(text, NAME_CAPACITY, "lanes by routine");
}

static void describe_draws(const struct view *view, char text[NAME_CAPACITY])
{
    uint32_t draws = scene_draws(view->scene, view->choice.frame);
    if (view->choice.draw == SCENE_ALL)
        snprintf(text, NAME_CAPACITY, "all of %u draw%s", draws, draws == 1 ? "" : "s");
    else
        snprintf(text, NAME_CAPACITY, "up to draw %u of %u", view->choice.draw, draws);
}

static double mean(const struct view *view)
{
    unsigned count = view->pictures < RECENT ? view->pictures : RECENT;
    double sum = 0;
    for (unsigned i = 0; i < count; i++)
        sum += view->recent[i];
    return count ? sum / count : 0;
}

static void describe_analysis(struct view *view)
{
    const struct scene_analysis *analysis = scene_analysis(view->scene);
    size_t pixels = (size_t)analysis->width * analysis->height, covered = 0;
    uint64_t sum = 0;
    uint32_t most = 0;
    for (size_t i = 0; i < pixels; i++) {
        covered += analysis->count[i] != 0;
        sum += analysis->count[i];
        most = analysis->count[i] > most ? analysis->count[i] : most;
    }
    show_line(&view->text, "overdraw: %.2f on average, at most %u",
              covered ? (double)sum / (double)covered : 0, most);
}

static void describe_pointer(struct view *view)
{
    const struct scene_picture *picture = scene_picture(view->scene);
    const struct scene_analysis *analysis = scene_analysis(view->scene);
    if (view->pointer_x < 0 || !view->window_width || !view->window_height)
        return;
    unsigned x = (unsigned)view->pointer_x * picture->width / (unsigned)view->window_width;
    unsigned y = (unsigned)view->pointer_y * picture->height / (unsigned)view->window_height;
    if (x >= picture->width || y >= picture->height)
        return;
    size_t pixel = (size_t)y * picture->width + x;
    uint32_t color = picture->color[pixel];
    show_line(&view->text, "pixel %u,%u: %u %u %u %u", x, y, color & 255, color >> 8 & 255, color >> 16 & 255,
              color >> 24);
    if (view->show.mode != SHOW_PICTURE && analysis->width == picture->width && analysis->owner[pixel].draw)
        show_line(&view->text, "  covered %u times, shows draw %u, primitive %u", analysis->count[pixel],
                  analysis->owner[pixel].draw - 1, analysis->owner[pixel].primitive);
}

static void describe(struct view *view)
{
    const struct scene_picture *picture = scene_picture(view->scene);
    unsigned columns = (picture->width + 63) / 64, rows = (picture->height + 63) / 64;
    char lanes[NAME_CAPACITY], draws[NAME_CAPACITY];
    describe_lanes(view, lanes);
    describe_draws(view, draws);
    show_line(&view->text, "%s, %s, %u thread%s", triptych_engine_name(view->choice.engine), lanes,
              view->choice.threads, view->choice.threads == 1 ? "" : "s");
    show_line(&view->text, "frame %u of %u, %s", view->choice.frame, scene_frames(view->scene), draws);
    show_line(&view->text, "%.2f ms, mean of %u: %.2f ms", picture->ms,
              view->pictures < RECENT ? view->pictures : RECENT, mean(view));
    show_line(&view->text, "%u routines, %.1f KiB of code", picture->routines,
              (double)picture->code_bytes / 1024);
    show_line(&view->text, "%llu primitives, %llu pixels, %u x %u tiles",
              (unsigned long long)picture->triangles, (unsigned long long)picture->pixels, columns, rows);
    if (view->show.mode != SHOW_PICTURE)
        describe_analysis(view);
    describe_pointer(view);
}

static void list_keys(struct view *view)
{
    for (int i = 0; i < ACTION_COUNT; i++)
        show_line(&view->text, "%s  %s", keys[i].label, keys[i].meaning);
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
    return zoom < 1 ? 1 : zoom > ZOOM_MAXIMUM ? ZOOM_MAXIMUM : zoom;
}

/* Draws the scene again if that is necessary. A failure is shown, and the last picture stays. */
static void draw(struct view *view)
{
    struct error error = {""};
    if (view->stale && !scene_draw(view->scene, &view->choice, &error))
        view->recent[view->pictures++ % RECENT] = scene_picture(view->scene)->ms;
    view->unobserved |= view->stale;
    view->stale = false;
    if (view->show.mode != SHOW_PICTURE && view->unobserved && !*error.text) {
        scene_analyse(view->scene, &view->choice, &error);
        view->unobserved = false;
    }
    if (*error.text)
        tell(view, error.text);
}

static int make(struct view *view)
{
    struct error error = {""};
    view->text.lines = 0;
    view->show.zoom = zoom_of(view);
    view->show.text = view->with_text || view->with_help ? &view->text : NULL;
    view->show.message = view->message;
    if (view->with_text)
        describe(view);
    if (view->with_help)
        list_keys(view);
    if (scene_picture(view->scene)->width && !show_make(&view->show, view->scene, &error))
        return STATUS_OK;
    return tool_fail(view->self, "%s", *error.text ? error.text : view->message);
}

static void save_shot(struct view *view)
{
    struct error error = {""};
    char path[PATH_CAPACITY];
    snprintf(path, sizeof path, "%s-%u.png", view->settings->shots, ++view->shots);
    if (make(view))
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

static void step_frame(struct view *view, uint32_t step)
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

static void move_camera(struct view *view, float yaw, float pitch, float nearer)
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
    view->choice.threads = view->choice.threads * 2 <= processors() ? view->choice.threads * 2 : 1;
    view->pictures = 0;
    view->stale = true;
}

static void perform(struct view *view, enum action action)
{
    view->message[0] = 0;
    switch (action) {
    case ACTION_engine: change_engine(view, false); break;
    case ACTION_width: change_engine(view, true); break;
    case ACTION_threads: change_threads(view); break;
    case ACTION_left: move_camera(view, -turn_step, 0, 0); break;
    case ACTION_right: move_camera(view, turn_step, 0, 0); break;
    case ACTION_up: move_camera(view, 0, turn_step, 0); break;
    case ACTION_down: move_camera(view, 0, -turn_step, 0); break;
    case ACTION_nearer: move_camera(view, 0, 0, move_step); break;
    case ACTION_farther: move_camera(view, 0, 0, -move_step); break;
    case ACTION_home:
        view->choice.camera = (struct camera){0};
        view->stale = true;
        break;
    case ACTION_next_frame: step_frame(view, 1); break;
    case ACTION_previous_frame: step_frame(view, scene_frames(view->scene) - 1); break;
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

static void poll_files(struct view *view)
{
    uint64_t now = clock_ns();
    if (now - view->polled < POLL_MS * 1000000ull)
        return;
    view->polled = now;
    if (scene_has_changed(view->scene))
        reload(view);
}

/* --- The window ----------------------------------------------------------------------------------------- */

static int open_window(struct view *view)
{
    struct error error = {""};
    const struct sdl *sdl = &view->sdl;
    char title[PATH_CAPACITY];
    if (sdl_load(&view->sdl, &error))
        return tool_fail(view->self, "%s", error.text);
    if (sdl->Init(SDL_VIDEO))
        return tool_fail(view->self, "SDL cannot open a display: %s", sdl->GetError());
    tool_path_stem(view->path, title, sizeof title);
    view->window = sdl->CreateWindow(title, SDL_UNDEFINED, SDL_UNDEFINED, (int)view->show.width,
                                     (int)view->show.height, SDL_RESIZABLE);
    return view->window ? STATUS_OK : tool_fail(view->self, "SDL cannot open a window: %s", sdl->GetError());
}

static void close_window(struct view *view)
{
    if (view->window)
        view->sdl.DestroyWindow(view->window);
    if (view->sdl.library)
        view->sdl.Quit();
    sdl_unload(&view->sdl);
}

static void present(struct view *view)
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
            if (event->key.key == keys[i].code)
                perform(view, (enum action)i);
        break;
    case SDL_EVENT_MOTION:
        view->pointer_x = event->motion.x;
        view->pointer_y = event->motion.y;
        if (event->motion.buttons & SDL_LEFT_BUTTON)
            move_camera(view, drag_step * (float)event->motion.dx, drag_step * (float)event->motion.dy, 0);
        break;
    case SDL_EVENT_WHEEL: move_camera(view, 0, 0, move_step * (float)event->wheel.y); break;
    default: break;
    }
}

static void take_events(struct view *view)
{
    union sdl_event event;
    if (!view->sdl.WaitEventTimeout(&event, view->playing || view->stale ? 1 : POLL_MS))
        return;
    do
        take_event(view, &event);
    while (view->sdl.PollEvent(&event));
}

static int show_window(struct view *view)
{
    while (!view->done) {
        if (make(view))
            return STATUS_BAD;
        present(view);
        take_events(view);
        poll_files(view);
        if (view->playing)
            step_frame(view, 1);
        draw(view);
    }
    return STATUS_OK;
}

/* --- Keys of the command line --------------------------------------------------------------------------- */

/* Prints a line of what is shown: for scripts. */
static void report(const struct view *view, const char *action)
{
    static const char *const modes[] = {
        [SHOW_PICTURE] = "picture", [SHOW_OVERDRAW] = "overdraw", [SHOW_TRIANGLES] = "triangles"};
    const struct scene_picture *picture = scene_picture(view->scene);
    size_t bytes = (size_t)view->show.width * view->show.height * sizeof *view->show.color;
    char lanes[NAME_CAPACITY], draws[NAME_CAPACITY];
    describe_lanes(view, lanes);
    describe_draws(view, draws);
    printf("%s: %s, %s, %u threads, frame %u, %s, %s of %ux%u, hash %016llx%s%s\n", action,
           triptych_engine_name(view->choice.engine), lanes, view->choice.threads, view->choice.frame, draws,
           modes[view->show.mode], picture->width, picture->height,
           (unsigned long long)XXH3_64bits(view->show.color, bytes), *view->message ? ": " : "",
           view->message);
    fflush(stdout);
}

static int find_action(const char *name)
{
    for (int i = 0; i < ACTION_COUNT; i++)
        if (!strcmp(name, keys[i].action))
            return i;
    return -1;
}

/* The words of --keys. */
static const char *const words[] = {
#define KEY(action, label, code, meaning) #action,
#include "command/view/key.def"
#undef KEY
    "wait"};

static const char *word_at(unsigned index)
{
    return index < sizeof words / sizeof *words ? words[index] : NULL;
}

static int check_keys(const struct command *self, const char *list)
{
    char piece[NAME_CAPACITY];
    unsigned found;
    for (const char *next = option_next_item(list, piece, sizeof piece); next;
         next = option_next_item(next, piece, sizeof piece))
        if (!words_find(WORDS_OF_ROWS(words), piece, strlen(piece), &found))
            return tool_fail_word(self, "--keys has", piece, WORDS_OF_ROWS(words));
    return STATUS_OK;
}

/* Performs an action, or looks at the files, and shows the result. */
static int press(struct view *view, const char *name)
{
    union sdl_event event;
    int action = find_action(name);
    if (action >= 0)
        perform(view, (enum action)action);
    if (action < 0)
        usleep(POLL_MS * 1000);
    if (action < 0)
        poll_files(view);
    draw(view);
    if (make(view))
        return STATUS_BAD;
    present(view);
    while (view->sdl.PollEvent(&event))
        take_event(view, &event);
    report(view, name);
    return STATUS_OK;
}

static int press_keys(struct view *view)
{
    char piece[NAME_CAPACITY];
    int status = STATUS_OK;
    report(view, "begin");
    for (const char *next = option_next_item(view->settings->keys, piece, sizeof piece);
         next && !status && !view->done; next = option_next_item(next, piece, sizeof piece))
        status = press(view, piece);
    return status;
}

/* --- The command ---------------------------------------------------------------------------------------- */

static int show_scene(struct view *view)
{
    draw(view);
    int status = make(view);
    if (!status)
        status = open_window(view);
    if (!status)
        present(view);
    if (!status)
        status = view->settings->keys ? press_keys(view) : show_window(view);
    close_window(view);
    return status;
}

static int view_stream(const struct command *self, const struct settings *settings, const char *path,
                       unsigned engine)
{
    struct error error = {""};
    struct view view = {.self = self,
                        .settings = settings,
                        .path = path,
                        .scene = scene_open(path, &error),
                        .choice = {.engine = engine,
                                   .threads = settings->threads ? settings->threads : processors(),
                                   .frame = settings->frame,
                                   .draw = SCENE_ALL},
                        .with_text = !settings->plain,
                        .stale = true,
                        .pointer_x = -1,
                        .polled = clock_ns()};
    int status = STATUS_OK;
    if (!view.scene)
        status = tool_fail(self, "%s", error.text);
    else if (settings->frame >= scene_frames(view.scene))
        status = tool_fail(self, "%s has no frame %u, its last is %u", path, settings->frame,
                           scene_frames(view.scene) - 1);
    if (!status)
        status = show_scene(&view);
    free(view.show.color);
    scene_close(view.scene);
    return status;
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    unsigned engine;
    if (choose_engine(self, settings->engine, settings->width, &engine) ||
        (settings->keys && check_keys(self, settings->keys)))
        return STATUS_BAD;
    return view_stream(self, settings, operands->value[0], engine);
}

static const struct settings defaults = {.engine = "specialize", .shots = "view"};

static const struct option options[] = {
    {"engine", "NAME", "engine (triptych list engines); specialize", OPTION_IS_WORD(struct settings, engine),
     .words = triptych_engine_name},
    {"width", "LANES", "lanes of the engine's variant", OPTION_IS_NUMBER(struct settings, width), .least = 1,
     .most = WIDTH_MAXIMUM},
    {"threads", "N", "rendering threads; one per core", OPTION_IS_NUMBER(struct settings, threads),
     .least = 1, .most = THREADS_MAXIMUM},
    {"frame", "N", "the first frame to show, from 0; 0", OPTION_IS_NUMBER(struct settings, frame),
     .most = FRAME_MAXIMUM},
    {"zoom", "N", "enlarge each pixel N times; as often as fits into 800 pixels",
     OPTION_IS_NUMBER(struct settings, zoom), .least = 1, .most = ZOOM_MAXIMUM},
    {"plain", NULL, "begin without text on the picture", OPTION_IS_FLAG(struct settings, plain)},
    {"shots", "PREFIX", "begin the names of saved pictures with PREFIX: PREFIX-1.png; view",
     OPTION_IS_TEXT(struct settings, shots)},
    {"keys", "LIST", "perform these actions, print a line for each, and quit",
     OPTION_IS_LIST(struct settings, keys), .words = word_at},
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream", .kind = OPERAND_INPUT, .extension = "tri trib"},
    {0},
};

static const char notes[] = "The window needs SDL 2, which is loaded when the command runs. The mouse turns "
                            "the camera, its wheel moves\n"
                            "it. When a file of the stream changes, it is read again. Keys, with their "
                            "actions as words of --keys (which\n"
                            "also has wait):"
#define KEY(action, label, code, meaning) "\n" label "  " meaning " (" #action ")"
#include "command/view/key.def"
#undef KEY
    ;

const struct command command_view = {
    .name = "view",
    .summary = "show a stream in a window, with any engine, frame by frame and draw by draw",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
