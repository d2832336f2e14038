#include "command/inspect/trail.h"

#include <stdlib.h>
#include <string.h>

enum { CANVASES_MAXIMUM = 256 };

static const struct call *call_at(const struct stream *stream, uint32_t position)
{
    return &stream->calls[stream->executed[position]];
}

/* --- The view ------------------------------------------------------------------------------------------- */

/* Returns true if the call may change pixels, or what draws go to. */
static bool stops(const struct call *call)
{
    return stream_is_draw(call) ||
           call_row(call->type)->traits & (CALL_USES_TARGET | CALL_DRAWS | CALL_CHANGES);
}

/* The frames of the view. The first has all calls before the frame, the second is empty: playing it brings
 * the device into the state in which the frame begins. Then follows one up to each call that stops, and no
 * further than the draw. Returns the number of positions. */
static uint32_t list_stops(const struct stream *stream, const struct trail_options *options, uint32_t *frames)
{
    uint32_t count = 0, draws = 0;
    frames[count++] = 0;
    frames[count++] = stream->frames[options->frame];
    frames[count++] = stream->frames[options->frame];
    for (uint32_t i = stream->frames[options->frame]; i < stream->frames[options->frame + 1]; i++) {
        if (!stops(call_at(stream, i)))
            continue;
        frames[count++] = i + 1;
        if (stream_is_draw(call_at(stream, i)) && draws++ == options->draw)
            break;
    }
    return count;
}

static int make_view(struct trail *trail, struct error *error)
{
    const struct stream *stream = trail->stream;
    struct trail_options *options = &trail->options;
    if (options->frame >= stream->frame_count)
        return error_set(error, "%s has no frame %u, its last is %u", stream->path, options->frame,
                         stream->frame_count - 1);
    for (uint32_t i = stream->frames[options->frame]; i < stream->frames[options->frame + 1]; i++)
        trail->frame_draws += stream_is_draw(call_at(stream, i));
    if (options->draw == TRAIL_LAST && trail->frame_draws)
        options->draw = trail->frame_draws - 1;
    if (options->draw >= trail->frame_draws)
        return error_set(error, "%s: frame %u has no draw %u, it has %u, from 0", stream->path,
                         options->frame, options->draw == TRAIL_LAST ? 0 : options->draw, trail->frame_draws);
    trail->view = *stream;
    trail->view.frames = malloc((stream->executed_count + 4) * sizeof *trail->view.frames);
    if (!trail->view.frames)
        return error_set(error, "out of memory for %u calls", stream->executed_count);
    trail->view.frame_count = list_stops(stream, options, trail->view.frames) - 1;
    return 0;
}

/* --- Canvases ------------------------------------------------------------------------------------------- */

/* The current canvas, without its pixels. */
static struct trail_canvas current(const struct trail *trail)
{
    const struct triptych_target_surfaces *surfaces = device_drawn_surfaces(trail->device);
    const struct target *target = device_target(trail->device);
    struct trail_canvas r = {.width = target->width, .height = target->height};
    if (surfaces)
        r.surfaces = *surfaces;
    else
        r.generation = trail->generation;
    return r;
}

static bool same_surface(const struct triptych_surface *a, const struct triptych_surface *b)
{
    return a->texture == b->texture && a->image == b->image && a->level == b->level && a->slice == b->slice;
}

static bool same_canvas(const struct trail_canvas *a, const struct trail_canvas *b)
{
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        if (!same_surface(&a->surfaces.color[t], &b->surfaces.color[t]))
            return false;
    return same_surface(&a->surfaces.depth, &b->surfaces.depth) && a->generation == b->generation;
}

static bool has_pixel(const struct trail *trail, const struct trail_canvas *canvas)
{
    return trail->options.x >= 0 && (uint32_t)trail->options.x < canvas->width &&
           (uint32_t)trail->options.y < canvas->height;
}

static void read_now(const struct trail *trail, struct pixel_words *words)
{
    device_finish_target(trail->device);
    pixel_read(device_target(trail->device), (uint32_t)trail->options.x, (uint32_t)trail->options.y, words);
}

static int allocate(const struct trail *trail, struct trail_canvas *canvas)
{
    size_t pixels = (size_t)canvas->width * canvas->height;
    if (trail->options.counts)
        canvas->count = calloc(pixels, sizeof *canvas->count);
    if (trail->options.owners)
        canvas->owner = calloc(pixels, sizeof *canvas->owner);
    return (trail->options.counts && !canvas->count) || (trail->options.owners && !canvas->owner) ? -1 : 0;
}

