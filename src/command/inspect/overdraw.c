#include "command/inspect/overdraw.h"

#include "command/support/table.h"

#include <stdio.h>

/* Counts up to `most`, from one past the row before. */
static const struct heat {
    uint32_t most, color; /* RGBA8, red in the low byte */
    const char *name;
} heats[] = {
    {0, 0xff000000, "black"},     {1, 0xff802000, "blue"},    {2, 0xffc07000, "light blue"},
    {3, 0xff909000, "teal"},      {4, 0xff20a000, "green"},   {6, 0xff20d070, "light green"},
    {8, 0xff00e0e0, "yellow"},    {12, 0xff0090ff, "orange"}, {16, 0xff0040ff, "red"},
    {32, 0xff4000c0, "dark red"}, {64, 0xffc040ff, "pink"},   {UINT32_MAX, 0xffffffff, "white"},
};

enum { HEATS = sizeof heats / sizeof *heats };

static unsigned heat_of(uint32_t count)
{
    unsigned i = 0;
    while (count > heats[i].most)
        i++;
    return i;
}

uint32_t overdraw_color(uint32_t count)
{
    return heats[heat_of(count)].color;
}

static void add_rows(cJSON *report, const uint64_t pixels[HEATS], uint32_t most)
{
    cJSON *rows = cJSON_AddArrayToObject(report, "rows");
    for (unsigned i = 0; i < HEATS && (!i || heats[i - 1].most < most); i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddItemToArray(rows, row);
        cJSON_AddNumberToObject(row, "least", i ? heats[i - 1].most + 1 : 0);
        cJSON_AddNumberToObject(row, "most", i + 1 < HEATS ? heats[i].most : most);
        cJSON_AddNumberToObject(row, "pixels", (double)pixels[i]);
        cJSON_AddStringToObject(row, "color", heats[i].name);
    }
}

cJSON *overdraw_report(const uint32_t *count, unsigned width, unsigned height)
{
    uint64_t pixels[HEATS] = {0}, sum = 0, all = (uint64_t)width * height;
    uint32_t most = 0;
    for (uint64_t i = 0; i < all; i++) {
        pixels[heat_of(count[i])]++;
        sum += count[i];
        most = count[i] > most ? count[i] : most;
    }
    cJSON *report = cJSON_CreateObject();
    cJSON_AddNumberToObject(report, "pixels", (double)all);
    cJSON_AddNumberToObject(report, "counted", (double)sum);
    cJSON_AddNumberToObject(report, "most", most);
    cJSON_AddNumberToObject(report, "mean", all > pixels[0] ? (double)sum / (double)(all - pixels[0]) : 0);
    add_rows(report, pixels, most);
    return report;
}

static double number_of(const cJSON *object, const char *name)
{
    return cJSON_GetNumberValue(cJSON_GetObjectItem(object, name));
}

void overdraw_print(const cJSON *report)
{
    struct table table = {0};
    const cJSON *row;
    printf("\noverdraw: counted %.0f times in %.0f pixels, at most %.0f times in one, on average %.2f times "
           "where "
           "it is counted\n",
           number_of(report, "counted"), number_of(report, "pixels"), number_of(report, "most"),
           number_of(report, "mean"));
    table_column(&table, "times", TABLE_RIGHT);
    table_column(&table, "pixels", TABLE_RIGHT);
    table_column(&table, "colour", TABLE_LEFT);
    cJSON_ArrayForEach(row, cJSON_GetObjectItem(report, "rows"))
    {
        double least = number_of(row, "least"), most = number_of(row, "most");
        table_cell(&table, least == most ? "%.0f" : "%.0f to %.0f", least, most);
        table_cell(&table, "%.0f", number_of(row, "pixels"));
        table_cell(&table, "%s", cJSON_GetStringValue(cJSON_GetObjectItem(row, "color")));
    }
    table_print(&table, 2, stdout);
}
