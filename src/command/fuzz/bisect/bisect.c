/* A stream is played with an engine whose routines are pairs, one of each of the two engines. The first call
 * in whose outputs they differ is narrowed and examined. */
#include "command/fuzz/bisect/bisect.h"

#include "render/device/device.h"
#include "command/fuzz/bisect/hunt.h"
#include "engines/tiered/tiered.h"

#include <stdlib.h>
#include <string.h>

/* --- A routine that is two ------------------------------------------------------------------------------ */

struct pair {
    struct routine routine;
    struct routine *side[2];
};

/* A bisection. The routines of its engine `pair` find it in that engine's options. */
struct search {
    const struct engine *engine[2];
    struct engine pair; /* builds a routine with each of the two */
    const struct bisect_options *options;
    struct bisection *bisection;
    struct triptych_device *device;
    struct error *error;
    struct replay replay;
    uint8_t *image[2];
    bool watches; /* the draw is one of those that are looked at */
    bool found, failed;
};

static struct search *search_of(const struct pair *pair)
{
    return (struct search *)(uintptr_t)pair->routine.engine->options;
}

static void free_pair(struct code_arena *arena, struct routine *routine)
{
    struct pair *pair = (struct pair *)(void *)routine;
    for (int i = 0; i < 2; i++)
        if (pair->side[i])
            pair->side[i]->engine->free(arena, pair->side[i]);
    free(pair);
}

static int examine(struct search *search, const struct pair *pair);

static void forget_replay(struct search *search)
{
    replay_free(&search->replay);
    for (int i = 0; i < 2; i++) {
        free(search->image[i]);
        search->image[i] = NULL;
    }
}

/* Returns true if the two routines differ on the call, within the pixel or draw that the options select. */
static bool differs(struct search *search, const struct pair *pair, const void *call)
{
    const struct target *target = device_rendered_target(search->device);
    struct replay_target planes = {target->planes * target->samples, target->depth ? target->samples : 0};
    struct replay *replay = &search->replay;
    bool out_of_memory = replay_take(replay, pair->side[0], call, &planes) != 0;
    replay->pixel_x = search->options->x;
    replay->pixel_y = search->options->y;
    for (int i = 0; i < 2 && !out_of_memory; i++) {
        search->image[i] = replay_image(replay);
        out_of_memory = !search->image[i];
        if (!out_of_memory)
            replay_run(replay, pair->side[i], search->image[i]);
    }
    if (out_of_memory) {
        error_set(search->error, "out of memory for the call of a routine");
        search->failed = true;
        return false;
    }
    return replay_differs(replay, search->image[0], search->image[1], NULL);
}

static void run_pair(const void *call, const struct routine *routine)
{
    const struct pair *pair = (const struct pair *)(const void *)routine;
    struct search *search = search_of(pair);
    if (search->watches && !search->found && !search->failed) {
        if (differs(search, pair, call)) {
            search->found = true;
            search->failed = examine(search, pair) != 0;
        }
        forget_replay(search);
    }
    pair->side[0]->run(call, pair->side[0]);
}

static struct routine *build_pair(const struct engine *self, struct code_arena *arena, enum unit unit,
                                  const union key *key, struct error *error)
{
    struct pair *pair = calloc(1, sizeof *pair);
    if (!pair) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    pair->routine.engine = self;
    for (int i = 0; i < 2; i++) {
        pair->side[i] = engine_build(search_of(pair)->engine[i], arena, unit, key, error);
        if (!pair->side[i]) {
            free_pair(arena, &pair->routine);
            return NULL;
        }
        pair->routine.code_bytes += pair->side[i]->code_bytes;
    }
    pair->routine.run = run_pair;
    pair->routine.unit = unit;
    pair->routine.key = *key;
    return &pair->routine;
}

static const struct engine engine_pair = {
    .name = "pair",
    .description = "two engines together",
    .width = LANES_MAXIMUM,
    .build = build_pair,
    .free = free_pair,
};

/* --- The call ------------------------------------------------------------------------------------------- */

