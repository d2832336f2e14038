/* The parts of the viewer: its state and actions (view_action.c), the text over the picture (view_text.c),
 * the window and its events (view_window.c), keys of the command line (view_keys.c), the command (view.c).
 *
 * Functions that return int return a status and print the reason of a failure. */
#ifndef COMMAND_VIEW_VIEW_PART_H
#define COMMAND_VIEW_VIEW_PART_H

#include "command/support/option.h"
#include "command/view/sdl.h"
#include "command/view/show.h"

enum {
    VIEW_THREADS_MAXIMUM = 256,
    VIEW_ZOOM_MAXIMUM = 16,
    VIEW_POLL_MS = 250, /* between two looks at files */
    VIEW_PATH_CAPACITY = 512,
    VIEW_NAME_CAPACITY = 64,
    VIEW_RECENT = 32
};

enum view_action {
#define KEY(action, label, code, meaning) ACTION_##action,
#include "command/view/key.def"
#undef KEY
    ACTION_COUNT
};

struct view_key {
    const char *action, *label;
    int32_t code; /* SDL's */
    const char *meaning;
};

extern const struct view_key view_keys[ACTION_COUNT];

/* The options of the command; 0: the default. */
struct view_settings {
    const char *engine, *keys, *shots;
    unsigned width, threads, frame, zoom;
    bool plain;
};

struct view {
    const struct command *self;
    const struct view_settings *settings;
    const char *path;
    struct scene *scene;
    struct scene_choice choice;
    struct show show;
    struct show_text text;
    char message[ERROR_CAPACITY + 16];
    bool with_text, with_help, playing, done;
    bool stale, unobserved;     /* the picture is to be drawn again; the analysis */
    int pointer_x, pointer_y;   /* in the window; -1: unknown */
    double recent[VIEW_RECENT]; /* milliseconds of the last pictures */
    unsigned pictures, shots;
    uint64_t polled; /* when files were last looked at, in nanoseconds */

    struct sdl sdl;
    sdl_window *window;
    int window_width, window_height;
};

/* --- State and actions ---------------------------------------------------------------------------------- */

/* The number of processors, at most VIEW_THREADS_MAXIMUM. */
unsigned view_processors(void);

/* Draws the scene again if that is necessary. A failure is shown, and the last picture stays. */
void view_draw(struct view *view);

/* Makes the contents of the window (show.h), with the text. */
int view_make(struct view *view);

void view_perform(struct view *view, enum view_action action);

/* Advances by a number of frames; after the last comes the first. */
void view_step_frame(struct view *view, uint32_t step);

/* Turns the camera by radians and moves it nearer (camera.h). */
void view_move_camera(struct view *view, float yaw, float pitch, float nearer);

/* Reads the stream again if a file of it has changed. Looks at most every VIEW_POLL_MS milliseconds. */
void view_poll_files(struct view *view);

/* --- Text ----------------------------------------------------------------------------------------------- */

void view_describe_lanes(const struct view *view, char text[VIEW_NAME_CAPACITY]);
void view_describe_draws(const struct view *view, char text[VIEW_NAME_CAPACITY]);

/* Adds what is shown to the text over the picture. */
void view_describe(struct view *view);

/* Adds the keys to the text over the picture. */
void view_list_keys(struct view *view);

/* --- The window ----------------------------------------------------------------------------------------- */

/* Opens a window of the size of its contents. view_close_window must be called even after a failure. */
int view_open_window(struct view *view);
void view_close_window(struct view *view);

/* Copies the contents to the window. */
void view_present(struct view *view);

/* Performs the pending events, if there are any. */
void view_take_pending(struct view *view);

/* Shows the window and performs its events until the user closes it. */
int view_show_window(struct view *view);

/* --- Keys of the command line --------------------------------------------------------------------------- */

/* The words of --keys: actions, and wait. Null after the last. */
const char *view_word_at(unsigned index);

/* Checks the words of a list. */
int view_check_keys(const struct command *self, const char *list);

/* Performs the actions of --keys and prints a line for each: for scripts. */
int view_press_keys(struct view *view);

#endif
