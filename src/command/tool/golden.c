#include "command/tool/golden.h"
#include "command/support/difference.h"
#include "image/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { PATH_CAPACITY = 4096 };

/* Writes the path of the golden, which may be missing. Returns true if the file exists. */
static bool find_golden(const struct golden *golden, const char *name, unsigned frame,
                        char path[PATH_CAPACITY])
{
    snprintf(path, PATH_CAPACITY, "%s/%s-%u.png", golden->folder, name, frame);
    if (frame || !access(path, F_OK))
        return !access(path, F_OK);
    snprintf(path, PATH_CAPACITY, "%s/%s.png", golden->folder, name);
    return !access(path, F_OK);
}

static int update(const struct command *self, struct golden *golden, const char *name, unsigned frame,
                  bool single)
{
    const struct readback *picture = &golden->readback;
    struct error error = {""};
    char path[PATH_CAPACITY], number[16] = "";
    if (!single)
        snprintf(number, sizeof number, "-%u", frame);
    snprintf(path, sizeof path, "%s/%s%s.png", golden->folder, name, number);
    if (png_save_level(path, picture->width, picture->height, picture->color, golden->compression, &error))
        return tool_fail(self, "%s", error.text);
    golden->written++;
    return STATUS_OK;
}

static void add_report(cJSON *report, const char *path, unsigned frame, const char *result,
                       const struct compare_distance *distance)
{
    if (!report)
        return;
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "path", path);
    cJSON_AddNumberToObject(json, "frame", frame);
    cJSON_AddStringToObject(json, "result", result);
    cJSON_AddNumberToObject(json, "pixels_beyond_tolerance", (double)distance->pixels);
    cJSON_AddNumberToObject(json, "largest", distance->largest);
    if (distance->mean_square > 0)
        cJSON_AddNumberToObject(json, "psnr", compare_psnr(distance));
    cJSON_AddItemToArray(report, json);
}

static void print_line(struct golden *golden, const char *name, unsigned frame, const char *path,
                       const char *what)
{
    golden->different++;
    tool_progress(NULL);
    printf("%s: frame %u: golden %s: %s\n", name, frame, path, what);
}

static int save_difference(const struct command *self, const struct golden *golden, const char *name,
                           unsigned frame, const struct picture picture[2])
{
    char path[PATH_CAPACITY];
    snprintf(path, sizeof path, "%s/%s-golden-frame-%u.png", golden->differences, name, frame);
    return difference_save(self, path, picture, picture + 1, golden->compression);
}

static int compare(const struct command *self, struct golden *golden, const char *name, unsigned frame,
                   const char *path, const struct picture picture[2], cJSON *report)
{
    struct difference difference;
    struct compare_distance distance = {0};
    char text[DIFFERENCE_TEXT + 64];
    golden->compared++;
    if (picture[0].width != picture[1].width || picture[0].height != picture[1].height) {
        snprintf(text, sizeof text, "%u x %u pixels, the frame has %u x %u", picture[0].width,
                 picture[0].height, picture[1].width, picture[1].height);
        print_line(golden, name, frame, path, text);
        add_report(report, path, frame, "different sizes", &distance);
        return STATUS_OK;
    }
    if (compare_pictures(picture, picture + 1, &difference))
        distance = compare_distance(picture, picture + 1, golden->tolerance);
    add_report(report, path, frame,
               distance.pixels    ? "different"
               : distance.largest ? "similar"
                                  : "identical",
               &distance);
    if (!distance.pixels)
        return STATUS_OK;
    char described[DIFFERENCE_TEXT];
    snprintf(text, sizeof text, "%s; PSNR %.2f dB", difference_describe(picture, &difference, described),
             compare_psnr(&distance));
    print_line(golden, name, frame, path, text);
    return golden->differences ? save_difference(self, golden, name, frame, picture) : STATUS_OK;
}

int golden_check(const struct command *self, struct golden *golden, const struct session *session,
                 const char *name, unsigned frame, bool single, cJSON *report)
{
    static const struct compare_distance none;
    struct error error = {""};
    char path[PATH_CAPACITY];
    struct picture picture[2] = {{0}};
    uint32_t *rgba;
    bool exists = !golden->update && find_golden(golden, name, frame, path);
    if (!golden->update && !exists && frame)
        return STATUS_OK;
    if (!golden->update && !exists) {
        print_line(golden, name, frame, path, "is missing");
        add_report(report, path, frame, "missing", &none);
        return STATUS_OK;
    }
    if (readback_take(self, session, READBACK_COLORS, &golden->readback))
        return STATUS_BAD;
    if (golden->update)
        return update(self, golden, name, frame, single);
    if (png_load_single(path, &picture[0].width, &picture[0].height, &rgba, &error))
        return tool_fail(self, "%s", error.text);
    picture[0].color = rgba;
    picture[1] = (struct picture){
        .width = golden->readback.width, .height = golden->readback.height, .color = golden->readback.color};
    int status = compare(self, golden, name, frame, path, picture, report);
    free(rgba);
    return status;
}
