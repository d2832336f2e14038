/* `triptych compare`: two PNG pictures, pixel by pixel. */
#include "image/png.h"
#include "command/support/difference.h"
#include "command/support/json.h"
#include "command/support/option.h"
#include "command/support/shared.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct settings {
    const char *painting, *json;
    unsigned tolerance, allowed, compression;
};

enum outcome { IDENTICAL, SIMILAR, DIFFERENT, DIFFERENT_SIZES };

static const char *const outcome_names[] = {"identical", "similar", "different", "different sizes"};

/* The result of a comparison. `difference` and `distance` are zero unless the outcome is SIMILAR or
 * DIFFERENT. */
struct result {
    enum outcome outcome;
    struct difference difference;
    struct compare_distance distance;
};

static struct result compare(const struct picture picture[2], const struct settings *settings)
{
    struct result result = {.outcome = IDENTICAL};
    if (picture[0].width != picture[1].width || picture[0].height != picture[1].height) {
        result.outcome = DIFFERENT_SIZES;
    } else if (compare_pictures(picture, picture + 1, &result.difference)) {
        result.distance = compare_distance(picture, picture + 1, settings->tolerance);
        result.outcome = result.distance.pixels > settings->allowed ? DIFFERENT : SIMILAR;
    }
    return result;
}

static bool has_distance(const struct result *result)
{
    return result->outcome == SIMILAR || result->outcome == DIFFERENT;
}

static void print(char **paths, const struct picture picture[2], const struct settings *settings,
                  const struct result *result)
{
    char text[DIFFERENCE_TEXT];
    fputs(outcome_names[result->outcome], stdout);
    if (result->outcome == DIFFERENT_SIZES)
        printf(": %s is %u x %u, %s is %u x %u", paths[0], picture[0].width, picture[0].height, paths[1],
               picture[1].width, picture[1].height);
    else if (result->outcome != IDENTICAL)
        printf(": %s; PSNR %.2f dB", difference_describe(picture, &result->difference, text),
               compare_psnr(&result->distance));
    if (result->distance.largest && settings->tolerance)
        printf("; %" PRIu64 " by more than %u", result->distance.pixels, settings->tolerance);
    putchar('\n');
}

static void add_distance(cJSON *json, const struct result *result)
{
    char value[2][16];
    for (int i = 0; i < 2; i++)
        snprintf(value[i], sizeof value[i], "%08" PRIx32, __builtin_bswap32(result->difference.color[i]));
    cJSON_AddNumberToObject(json, "pixels", (double)result->difference.color_pixels);
    cJSON_AddNumberToObject(json, "pixels_beyond_tolerance", (double)result->distance.pixels);
    cJSON_AddNumberToObject(json, "largest", result->distance.largest);
    cJSON_AddNumberToObject(json, "mean_square", result->distance.mean_square);
    cJSON_AddNumberToObject(json, "psnr", compare_psnr(&result->distance));
    cJSON_AddNumberToObject(json, "x", result->difference.x);
    cJSON_AddNumberToObject(json, "y", result->difference.y);
    cJSON_AddStringToObject(json, "first_value", value[0]);
    cJSON_AddStringToObject(json, "second_value", value[1]);
}

static int write_json(const struct command *self, char **paths, const struct picture picture[2],
                      const struct settings *settings, const struct result *result)
{
    static const char *const names[] = {"first", "second"};
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "result", outcome_names[result->outcome]);
    for (int i = 0; i < 2; i++) {
        cJSON *side = cJSON_AddObjectToObject(json, names[i]);
        cJSON_AddStringToObject(side, "path", paths[i]);
        cJSON_AddNumberToObject(side, "width", picture[i].width);
        cJSON_AddNumberToObject(side, "height", picture[i].height);
    }
    cJSON_AddNumberToObject(json, "tolerance", settings->tolerance);
    cJSON_AddNumberToObject(json, "allowed", settings->allowed);
    if (has_distance(result))
        add_distance(json, result);
    int bad = json_write(self, json, settings->json);
    cJSON_Delete(json);
    return bad;
}

static int report(const struct command *self, char **paths, const struct picture picture[2],
                  const struct settings *settings)
{
    struct result result = compare(picture, settings);
    print(paths, picture, settings, &result);
    if (settings->json && write_json(self, paths, picture, settings, &result))
        return STATUS_BAD;
    if (settings->painting && has_distance(&result) &&
        difference_save(self, settings->painting, picture, picture + 1, settings->compression))
        return STATUS_BAD;
    return result.outcome == IDENTICAL || result.outcome == SIMILAR ? STATUS_OK : STATUS_DIFFERENT;
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    struct error error = {""};
    struct picture picture[2] = {{0}};
    uint32_t *rgba[2] = {NULL, NULL};
    int status = tool_check_picture(self, settings->painting) || tool_check_output(self, settings->json)
                     ? STATUS_BAD
                     : STATUS_OK;
    for (int i = 0; i < 2 && !status; i++) {
        if (png_load_single(operands->value[i], &picture[i].width, &picture[i].height, &rgba[i], &error))
            status = tool_fail(self, "%s", error.text);
        picture[i].color = rgba[i];
    }
    if (!status)
        status = report(self, operands->value, picture, settings);
    free(rgba[0]);
    free(rgba[1]);
    return status;
}

static const struct settings defaults = {.compression = PNG_LEVEL_DEFAULT};

static const struct option options[] = {
    {"difference", "FILE", "a PNG picture to write of the differences, in red",
     OPTION_IS_FILE(struct settings, painting), .extension = "png"},
    {"tolerance", "N", "the difference of a channel that is allowed, of 255; 0",
     OPTION_IS_NUMBER(struct settings, tolerance), .most = 255},
    {"allow", "N", "the number of pixels that may differ by more; 0",
     OPTION_IS_NUMBER(struct settings, allowed), .most = 1 << 26},
    OPTION_COMPRESSION(struct settings, compression),
    {"json", "FILE", "write the result", OPTION_IS_FILE(struct settings, json), .extension = "json"},
    {0},
};

static const struct operand operands[] = {
    {"FIRST", "a PNG picture", .kind = OPERAND_INPUT, .extension = "png"},
    {"SECOND", "a PNG picture", .kind = OPERAND_INPUT, .extension = "png"},
    {0},
};

static const char notes[] = "The result is identical, similar (within --tolerance and --allow), or "
                            "different. Only different has exit\n"
                            "status 1. PSNR, the peak signal-to-noise ratio, is 10 log10 (255^2 / mean "
                            "square) over all four channels.";

const struct command command_compare = {
    .name = "compare",
    .summary = "compare two pictures pixel by pixel",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
