/* The text over the picture. */
#include "command/view/view_part.h"

#include <stdio.h>

void view_describe_lanes(const struct view *view, char text[VIEW_NAME_CAPACITY])
{
    unsigned lanes = triptych_engine_width(view->choice.engine);
    if (lanes)
        snprintf(text, VIEW_NAME_CAPACITY, "%u lanes", lanes);
    else
        snprintf(text, VIEW_NAME_CAPACITY, "lanes by routine");
}

void view_describe_draws(const struct view *view, char text[VIEW_NAME_CAPACITY])
{
    uint32_t draws = scene_draws(view->scene, view->choice.frame);
    if (view->choice.draw == SCENE_ALL)
        snprintf(text, VIEW_NAME_CAPACITY, "all of %u draw%s", draws, draws == 1 ? "" : "s");
    else
        snprintf(text, VIEW_NAME_CAPACITY, "up to draw %u of %u", view->choice.draw, draws);
}

static double mean(const struct view *view)
{
    unsigned count = view->pictures < VIEW_RECENT ? view->pictures : VIEW_RECENT;
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
    const unsigned row = picture->lower ? picture->height - 1 - y : y;
    show_line(&view->text, "pixel %u,%u: %u %u %u %u", x, row, color & 255, color >> 8 & 255,
              color >> 16 & 255, color >> 24);
    if (view->show.mode != SHOW_PICTURE && analysis->width == picture->width && analysis->owner[pixel].draw)
        show_line(&view->text, "  covered %u times, shows draw %u, primitive %u", analysis->count[pixel],
                  analysis->owner[pixel].draw - 1, analysis->owner[pixel].primitive);
}

void view_describe(struct view *view)
{
    const struct scene_picture *picture = scene_picture(view->scene);
    unsigned columns = (picture->width + 63) / 64, rows = (picture->height + 63) / 64;
    char lanes[VIEW_NAME_CAPACITY], draws[VIEW_NAME_CAPACITY];
    view_describe_lanes(view, lanes);
    view_describe_draws(view, draws);
    show_line(&view->text, "%s, %s, %u thread%s", triptych_engine_name(view->choice.engine), lanes,
              view->choice.threads, view->choice.threads == 1 ? "" : "s");
    show_line(&view->text, "frame %u of %u, %s", view->choice.frame, scene_frames(view->scene), draws);
    show_line(&view->text, "%.2f ms, mean of %u: %.2f ms", picture->ms,
              view->pictures < VIEW_RECENT ? view->pictures : VIEW_RECENT, mean(view));
    show_line(&view->text, "%u routines, %.1f KiB of code", picture->routines,
              (double)picture->code_bytes / 1024);
    show_line(&view->text, "%llu primitives, %llu pixels, %u x %u tiles",
              (unsigned long long)picture->triangles, (unsigned long long)picture->pixels, columns, rows);
    if (view->show.mode != SHOW_PICTURE)
        describe_analysis(view);
    describe_pointer(view);
}

void view_list_keys(struct view *view)
{
    for (int i = 0; i < ACTION_COUNT; i++)
        show_line(&view->text, "%s  %s", view_keys[i].label, view_keys[i].meaning);
}
