/* OpenEXRCore writes the file into memory, and file_write then writes it to disk, so that half a picture is
 * never visible. The library writes the chunk table last, near the start of the file, so its writes have
 * offsets.
 *
 * For a lack of memory, the library has many error codes; errno has one. */
#include "image/exr.h"

#include "base/file.h"

#include <errno.h>
#include <openexr.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { EXR_SIDE_MAXIMUM = 8192, EXR_CHANNEL_MAXIMUM = 24 };

struct job {
    const char *path;
    struct error *error;
    unsigned width, height;
    const struct exr_channel *channels;
    size_t count;
    uint8_t *data;
    size_t bytes, capacity;
    exr_result_t (*compress)(exr_encode_pipeline_t *pipeline); /* OpenEXRCore's own function */
};

/* Replaces the default handler, which prints. The context may be locked here, so that a query of it would
 * deadlock; the text of the result code has to do. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static int64_t write_bytes(exr_const_context_t context, void *user, const void *data, uint64_t bytes,
                           uint64_t offset, exr_stream_error_func_ptr_t report)
{
    struct job *job = user;
    if (offset > SIZE_MAX / 4 || bytes > SIZE_MAX / 4)
        return -1;
    size_t end = (size_t)(offset + bytes);
    if (end > job->capacity) {
        size_t capacity = end + end / 2 + 65536;
        uint8_t *larger = realloc(job->data, capacity);
        if (!larger) {
            report(context, EXR_ERR_OUT_OF_MEMORY, "not enough memory");
            return -1;
        }
        memset(larger + job->capacity, 0, capacity - job->capacity);
        job->data = larger;
        job->capacity = capacity;
    }
    memcpy(job->data + offset, data, bytes);
    if (end > job->bytes)
        job->bytes = end;
    return (int64_t)bytes;
}

static exr_result_t write_header(exr_context_t context, const struct job *job)
{
    int part;
    exr_result_t result = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (!result)
        result = exr_initialize_required_attr_simple(context, part, (int32_t)job->width, (int32_t)job->height,
                                                     EXR_COMPRESSION_ZIP);
    for (size_t i = 0; i < job->count && !result; i++)
        result = exr_add_channel(context, part, job->channels[i].name,
                                 job->channels[i].depth == EXR_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    return result ? result : exr_write_header(context);
}

/* OpenEXRCore sorts channels by name. */
static const struct exr_channel *find_channel(const struct job *job, const char *name)
{
    size_t i = 0;
    while (i + 1 < job->count && strcmp(job->channels[i].name, name))
        i++;
    return &job->channels[i];
}

static void point_to_rows(exr_encode_pipeline_t *pipeline, const struct job *job, size_t y)
{
    for (int16_t c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *info = &pipeline->channels[c];
        const struct exr_channel *channel = find_channel(job, info->channel_name);
        size_t row = job->width * channel->step;
        info->encode_from_ptr = (const uint8_t *)(channel->values + y * row);
        info->user_data_type = EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = sizeof(float);
        info->user_pixel_stride = (int32_t)(channel->step * sizeof(float));
        info->user_line_stride = (int32_t)(row * sizeof(float));
    }
}

/* Readers treat a chunk as uncompressed if its length is that of its pixels. OpenEXRCore 3.1.5 also writes
 * compressed data of exactly that length, which readers would misread; such a chunk is copied uncompressed.
 */
static exr_result_t compress_or_copy(exr_encode_pipeline_t *pipeline)
{
    const struct job *job = pipeline->encoding_user_data;
    exr_result_t result = job->compress(pipeline);
    if (!result && pipeline->compressed_bytes == pipeline->packed_bytes)
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, pipeline->packed_bytes);
    return result;
}

static exr_result_t choose_routines(exr_context_t context, struct job *job, exr_encode_pipeline_t *pipeline)
{
    exr_result_t result = exr_encoding_choose_default_routines(context, 0, pipeline);
    job->compress = pipeline->compress_fn;
    pipeline->encoding_user_data = job;
    pipeline->compress_fn = compress_or_copy;
    return result;
}

static exr_result_t write_chunk(exr_context_t context, struct job *job, exr_encode_pipeline_t *pipeline,
                                int y)
{
    exr_chunk_info_t chunk;
    exr_result_t result = exr_write_scanline_chunk_info(context, 0, y, &chunk);
    if (!result)
        result = y ? exr_encoding_update(context, 0, &chunk, pipeline)
                   : exr_encoding_initialize(context, 0, &chunk, pipeline);
    if (result)
        return result;
    point_to_rows(pipeline, job, (size_t)y);
    if (!y)
        result = choose_routines(context, job, pipeline);
    return result ? result : exr_encoding_run(context, 0, pipeline);
}

static exr_result_t write_pixels(exr_context_t context, struct job *job)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    int32_t step = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &step);
    for (int y = 0; y < (int)job->height && !result; y += step)
        result = write_chunk(context, job, &pipeline, y);
    exr_encoding_destroy(context, &pipeline);
    return result;
}

static int encode(struct job *job)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context = NULL;
    initializer.user_data = job;
    initializer.write_fn = write_bytes;
    initializer.error_handler_fn = on_error;
    errno = 0;
    exr_result_t result = exr_start_write(&context, job->path, EXR_WRITE_FILE_DIRECTLY, &initializer);
    if (!result)
        result = write_header(context, job);
    if (!result)
        result = write_pixels(context, job);
    exr_result_t finished = context ? exr_finish(&context) : result;
    if (!result)
        result = finished;
    if (result)
        return error_set(job->error, "%s: %s", job->path,
                         errno == ENOMEM ? "not enough memory" : exr_get_default_error_message(result));
    return 0;
}

int exr_save(const char *path, unsigned width, unsigned height, const struct exr_channel *channels,
             size_t count, struct error *error)
{
    struct job job = {path, error, width, height, channels, count, NULL, 0, 0, NULL};
    if (!width || !height || width > EXR_SIDE_MAXIMUM || height > EXR_SIDE_MAXIMUM)
        return error_set(error, "%s: %u x %u pixels, expected 1 to %d a side", path, width, height,
                         EXR_SIDE_MAXIMUM);
    if (!count || count > EXR_CHANNEL_MAXIMUM)
        return error_set(error, "%s: %zu channels, expected 1 to %d", path, count, EXR_CHANNEL_MAXIMUM);
    int result = encode(&job);
    if (!result)
        result = file_write(path, job.data, job.bytes, error);
    free(job.data);
    return result;
}