/* The number of the current canvas, which may be new; -1 if there is no room for it. */
static int64_t find_canvas(struct trail *trail, struct error *error)
{
    struct trail_canvas now = current(trail), *found = trail->canvas;
    for (uint32_t i = 0; i < trail->canvases; i++, found++)
        if (same_canvas(found, &now))
            return i;
    if (trail->canvases == CANVASES_MAXIMUM)
        return error_set(error, "the frame draws to more than %d targets", CANVASES_MAXIMUM);
    *found = now;
    trail->canvases++;
    if (allocate(trail, found))
        return error_set(error, "out of memory for %u x %u pixels", now.width, now.height);
    if (has_pixel(trail, found))
        read_now(trail, &found->last);
    return found - trail->canvas;
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

/* The words of the canvas's pixel before the call are those after the last one. */
static int add_event(struct trail *trail, uint32_t position, uint32_t canvas, uint32_t draw,
                     struct error *error)
{
    struct trail_event *larger = realloc(trail->event, (trail->events + 1) * sizeof *larger);
    if (!larger)
        return error_set(error, "out of memory for %u events", trail->events + 1);
    trail->event = larger;
    struct trail_event *event = trail->event + trail->events++;
    *event = (struct trail_event){.position = position,
                                  .canvas = canvas,
                                  .draw = draw,
                                  .before = trail->canvas[canvas].last,
                                  .touch = trail->touches};
    read_now(trail, &event->after);
    trail->canvas[canvas].last = event->after;
    return 0;
}

static int take_touches(struct trail *trail, struct error *error)
{
    uint32_t count;
    const struct touch *touch = watch_touches(trail->watch, &count);
    struct touch *larger = realloc(trail->touch, (trail->touches + count + 1) * sizeof *larger);
    if (!larger)
        return error_set(error, "out of memory for %u primitives", count);
    trail->touch = larger;
    if (count)
        memcpy(trail->touch + trail->touches, touch, count * sizeof *touch);
    trail->touches += count;
    trail->event[trail->events - 1].touches = count;
    return 0;
}

static int add_draw(struct trail *trail, uint32_t position, uint32_t canvas, struct error *error)
{
    uint32_t count;
    trail->draw[trail->draws++] = (struct trail_draw){position, canvas, watch_totals(trail->watch)};
    trail->incomplete |= watch_is_incomplete(trail->watch);
    if (watch_is_starved(trail->watch))
        return error_set(error, "out of memory for the primitives of a draw");
    watch_touches(trail->watch, &count);
    if (!count)
        return 0;
    return add_event(trail, position, canvas, trail->draws - 1, error) ? -1 : take_touches(trail, error);
}

static int add_other(struct trail *trail, uint32_t position, uint32_t canvas, struct error *error)
{
    struct pixel_words now;
    if (!has_pixel(trail, trail->canvas + canvas))
        return 0;
    read_now(trail, &now);
    if (!memcmp(&now, &trail->canvas[canvas].last, sizeof now))
        return 0;
    return add_event(trail, position, canvas, TRAIL_LAST, error);
}

/* After a clear of colours no primitive is seen. */
static void disown(struct trail_canvas *canvas)
{
    if (canvas->owner)
        memset(canvas->owner, 0, (size_t)canvas->width * canvas->height * sizeof *canvas->owner);
}

/* Plays frame `i` of the view, whose last call is the only one that may change pixels. */
static int play(struct trail *trail, uint32_t i, struct error *error)
{
    uint32_t position = trail->view.frames[i + 1] - 1;
    const struct call *call = call_at(trail->stream, position);
    int64_t before = device_target(trail->device)->width ? find_canvas(trail, error) : 0;
    if (before < 0)
        return -1;
    watch_begin(trail->watch, trail->draws);
    watch_count(trail->watch, trail->canvases ? trail->canvas[before].count : NULL, trail->options.what);
    watch_owners(trail->watch, trail->canvases ? trail->canvas[before].owner : NULL);
    if (player_frame(trail->player, i, error))
        return -1;
    trail->generation += call->type == CALL_TARGET;
    if (!device_target(trail->device)->width)
        return 0;
    int64_t canvas = find_canvas(trail, error);
    if (canvas < 0)
        return -1;
    const struct call_clear *clear = call_clear_values(call);
    if (clear && clear->flags & TRIPTYCH_CLEAR_COLOR)
        disown(trail->canvas + canvas);
    return stream_is_draw(call) ? add_draw(trail, position, (uint32_t)canvas, error)
                                : add_other(trail, position, (uint32_t)canvas, error);
}

static int prepare(struct trail *trail, struct error *error)
{
    if (make_view(trail, error))
        return -1;
    trail->watch = watch_create();
    trail->canvas = calloc(CANVASES_MAXIMUM, sizeof *trail->canvas);
    trail->draw = calloc(trail->options.draw + 1, sizeof *trail->draw);
    if (!trail->watch || !trail->canvas || !trail->draw)
        return error_set(error, "out of memory for %u draws", trail->options.draw + 1);
    trail->device = watch_device(trail->watch, &trail->options.settings, error);
    if (!trail->device || stream_prepare(&trail->view, trail->device, &trail->player, error))
        return -1;
    watch_pixel(trail->watch, trail->options.x, trail->options.y);
    return 0;
}

int trail_open(struct trail *trail, const struct stream *stream, const struct trail_options *options,
               struct error *error)
{
    *trail = (struct trail){.stream = stream, .options = *options};
    if (prepare(trail, error))
        return -1;
    if (player_frame(trail->player, 1, error))
        return -1;
    for (uint32_t i = 2; i < trail->view.frame_count; i++)
        if (play(trail, i, error))
            return -1;
    return 0;
}

void trail_close(struct trail *trail)
{
    player_free(trail->player);
    if (trail->device)
        device_destroy(trail->device);
    watch_free(trail->watch);
    for (uint32_t i = 0; i < trail->canvases; i++) {
        free(trail->canvas[i].count);
        free(trail->canvas[i].owner);
    }
    free(trail->canvas);
    free(trail->draw);
    free(trail->event);
    free(trail->touch);
    free(trail->view.frames);
    *trail = (struct trail){0};
}