static void name_output(struct bisection *b, const struct replay *r, size_t at)
{
    static const struct {
        const char *name;
        int slot;
    } slots[] = {
        {"x", SLOT_X},
        {"y", SLOT_Y},
        {"z", SLOT_Z},
        {"w", SLOT_W},
        {"clip code", SLOT_CODE},
#define VARYING(name, components, text) {#name, SLOT_##name},
#include "def/state/varying.def"
#undef VARYING
        {"point size", SLOT_POINT_SIZE}
    };
    if (r->unit == UNIT_VERTEX) {
        int slot = (int)(at / VERTEX_SLOT_BYTES), i = 0;
        while (i + 1 < (int)(sizeof slots / sizeof *slots) && slots[i + 1].slot <= slot)
            i++;
        snprintf(b->output_name, sizeof b->output_name, "%s%+d", slots[i].name, slot - slots[i].slot);
        if (slot == slots[i].slot)
            snprintf(b->output_name, sizeof b->output_name, "%s", slots[i].name);
    } else if (r->unit == UNIT_BLIT) {
        snprintf(b->output_name, sizeof b->output_name, "word %zu", at / 4);
    } else if (r->unit == UNIT_SETUP) {
        snprintf(b->output_name, sizeof b->output_name, "byte %zu of the record", at % r->layout.stride);
    } else if (at < r->color_bytes) {
        snprintf(b->output_name, sizeof b->output_name, "colour plane %zu", at / TILE_PLANE_BYTES);
    } else if (at < r->output_bytes) {
        snprintf(b->output_name, sizeof b->output_name, "depth plane %zu",
                 (at - r->color_bytes) / TILE_PLANE_BYTES);
    } else {
        snprintf(b->output_name, sizeof b->output_name, "pixels passed");
    }
}

static void note_place(struct bisection *b, const struct replay *r, const struct replay_place *place)
{
    hunt_note_lane(b, r, place->element);
    memcpy(b->output, place->word, sizeof b->output);
    memcpy(b->value, place->word, sizeof b->value);
    name_output(b, r, place->at);
}

/* Runs the narrowed call with both and notes where they differ first. */
static int compare_call(struct hunt *hunt, struct error *error)
{
    uint8_t *image[2] = {replay_image(hunt->replay), replay_image(hunt->replay)};
    int result = image[0] && image[1] ? 0 : error_set(error, "out of memory for the call of a routine");
    for (int i = 0; i < 2 && !result; i++)
        replay_run(hunt->replay, hunt->routine[i], image[i]);
    if (!result && replay_differs(hunt->replay, image[0], image[1], &hunt->place))
        note_place(hunt->bisection, hunt->replay, &hunt->place);
    free(image[0]);
    free(image[1]);
    return result;
}

static int examine_narrowed(struct hunt *hunt, struct error *error)
{
    hunt->ir = ir_take(hunt->replay->unit, hunt->replay->key, error);
    hunt->interpreter = interpreter_create();
    int result = hunt->ir ? 0 : -1;
    if (!result && (!hunt->interpreter || replay_reserve(hunt->replay, probe_rows(hunt->ir))))
        result = error_set(error, "out of memory for the values of %u operations", hunt->ir->count);
    if (!result)
        result = hunt_operation(hunt, error);
    interpreter_free(hunt->interpreter);
    if (hunt->ir)
        ir_give(hunt->ir);
    return result;
}

static int examine(struct search *search, const struct pair *pair)
{
    struct bisection *b = search->bisection;
    struct replay *replay = &search->replay;
    struct hunt hunt = {.bisection = b,
                        .routine = {pair->side[0], pair->side[1]},
                        .replay = replay,
                        .arena = search->device->arena};
    b->outcome = BISECT_CALL;
    b->unit = replay->unit;
    key_print(replay->unit, replay->key, b->key);
    int narrowed = replay_narrow(replay, pair->side[0], pair->side[1]);
    if (narrowed < 0)
        return error_set(search->error, "out of memory for the call of a routine");
    if (compare_call(&hunt, search->error))
        return -1;
    if (!narrowed) {
        snprintf(b->reason, sizeof b->reason, "no single %s of the %u in the call makes the outputs differ",
                 replay->unit == UNIT_PIXEL ? "block" : "group of 16", replay->count);
        return 0;
    }
    return examine_narrowed(&hunt, search->error);
}

/* --- The stream ----------------------------------------------------------------------------------------- */

/* The stream with a frame for each draw, the last with the calls after it: `frames` has room for all of the
 * stream's calls and two more. */
