/* libpng reports errors by longjmp. All memory to free after one belongs to struct job, which the function
 * that calls setjmp reads only through a pointer. That function changes no local variable between setjmp and
 * longjmp. */
#include "image/png.h"

#include "base/file.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum { PNG_FILE_MAXIMUM = 1 << 28, PNG_CHUNK_MAXIMUM = 1 << 24, PNG_CHUNK_WRITTEN = 1 << 16 };

enum { LEVEL_OF_ALL_FILTERS = 6 };

struct job {
    const char *path;
    struct error *error;
    png_structp png;
    png_infop info;
    const char *source; /* reading: the rest of the file */
    size_t position;
    char *data; /* writing: the part of the file that is made */
    size_t bytes, capacity;
    unsigned width, height;
    unsigned level; /* writing */
    uint32_t *rgba;
    png_bytepp rows;
};

static void on_error(png_structp png, png_const_charp message)
{
    struct job *job = png_get_error_ptr(png);
    error_set(job->error, "%s: %s, expected a PNG picture of at most %d x %d pixels", job->path, message,
              PNG_SIDE_MAXIMUM, PNG_SIDE_MAXIMUM);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void free_job(struct job *job)
{
    free(job->data);
    free(job->rgba);
    free(job->rows);
}

static int make_rows(struct job *job, uint32_t *rgba)
{
    job->rows = malloc(job->height * sizeof *job->rows);
    if (!job->rows)
        return -1;
    for (size_t y = 0; y < job->height; y++)
        job->rows[y] = (png_bytep)(rgba + y * job->width);
    return 0;
}

/* --- Reading --- */

static void read_bytes(png_structp png, png_bytep out, size_t bytes)
{
    struct job *job = png_get_io_ptr(png);
    if (bytes > job->bytes - job->position)
        png_error(png, "the file is cut off");
    memcpy(out, job->source + job->position, bytes);
    job->position += bytes;
}

/* Skips all chunks that do not affect the samples. Texts and profiles can unpack to a thousand times their
 * size, and a file may have a thousand of them. */
static void set_limits(png_structp png)
{
    png_set_user_limits(png, PNG_SIDE_MAXIMUM, PNG_SIDE_MAXIMUM);
    png_set_chunk_malloc_max(png, PNG_CHUNK_MAXIMUM);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
}

static void convert_to_rgba8(struct job *job)
{
    png_set_expand(job->png);
    png_set_scale_16(job->png);
    png_set_gray_to_rgb(job->png);
    png_set_add_alpha(job->png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
}

static int decode(struct job *job)
{
    if (setjmp(png_jmpbuf(job->png)))
        return -1;
    set_limits(job->png);
    png_set_read_fn(job->png, job, read_bytes);
    png_read_info(job->png, job->info);
    convert_to_rgba8(job);
    job->width = png_get_image_width(job->png, job->info);
    job->height = png_get_image_height(job->png, job->info);
    job->rgba = malloc((size_t)job->width * job->height * sizeof *job->rgba);
    if (!job->rgba || make_rows(job, job->rgba))
        png_error(job->png, "not enough memory");
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
    return 0;
}

int png_decode(const char *path, const void *data, size_t bytes, unsigned *width, unsigned *height,
               uint32_t **rgba, struct error *error)
{
    struct job job = {.path = path, .error = error, .source = data, .bytes = bytes};
    int result = -1;
    *rgba = NULL;
    job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    if (!job.info)
        error_set(error, "%s: not enough memory", path);
    else
        result = decode(&job);
    png_destroy_read_struct(&job.png, &job.info, NULL);
    if (!result) {
        *width = job.width;
        *height = job.height;
        *rgba = job.rgba;
        job.rgba = NULL;
    }
    free_job(&job);
    return result;
}

/* The number in the chunk acTL, which comes before the pixels of an animation; 1 without one. A chunk is its
 * length, its name, the data and a checksum. */
static unsigned count_pictures(const char *data, size_t bytes)
{
    enum { SIGNATURE = 8, HEAD = 8, CHECKSUM = 4 };
    for (size_t at = SIGNATURE; at + HEAD + 4 <= bytes;) {
        const char *name = data + at + 4;
        if (!memcmp(name, "IDAT", 4))
            break;
        if (!memcmp(name, "acTL", 4))
            return png_get_uint_32((png_const_bytep)data + at + HEAD);
        at += HEAD + (size_t)png_get_uint_32((png_const_bytep)data + at) + CHECKSUM;
    }
    return 1;
}

/* *pictures is 1 after a failure. */
static int load(const char *path, unsigned *width, unsigned *height, uint32_t **rgba, unsigned *pictures,
                struct error *error)
{
    char *data;
    size_t bytes;
    *rgba = NULL;
    *pictures = 1;
    if (file_read(path, PNG_FILE_MAXIMUM, &data, &bytes, error))
        return -1;
    int result = png_decode(path, data, bytes, width, height, rgba, error);
    if (!result)
        *pictures = count_pictures(data, bytes);
    free(data);
    return result;
}

int png_load(const char *path, unsigned *width, unsigned *height, uint32_t **rgba, struct error *error)
{
    unsigned pictures;
    return load(path, width, height, rgba, &pictures, error);
}

int png_load_single(const char *path, unsigned *width, unsigned *height, uint32_t **rgba, struct error *error)
{
    unsigned pictures;
    int result = load(path, width, height, rgba, &pictures, error);
    if (pictures < 2)
        return result;
    free(*rgba);
    *rgba = NULL;
    return error_set(error, "%s: found an animation of %u frames, expected one picture", path, pictures);
}

/* --- Writing --- */

static void write_bytes(png_structp png, png_bytep data, size_t bytes)
{
    struct job *job = png_get_io_ptr(png);
    if (bytes > job->capacity - job->bytes) {
        size_t capacity = 2 * job->capacity + bytes + 65536;
        char *larger = realloc(job->data, capacity);
        if (!larger)
            png_error(png, "not enough memory");
        job->data = larger;
        job->capacity = capacity;
    }
    memcpy(job->data + job->bytes, data, bytes);
    job->bytes += bytes;
}

static void flush_nothing(png_structp png)
{
    (void)png;
}

/* The filter "up" suits pictures whose rows resemble the rows above. */
static void set_compression(const struct job *job)
{
    png_set_compression_level(job->png, (int)job->level);
    png_set_compression_buffer_size(job->png, PNG_CHUNK_WRITTEN);
    if (job->level < LEVEL_OF_ALL_FILTERS)
        png_set_filter(job->png, PNG_FILTER_TYPE_BASE, job->level ? PNG_FILTER_UP : PNG_FILTER_NONE);
}

static int encode(struct job *job, const uint32_t *rgba)
{
    if (setjmp(png_jmpbuf(job->png)))
        return -1;
    png_set_user_limits(job->png, PNG_SIDE_MAXIMUM, PNG_SIDE_MAXIMUM);
    png_set_write_fn(job->png, job, write_bytes, flush_nothing);
    png_set_IHDR(job->png, job->info, job->width, job->height, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    set_compression(job);
    png_write_info(job->png, job->info);
    /* libpng takes rows that are not const, but writing only reads them. */
    if (make_rows(job, (uint32_t *)(uintptr_t)rgba))
        png_error(job->png, "not enough memory");
    png_write_image(job->png, job->rows);
    png_write_end(job->png, NULL);
    return 0;
}

int png_encode(const char *path, unsigned width, unsigned height, const uint32_t *rgba, unsigned level,
               void **data, size_t *bytes, struct error *error)
{
    struct job job = {.path = path, .error = error, .width = width, .height = height, .level = level};
    int result = -1;
    job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    if (!job.info)
        error_set(error, "%s: not enough memory", path);
    else
        result = encode(&job, rgba);
    png_destroy_write_struct(&job.png, &job.info);
    *data = result ? NULL : job.data;
    *bytes = job.bytes;
    if (!result)
        job.data = NULL;
    free_job(&job);
    return result;
}

int png_save_level(const char *path, unsigned width, unsigned height, const uint32_t *rgba, unsigned level,
                   struct error *error)
{
    void *data;
    size_t bytes;
    if (png_encode(path, width, height, rgba, level, &data, &bytes, error))
        return -1;
    int result = file_write(path, data, bytes, error);
    free(data);
    return result;
}

int png_save(const char *path, unsigned width, unsigned height, const uint32_t *rgba, struct error *error)
{
    return png_save_level(path, width, height, rgba, PNG_LEVEL_DEFAULT, error);
}
