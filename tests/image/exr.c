/* EXR writing of image/exr.h, read back through OpenEXRCore's decoding. */
#include "image/exr.h"

#include "base/file.h"

#include <math.h>
#include <openexr.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <unity.h>

enum { WIDTH = 37, HEIGHT = 41 }; /* not a multiple of the 16 lines of a chunk */

static char path[64];
static struct error error;
static float color[WIDTH * HEIGHT * 4], depth[WIDTH * HEIGHT];

void setUp(void)
{
    strcpy(path, "/tmp/triptych-exr.XXXXXX");
    close(mkstemp(path));
    error_clear(&error);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        depth[i] = (float)i / 3.0f;
        for (int c = 0; c < 4; c++)
            color[i * 4 + c] = (float)(i * 4 + c) / 1000.1f;
    }
}

void tearDown(void)
{
    unlink(path);
}

static void quiet(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

/* Reads one channel of the file as floats. Returns the channel's pixel type. */
static int read_channel(const char *name, float *out)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t file;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t lines;
    int type = -1;
    initializer.error_handler_fn = quiet;
    TEST_ASSERT_EQUAL_INT(0, exr_start_read(&file, path, &initializer));
    TEST_ASSERT_EQUAL_INT(0, exr_get_scanlines_per_chunk(file, 0, &lines));
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        TEST_ASSERT_EQUAL_INT(0, exr_read_scanline_chunk_info(file, 0, y, &chunk));
        TEST_ASSERT_EQUAL_INT(0, y ? exr_decoding_update(file, 0, &chunk, &pipeline)
                                   : exr_decoding_initialize(file, 0, &chunk, &pipeline));
        for (int c = 0; c < pipeline.channel_count; c++) {
            exr_coding_channel_info_t *info = &pipeline.channels[c];
            int wanted = !strcmp(info->channel_name, name);
            info->decode_to_ptr = wanted ? (uint8_t *)(out + y * WIDTH) : NULL;
            info->user_pixel_stride = 4;
            info->user_line_stride = 4 * WIDTH;
            info->user_bytes_per_element = 4;
            info->user_data_type = EXR_PIXEL_FLOAT;
            if (wanted)
                type = info->data_type;
        }
        if (!y)
            TEST_ASSERT_EQUAL_INT(0, exr_decoding_choose_default_routines(file, 0, &pipeline));
        TEST_ASSERT_EQUAL_INT(0, exr_decoding_run(file, 0, &pipeline));
    }
    exr_decoding_destroy(file, &pipeline);
    exr_finish(&file);
    return type;
}

static void floats_come_back_bit_for_bit_and_halves_within_half_a_step(void)
{
    static float back[WIDTH * HEIGHT];
    const struct exr_channel channels[] = {
        {"R", color, 4, EXR_HALF},      {"G", color + 1, 4, EXR_HALF}, {"B", color + 2, 4, EXR_FLOAT},
        {"A", color + 3, 4, EXR_FLOAT}, {"Z", depth, 1, EXR_FLOAT},
    };
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, exr_save(path, WIDTH, HEIGHT, channels, 5, &error), error.text);
    TEST_ASSERT_EQUAL_INT(EXR_PIXEL_FLOAT, read_channel("Z", back));
    TEST_ASSERT_EQUAL_MEMORY(depth, back, sizeof depth);
    TEST_ASSERT_EQUAL_INT(EXR_PIXEL_FLOAT, read_channel("A", back));
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        TEST_ASSERT_EQUAL_FLOAT(color[i * 4 + 3], back[i]);
    TEST_ASSERT_EQUAL_INT(EXR_PIXEL_HALF, read_channel("R", back));
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        TEST_ASSERT_TRUE(fabsf(color[i * 4] - back[i]) <= color[i * 4] * 0x1p-11f + 0x1p-25f);
    TEST_ASSERT_EQUAL_INT(-1, read_channel("Y", back));
}

static void the_same_picture_is_the_same_bytes(void)
{
    const struct exr_channel channel = {"Z", depth, 1, EXR_FLOAT};
    char *first, *second;
    size_t first_bytes, second_bytes;
    TEST_ASSERT_EQUAL_INT(0, exr_save(path, WIDTH, HEIGHT, &channel, 1, &error));
    TEST_ASSERT_EQUAL_INT(0, file_read(path, 1 << 20, &first, &first_bytes, &error));
    TEST_ASSERT_EQUAL_INT(0, exr_save(path, WIDTH, HEIGHT, &channel, 1, &error));
    TEST_ASSERT_EQUAL_INT(0, file_read(path, 1 << 20, &second, &second_bytes, &error));
    TEST_ASSERT_EQUAL_UINT64(first_bytes, second_bytes);
    TEST_ASSERT_EQUAL_MEMORY(first, second, first_bytes);
    free(first);
    free(second);
}

static void impossible_pictures_and_paths_are_refused(void)
{
    const struct exr_channel twice[2] = {{"Z", depth, 1, EXR_FLOAT}, {"Z", depth, 1, EXR_FLOAT}};
    TEST_ASSERT_EQUAL_INT(-1, exr_save(path, 0, 1, twice, 1, &error));
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, exr_save(path, 1, 1, twice, 0, &error));
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, exr_save(path, 1, 1, twice, 2, &error));
    TEST_ASSERT_EQUAL_MEMORY(path, error.text, strlen(path));
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(-1, exr_save("/nonexistent/x.exr", 1, 1, twice, 1, &error));
    TEST_ASSERT_NOT_NULL(strstr(error.text, "No such file"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(floats_come_back_bit_for_bit_and_halves_within_half_a_step);
    RUN_TEST(the_same_picture_is_the_same_bytes);
    RUN_TEST(impossible_pictures_and_paths_are_refused);
    return UNITY_END();
}