static struct stream draw_by_draw(const struct stream *stream, uint32_t *frames)
{
    struct stream view = *stream;
    view.frames = frames;
    view.frame_count = 0;
    frames[0] = 0;
    for (uint32_t i = 0; i < stream->executed_count; i++)
        if (stream_draws_at(stream, i))
            frames[++view.frame_count] = i + 1;
    view.frame_count += !view.frame_count;
    frames[view.frame_count] = stream->executed_count;
    return view;
}

/* The frame, and the draw within it, of the last draw before a position of the stream. */
static void number_draw(const struct stream *stream, uint32_t position, struct bisection *b)
{
    while (position && !stream_draws_at(stream, --position))
        ;
    while (b->frame + 1 < stream->frame_count && stream->frames[b->frame + 1] <= position)
        b->frame++;
    for (uint32_t i = stream->frames[b->frame]; i < position; i++)
        b->draw_of_frame += stream_draws_at(stream, i);
}

/* Reads the picture as the other commands do, so that the routine that averages samples is called. */
static int read_picture(struct search *search, struct error *error)
{
    const struct target *target = device_rendered_target(search->device);
    size_t bytes = (size_t)target->width * target->height * sizeof(uint32_t);
    uint32_t *rgba = malloc(bytes);
    int result = rgba ? 0 : error_set(error, "out of memory for %zu pixels", bytes / sizeof *rgba);
    if (!result && device_read_target(search->device, 0, rgba, bytes, error) != TRIPTYCH_OK)
        result = -1;
    free(rgba);
    return result;
}

static int play(struct search *search, const struct stream *stream, struct stream *view, struct error *error)
{
    struct player *player;
    int result = stream_prepare(view, search->device, &player, error);
    for (uint32_t i = 0; i < view->frame_count && !result && !search->found && !search->failed; i++) {
        search->watches = search->options->draw < 0 || search->options->draw == i;
        if (search->options->progress)
            search->options->progress(i, view->frame_count);
        result = player_frame(player, i, error);
        if (!result && i + 1 == view->frame_count && device_rendered_target(search->device)->samples > 1)
            result = read_picture(search, error);
        if (search->found) {
            search->bisection->draw = i;
            number_draw(stream, view->frames[i + 1], search->bisection);
        }
    }
    player_free(player);
    return result || search->failed ? -1 : 0;
}

static int search_stream(struct search *search, const struct stream *stream, struct error *error)
{
    const struct device_options options = {.threads = 1};
    uint32_t *frames = malloc((stream->executed_count + 2) * sizeof *frames);
    if (!frames)
        return error_set(error, "out of memory for %u calls", stream->executed_count);
    struct stream view = draw_by_draw(stream, frames);
    search->pair = engine_pair;
    search->pair.options = search;
    search->pair.without_arena = search->engine[0]->without_arena && search->engine[1]->without_arena;
    int result = 0;
    if (search->options->draw >= (int64_t)view.frame_count)
        result = error_set(error, "there is no draw %u, the stream has %u", (unsigned)search->options->draw,
                           view.frame_count);
    else if (device_create(&search->pair, &options, &search->device, error))
        result = -1;
    if (!result) {
        result = play(search, stream, &view, error);
        device_destroy(search->device);
    }
    free(frames);
    return result;
}

static int refuse_tiers(const struct engine *engine, struct error *error)
{
    char names[ROUTINE_TIERS * 32] = "";
    for (unsigned i = 0; tiered_engine(engine, i); i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s",
                 !i                             ? ""
                 : tiered_engine(engine, i + 1) ? ", "
                                                : " and ",
                 tiered_engine(engine, i)->name);
    return error_set(error, "engine %s: its routines are those of %s, which can be bisected", engine->name,
                     names);
}

int bisect(const struct stream *stream, const struct engine *reference, const struct engine *other,
           const struct bisect_options *options, struct bisection *bisection, struct error *error)
{
    static const struct bisect_options any = {.draw = BISECT_ANY, .x = BISECT_ANY, .y = BISECT_ANY};
    struct search search = {.engine = {reference, other},
                            .options = options ? options : &any,
                            .bisection = bisection,
                            .error = error};
    *bisection = (struct bisection){.engine = {reference, other}};
    for (int i = 0; i < 2; i++) {
        const char *why =
            engine_unavailable(search.engine[i]); /* one call: the reason may change between two */
        if (why)
            return error_set(error, "engine %s: %s", search.engine[i]->name, why);
        if (tiered_engine(search.engine[i], 0))
            return refuse_tiers(search.engine[i], error);
    }
    return search_stream(&search, stream, error);
}
