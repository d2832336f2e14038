#include "command/view/scene.h"

#include "base/clock.h"
#include "command/support/session.h"
#include "image/rows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { VIEW_FRAMES = 3, PATH_CAPACITY = 4096 };

/* A file that the stream was read from. */
struct scene_file {
    char *path;
    struct timespec changed; /* zero: it did not exist */
    off_t bytes;
};

struct scene {
    char *path;
    struct stream *stream;
    struct camera_originals originals;
    struct scene_file *file;
    uint32_t files;

    /* The player of `view`, whose frames are: the calls before the frame, none, the calls up to the draw. */
    struct stream view;
    uint32_t frames[VIEW_FRAMES + 1];
    triptych_device *device;
    struct player *player;
    unsigned engine, threads; /* the device's */

    struct scene_picture picture;
    size_t capacity; /* of its colours */
    struct scene_analysis analysis;
};

/* --- Files ---------------------------------------------------------------------------------------------- */

static void look_at(struct scene_file *file)
{
    struct stat found;
    file->changed = (struct timespec){0};
    file->bytes = 0;
    if (stat(file->path, &found))
        return;
    file->changed = found.st_mtim;
    file->bytes = found.st_size;
}

/* Adds a file. Its path begins at the stream's folder unless it is absolute. */
static int add_file(struct scene *scene, const char *path, bool relative)
{
    char full[PATH_CAPACITY];
    const char *slash = strrchr(scene->path, '/');
    int folder = relative && path[0] != '/' && slash ? (int)(slash - scene->path) + 1 : 0;
    struct scene_file *larger = realloc(scene->file, (scene->files + 1) * sizeof *larger);
    if (!larger)
        return -1;
    scene->file = larger;
    snprintf(full, sizeof full, "%.*s%s", folder, scene->path, path);
    struct scene_file *file = scene->file + scene->files;
    file->path = strdup(full);
    if (!file->path)
        return -1;
    scene->files++;
    look_at(file);
    return 0;
}

static int list_files(struct scene *scene)
{
    int bad = add_file(scene, scene->path, false);
    for (uint32_t i = 0; i < scene->stream->resource_count && !bad; i++) {
        const struct resource *resource = &scene->stream->resources[i];
        if (resource->path)
            bad = add_file(scene, resource->path, true);
        for (int face = 0; resource->type == RESOURCE_TEXTURE && face < 6 && !bad; face++)
            if (resource->face_path[face])
                bad = add_file(scene, resource->face_path[face], true);
    }
    return bad;
}

static void forget_files(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->files; i++)
        free(scene->file[i].path);
    free(scene->file);
    scene->file = NULL;
    scene->files = 0;
}

bool scene_has_changed(struct scene *scene)
{
    bool changed = false;
    for (uint32_t i = 0; i < scene->files; i++) {
        struct scene_file before = scene->file[i];
        look_at(scene->file + i);
        changed |= before.bytes != scene->file[i].bytes ||
                   before.changed.tv_sec != scene->file[i].changed.tv_sec ||
                   before.changed.tv_nsec != scene->file[i].changed.tv_nsec;
    }
    return changed;
}

/* --- The stream ----------------------------------------------------------------------------------------- */

static void close_player(struct scene *scene)
{
    player_free(scene->player);
    scene->player = NULL;
}

static void forget_stream(struct scene *scene)
{
    close_player(scene);
    forget_files(scene);
    free(scene->originals.original);
    stream_free(scene->stream);
    scene->originals = (struct camera_originals){0};
    scene->stream = NULL;
}

static int take_stream(struct scene *scene, struct stream *stream, struct error *error)
{
    forget_stream(scene);
    scene->stream = stream;
    scene->view = *stream;
    scene->view.frames = scene->frames;
    scene->view.frame_count = VIEW_FRAMES;
    if (camera_remember(stream, &scene->originals) || list_files(scene))
        return error_set(error, "%s: not enough memory", scene->path);
    return 0;
}

struct scene *scene_open(const char *path, struct error *error)
{
    struct stream *stream;
    struct scene *scene = calloc(1, sizeof *scene);
    if (scene)
        scene->path = strdup(path);
    if (!scene || !scene->path)
        error_set(error, "%s: not enough memory", path);
    else if (!stream_read(path, &stream, error) && !take_stream(scene, stream, error))
        return scene;
    scene_close(scene);
    return NULL;
}

int scene_reload(struct scene *scene, struct error *error)
{
    struct stream *stream;
    return stream_read(scene->path, &stream, error) ? -1 : take_stream(scene, stream, error);
}

void scene_close(struct scene *scene)
{
    if (!scene)
        return;
    forget_stream(scene);
    triptych_device_destroy(scene->device);
    free(scene->picture.color);
    free(scene->analysis.count);
    free(scene->analysis.owner);
    free(scene->path);
    free(scene);
}

uint32_t scene_frames(const struct scene *scene)
{
    return scene->stream->frame_count;
}

uint32_t scene_draws(const struct scene *scene, uint32_t frame)
{
    uint32_t draws = 0;
    for (uint32_t i = scene->stream->frames[frame]; i < scene->stream->frames[frame + 1]; i++)
        draws += stream_draws_at(scene->stream, i);
    return draws;
}

bool scene_has_camera(const struct scene *scene)
{
    return scene->originals.count;
}

/* The position after a draw of the frame; the frame's end if it has no such draw. */
static uint32_t end_of(const struct scene *scene, const struct scene_choice *choice)
{
    uint32_t draws = 0, end = scene->stream->frames[choice->frame + 1];
    for (uint32_t i = scene->stream->frames[choice->frame]; i < end; i++)
        if (stream_draws_at(scene->stream, i) && draws++ == choice->draw)
            return i + 1;
    return end;
}

