/* Keys of the command line. */
#include "command/view/view_part.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

/* Prints a line of what is shown: for scripts. */
static void report(const struct view *view, const char *action)
{
    static const char *const modes[] = {
        [SHOW_PICTURE] = "picture", [SHOW_OVERDRAW] = "overdraw", [SHOW_TRIANGLES] = "triangles"};
    const struct scene_picture *picture = scene_picture(view->scene);
    size_t bytes = (size_t)view->show.width * view->show.height * sizeof *view->show.color;
    char lanes[VIEW_NAME_CAPACITY], draws[VIEW_NAME_CAPACITY];
    view_describe_lanes(view, lanes);
    view_describe_draws(view, draws);
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
        if (!strcmp(name, view_keys[i].action))
            return i;
    return -1;
}

/* The words of --keys. */
static const char *const words[] = {
#define KEY(action, label, code, meaning) #action,
#include "command/view/key.def"
#undef KEY
    "wait"};

const char *view_word_at(unsigned index)
{
    return index < sizeof words / sizeof *words ? words[index] : NULL;
}

int view_check_keys(const struct command *self, const char *list)
{
    char piece[VIEW_NAME_CAPACITY];
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
    int action = find_action(name);
    if (action >= 0)
        view_perform(view, (enum view_action)action);
    if (action < 0)
        usleep(VIEW_POLL_MS * 1000);
    if (action < 0)
        view_poll_files(view);
    view_draw(view);
    if (view_make(view))
        return STATUS_BAD;
    view_present(view);
    view_take_pending(view);
    report(view, name);
    return STATUS_OK;
}

int view_press_keys(struct view *view)
{
    char piece[VIEW_NAME_CAPACITY];
    int status = STATUS_OK;
    report(view, "begin");
    for (const char *next = option_next_item(view->settings->keys, piece, sizeof piece);
         next && !status && !view->done; next = option_next_item(next, piece, sizeof piece))
        status = press(view, piece);
    return status;
}
