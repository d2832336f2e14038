/* `triptych view`: a window that shows a stream. */
#include "base/clock.h"
#include "command/support/choose.h"
#include "command/view/view_part.h"

#include <stdlib.h>

enum { FRAME_MAXIMUM = 65535, WIDTH_MAXIMUM = 256 };

static int show_scene(struct view *view)
{
    view_draw(view);
    int status = view_make(view);
    if (!status)
        status = view_open_window(view);
    if (!status)
        view_present(view);
    if (!status)
        status = view->settings->keys ? view_press_keys(view) : view_show_window(view);
    view_close_window(view);
    return status;
}

static int view_stream(const struct command *self, const struct view_settings *settings, const char *path,
                       unsigned engine)
{
    struct error error = {""};
    struct view view = {.self = self,
                        .settings = settings,
                        .path = path,
                        .scene = scene_open(path, &error),
                        .choice = {.engine = engine,
                                   .threads = settings->threads ? settings->threads : view_processors(),
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
    const struct view_settings *settings = data;
    unsigned engine;
    if (choose_engine(self, settings->engine, settings->width, &engine) ||
        (settings->keys && view_check_keys(self, settings->keys)))
        return STATUS_BAD;
    return view_stream(self, settings, operands->value[0], engine);
}

static const struct view_settings defaults = {.engine = "specialize", .shots = "view"};

static const struct option options[] = {
    {"engine", "NAME", "engine (triptych list engines); specialize",
     OPTION_IS_WORD(struct view_settings, engine), .words = triptych_engine_name, .suffixed = true},
    {"width", "LANES", "lanes of the engine's variant", OPTION_IS_NUMBER(struct view_settings, width),
     .least = 1, .most = WIDTH_MAXIMUM},
    {"threads", "N", "rendering threads; one per core", OPTION_IS_NUMBER(struct view_settings, threads),
     .least = 1, .most = VIEW_THREADS_MAXIMUM},
    {"frame", "N", "the first frame to show, from 0; 0", OPTION_IS_NUMBER(struct view_settings, frame),
     .most = FRAME_MAXIMUM},
    {"zoom", "N", "enlarge each pixel N times; as often as fits into 800 pixels",
     OPTION_IS_NUMBER(struct view_settings, zoom), .least = 1, .most = VIEW_ZOOM_MAXIMUM},
    {"plain", NULL, "begin without text on the picture", OPTION_IS_FLAG(struct view_settings, plain)},
    {"shots", "PREFIX", "begin the names of saved pictures with PREFIX: PREFIX-1.png; view",
     OPTION_IS_TEXT(struct view_settings, shots)},
    {"keys", "LIST", "perform these actions, print a line for each, and quit",
     OPTION_IS_LIST(struct view_settings, keys), .words = view_word_at},
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