/* --- Drawing -------------------------------------------------------------------------------------------- */

static int make_device(struct scene *scene, const struct scene_choice *choice, struct error *error)
{
    const struct triptych_options options = {.engine = triptych_engine_name(choice->engine),
                                             .threads = choice->threads};
    struct error reason = {""};
    close_player(scene);
    triptych_device_destroy(scene->device);
    scene->device = NULL;
    if (triptych_device_create(&options, &scene->device, reason.text, sizeof reason.text))
        return error_set(error, "engine %s: %s", options.engine, reason.text);
    scene->engine = choice->engine;
    scene->threads = choice->threads;
    return 0;
}

static int prepare(struct scene *scene, const struct scene_choice *choice, struct error *error)
{
    bool same = scene->device && scene->engine == choice->engine && scene->threads == choice->threads;
    if (!same && make_device(scene, choice, error))
        return -1;
    return scene->player ? 0 : stream_prepare(&scene->view, scene->device, &scene->player, error);
}

static int reserve(struct scene *scene, unsigned width, unsigned height, struct error *error)
{
    size_t pixels = (size_t)width * height;
    if (pixels > scene->capacity) {
        free(scene->picture.color);
        scene->picture.color = malloc(pixels * sizeof *scene->picture.color);
        scene->capacity = scene->picture.color ? pixels : 0;
    }
    scene->picture.width = scene->picture.color ? width : 0;
    scene->picture.height = scene->picture.color ? height : 0;
    return scene->picture.color ? 0 : error_set(error, "no memory for a picture of %zu pixels", pixels);
}

static void count_routines(struct scene *scene)
{
    struct triptych_routine_info info;
    scene->picture.routines = 0;
    scene->picture.code_bytes = 0;
    for (unsigned i = 0; triptych_get_routine(scene->device, i, &info); i++) {
        scene->picture.routines++;
        scene->picture.code_bytes += info.code_bytes;
    }
}

static int play(struct scene *scene, struct error *error)
{
    struct triptych_statistics before, after;
    if (player_frame(scene->player, 1, error))
        return -1;
    triptych_get_statistics(scene->device, &before);
    uint64_t begin = clock_ns();
    if (player_frame(scene->player, 2, error))
        return -1;
    scene->picture.ms = (double)(clock_ns() - begin) * 1e-6;
    triptych_get_statistics(scene->device, &after);
    scene->picture.triangles = after.triangles - before.triangles;
    scene->picture.pixels = after.pixels_shaded - before.pixels_shaded;
    return 0;
}

int scene_draw(struct scene *scene, const struct scene_choice *choice, struct error *error)
{
    unsigned width, height;
    uint32_t begin = scene->stream->frames[choice->frame];
    const uint32_t frames[VIEW_FRAMES + 1] = {0, begin, begin, end_of(scene, choice)};
    memcpy(scene->frames, frames, sizeof frames);
    camera_apply(&choice->camera, &scene->originals, scene->stream);
    if (prepare(scene, choice, error) || play(scene, error))
        return -1;
    triptych_target_size(scene->device, &width, &height);
    if (!width)
        return error_set(error, "%s: the frame has no target", scene->path);
    if (reserve(scene, width, height, error))
        return -1;
    count_routines(scene);
    if (triptych_read_color(scene->device, scene->picture.color, (size_t)width * height * 4))
        return error_set(error, "%s: %s", scene->path, triptych_error(scene->device));
    scene->picture.lower = session_is_lower(scene->device);
    if (scene->picture.lower)
        rows_reverse(scene->picture.color, (size_t)width * 4, height);
    return 0;
}

const struct scene_picture *scene_picture(const struct scene *scene)
{
    return &scene->picture;
}

/* --- Analysis ------------------------------------------------------------------------------------------- */

static int copy_analysis(struct scene *scene, const struct trail *trail, struct error *error)
{
    struct scene_analysis *to = &scene->analysis;
    const uint32_t *count = inspection_counts(trail, &to->width, &to->height);
    size_t pixels = (size_t)to->width * to->height;
    free(to->count);
    free(to->owner);
    to->count = malloc(pixels * sizeof *to->count);
    to->owner = malloc(pixels * sizeof *to->owner);
    if (!to->count || !to->owner) {
        to->width = to->height = 0;
        return error_set(error, "no memory for %zu pixels", pixels);
    }
    memcpy(to->count, count, pixels * sizeof *count);
    memcpy(to->owner, inspection_owners(trail), pixels * sizeof *to->owner);
    if (inspection_is_lower(trail)) {
        rows_reverse(to->count, to->width * sizeof *to->count, to->height);
        rows_reverse(to->owner, to->width * sizeof *to->owner, to->height);
    }
    return 0;
}

int scene_analyse(struct scene *scene, const struct scene_choice *choice, struct error *error)
{
    const struct trail_options options = {.frame = choice->frame,
                                          .draw = choice->draw == SCENE_ALL ? TRAIL_LAST : choice->draw,
                                          .x = -1,
                                          .counts = true,
                                          .owners = true};
    camera_apply(&choice->camera, &scene->originals, scene->stream);
    struct trail *trail = inspection_open(scene->stream, &options, error);
    if (!trail)
        return -1;
    int result = copy_analysis(scene, trail, error);
    inspection_close(trail);
    return result;
}

const struct scene_analysis *scene_analysis(const struct scene *scene)
{
    return &scene->analysis;
}
