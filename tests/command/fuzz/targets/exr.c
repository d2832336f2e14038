/* The writer of EXR pictures; the project has no reader. Pictures, channels and names of any kind are
 * refused, or OpenEXRCore reads them back with the same bits. The first bytes of the input are the shape, the
 * rest are the values. */
#include "image/exr.h"

#include "base/half.h"
#include "tests/command/fuzz/targets/target.h"

#include <openexr.h>
#include <string.h>
#include <unistd.h>

enum { CHANNELS = 26, NAME = 8, SIDE = 80 };

struct picture {
    const char *path;
    unsigned width, height;
    size_t count;
    struct exr_channel channels[CHANNELS];
    char names[CHANNELS][NAME];
    float *values;
};

/* Sides are small, or in rare cases near the limit. */
static unsigned choose_side(struct choices *c)
{
    unsigned side = choose(c, SIDE + 4);
    return side < SIDE ? side : side < SIDE + 2 ? 8193 : 1u << 31;
}

static void choose_picture(struct picture *p, struct choices *c)
{
    p->path = fuzz_path("exr");
    p->width = choose_side(c);
    p->height = choose_side(c);
    p->count = choose(c, CHANNELS + 1);
    size_t step = 1 + choose(c, 4),
           pixels = p->width <= SIDE && p->height <= SIDE ? (size_t)p->width * p->height : 0;
    for (size_t i = 0; i < p->count; i++) {
        for (int n = 0; n < NAME - 1; n++)
            if (!(p->names[i][n] = (char)choose(c, 256)))
                break;
        p->channels[i] = (struct exr_channel){.name = p->names[i], .step = step, .depth = choose(c, 2)};
    }
    p->values = calloc(pixels * step + CHANNELS, sizeof *p->values);
    expect(p->values, "memory");
    size_t left = (size_t)(c->end - c->at), room = pixels * step * sizeof *p->values;
    for (size_t at = 0; left && at < room; at += left) /* repeats the input */
        memcpy((char *)p->values + at, c->at, left < room - at ? left : room - at);
    for (size_t i = 0; i < p->count; i++)
        p->channels[i].values = p->values + i % step;
}

/* --- Reading back --------------------------------------------------------------------------------------- */

static void quiet(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static const struct exr_channel *find(const struct picture *p, const char *name)
{
    for (size_t i = 0; i < p->count; i++)
        if (!strcmp(p->channels[i].name, name))
            return &p->channels[i];
    expect(0, "a channel '%s'", name);
    return NULL;
}

static void expect_values(const struct picture *p, const exr_coding_channel_info_t *info, const uint8_t *got,
                          int y, int lines)
{
    const struct exr_channel *channel = find(p, info->channel_name);
    for (int line = 0; line < lines; line++)
        for (unsigned x = 0; x < p->width; x++) {
            float value = channel->values[((size_t)(y + line) * p->width + x) * channel->step];
            uint32_t expected, bits = 0;
            memcpy(&expected, &value, sizeof expected);
            if (channel->depth == EXR_HALF)
                expected = float_to_half(value);
            memcpy(&bits, got + ((size_t)line * p->width + x) * (size_t)info->bytes_per_element,
                   (size_t)info->bytes_per_element);
            int is_nan =
                channel->depth == EXR_HALF ? (expected & 0x7fff) > 0x7c00 && (bits & 0x7fff) > 0x7c00 : 0;
            expect(bits == expected || is_nan, "%s at %u, %d: %08x instead of %08x", channel->name, x,
                   y + line, bits, expected);
        }
}

static void read_chunk(const struct picture *p, exr_context_t file, exr_decode_pipeline_t *pipeline,
                       uint8_t **room, int y, int lines)
{
    exr_chunk_info_t chunk;
    expect(!exr_read_scanline_chunk_info(file, 0, y, &chunk), "chunk at %d", y);
    expect(!(y ? exr_decoding_update(file, 0, &chunk, pipeline)
               : exr_decoding_initialize(file, 0, &chunk, pipeline)),
           "chunk at %d", y);
    expect((size_t)pipeline->channel_count == p->count, "%d channels", pipeline->channel_count);
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *info = &pipeline->channels[c];
        info->decode_to_ptr = room[c];
        info->user_pixel_stride = info->bytes_per_element;
        info->user_line_stride = info->bytes_per_element * (int)p->width;
        info->user_bytes_per_element = info->bytes_per_element;
        info->user_data_type = info->data_type;
    }
    if (!y)
        expect(!exr_decoding_choose_default_routines(file, 0, pipeline), "routines");
    expect(!exr_decoding_run(file, 0, pipeline), "chunk at %d", y);
    for (int c = 0; c < pipeline->channel_count; c++)
        expect_values(p, &pipeline->channels[c], room[c], y, lines);
}

static void expect_reads_back(const struct picture *p)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_context_t file;
    exr_attr_box2i_t window;
    uint8_t *room[CHANNELS];
    int32_t lines;
    initializer.error_handler_fn = quiet;
    expect(!exr_start_read(&file, p->path, &initializer), "a picture");
    expect(!exr_get_data_window(file, 0, &window) && window.max.x == (int)p->width - 1 &&
               window.max.y == (int)p->height - 1,
           "%d x %d", window.max.x, window.max.y);
    expect(!exr_get_scanlines_per_chunk(file, 0, &lines), "lines");
    for (size_t c = 0; c < p->count; c++)
        room[c] = malloc((size_t)lines * p->width * sizeof(float));
    for (int y = 0; y < (int)p->height; y += lines)
        read_chunk(p, file, &pipeline, room, y, lines < (int)p->height - y ? lines : (int)p->height - y);
    for (size_t c = 0; c < p->count; c++)
        free(room[c]);
    exr_decoding_destroy(file, &pipeline);
    exr_finish(&file);
}

static void run(const uint8_t *data, size_t bytes)
{
    struct choices choices = {data, data + bytes};
    struct picture picture = {0};
    struct error error = {{0}};
    choose_picture(&picture, &choices);
    unlink(picture.path);
    if (exr_save(picture.path, picture.width, picture.height, picture.channels, picture.count, &error)) {
        expect_refusal(&error, picture.path);
        expect(access(picture.path, F_OK), "half a picture");
    } else {
        expect(!error.text[0], "%s", error.text);
        expect_reads_back(&picture);
    }
    unlink(picture.path);
    free(picture.values);
}

const struct fuzz_target fuzz_exr = {"exr", run};
