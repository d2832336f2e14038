#include "command/inspect/print.h"

#include "command/support/table.h"

#include <stdio.h>
#include <string.h>

enum { PLACE = 64, COLOR = 96 };

static double number_of(const cJSON *object, const char *name)
{
    return cJSON_GetNumberValue(cJSON_GetObjectItem(object, name));
}

static const char *text_of(const cJSON *object, const char *name)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(object, name));
    return text ? text : "";
}

static bool is_true(const cJSON *object, const char *name)
{
    return cJSON_IsTrue(cJSON_GetObjectItem(object, name));
}

/* The position of a call: "line 3" or "offset 4, byte 5". */
static const char *place_of(const cJSON *object, char text[PLACE])
{
    if (cJSON_HasObjectItem(object, "line"))
        snprintf(text, PLACE, "line %.0f", number_of(object, "line"));
    else
        snprintf(text, PLACE, "offset %.0f, byte %.0f", number_of(object, "offset"),
                 number_of(object, "byte"));
    return text;
}

static const char *plural(double count)
{
    return count == 1 ? "" : "s";
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

void print_draws(const cJSON *draws)
{
    struct table table = {0};
    const cJSON *draw;
    char place[PLACE];
    table_column(&table, "draw", TABLE_RIGHT);
    table_column(&table, "primitives", TABLE_RIGHT);
    table_column(&table, "covered", TABLE_RIGHT);
    table_column(&table, "shaded", TABLE_RIGHT);
    table_column(&table, "passed", TABLE_RIGHT);
    table_column(&table, "place", TABLE_LEFT);
    table_column(&table, "call", TABLE_LEFT);
    cJSON_ArrayForEach(draw, draws)
    {
        table_cell(&table, "%.0f", number_of(draw, "draw"));
        table_cell(&table, "%.0f", number_of(draw, "primitives"));
        table_cell(&table, "%.0f", number_of(draw, "covered"));
        table_cell(&table, "%.0f", number_of(draw, "shaded"));
        table_cell(&table, "%.0f", number_of(draw, "passed"));
        table_cell(&table, "%s", place_of(draw, place));
        table_cell(&table, "%s", text_of(draw, "call"));
    }
    table_print(&table, 0, stdout);
}

/* --- State ---------------------------------------------------------------------------------------------- */

/* The image that a target is, or the texture that it is a surface of. */
static void print_surface(const cJSON *object)
{
    if (cJSON_HasObjectItem(object, "texture"))
        printf(", level %.0f of texture %s, slice %.0f", number_of(object, "level"),
               text_of(object, "texture"), number_of(object, "slice"));
    if (cJSON_HasObjectItem(object, "image"))
        printf(", image %s", text_of(object, "image"));
    putchar('\n');
}

static void print_targets(const cJSON *targets)
{
    const cJSON *color, *depth = cJSON_GetObjectItem(targets, "depth");
    double samples = number_of(targets, "samples");
    printf("\ntarget: %.0f x %.0f pixels, %.0f sample%s\n", number_of(targets, "width"),
           number_of(targets, "height"), samples, plural(samples));
    cJSON_ArrayForEach(color, cJSON_GetObjectItem(targets, "colors"))
    {
        printf("  colour %.0f  %s", number_of(color, "target"), text_of(color, "format"));
        print_surface(color);
    }
    if (!depth)
        return;
    printf("  depth     %s", text_of(depth, "format"));
    print_surface(depth);
}

static void print_shaders(const cJSON *shaders)
{
    const cJSON *shader;
    puts("\nshaders:");
    cJSON_ArrayForEach(shader, shaders)
    {
        printf("  %-9s ", text_of(shader, "stage"));
        if (cJSON_HasObjectItem(shader, "shader"))
            printf("%s, %s, %.0f slots\n", text_of(shader, "shader"), text_of(shader, "model"),
                   number_of(shader, "slots"));
        else
            puts("fixed function");
    }
}

static void print_textures(const cJSON *textures)
{
    struct table table = {0};
    const cJSON *texture;
    if (!cJSON_GetArraySize(textures))
        return;
    puts("\ntextures:");
    table_column(&table, "sampler", TABLE_RIGHT);
    table_column(&table, "name", TABLE_LEFT);
    table_column(&table, "type", TABLE_LEFT);
    table_column(&table, "format", TABLE_LEFT);
    table_column(&table, "size", TABLE_RIGHT);
    table_column(&table, "levels", TABLE_RIGHT);
    table_column(&table, "bytes", TABLE_RIGHT);
    table_column(&table, "", TABLE_LEFT);
    cJSON_ArrayForEach(texture, textures)
    {
        table_cell(&table, "%.0f", number_of(texture, "sampler"));
        table_cell(&table, "%s", text_of(texture, "texture"));
        table_cell(&table, "%s", text_of(texture, "type"));
        table_cell(&table, "%s", text_of(texture, "format"));
        table_cell(&table, number_of(texture, "depth") > 1 ? "%.0f x %.0f x %.0f" : "%.0f x %.0f",
                   number_of(texture, "width"), number_of(texture, "height"), number_of(texture, "depth"));
        table_cell(&table, "%.0f", number_of(texture, "levels"));
        table_cell(&table, "%.0f", number_of(texture, "bytes"));
        table_cell(&table, "%s", is_true(texture, "sampled") ? "sampled" : "not sampled");
    }
    table_print(&table, 2, stdout);
}

static void print_buffers(const cJSON *buffers, const cJSON *indices)
{
    const cJSON *buffer, *element;
    puts("\nbuffers:");
    cJSON_ArrayForEach(buffer, buffers)
    {
        if (cJSON_HasObjectItem(buffer, "stream"))
            printf("  stream %.0f  ", number_of(buffer, "stream"));
        else
            printf("  %-8s  ", "elements");
        printf("%s, %.0f bytes, from byte %.0f, %.0f bytes a vertex:", text_of(buffer, "buffer"),
               number_of(buffer, "bytes"), number_of(buffer, "offset"), number_of(buffer, "stride"));
        cJSON_ArrayForEach(element, cJSON_GetObjectItem(buffer, "elements"))
            printf(" %s:%s@%.0f", text_of(element, "element"), text_of(element, "format"),
                   number_of(element, "offset"));
        putchar('\n');
    }
    if (indices)
        printf("  indices   %s, %.0f bytes, %.0f bits an index\n", text_of(indices, "buffer"),
               number_of(indices, "bytes"), number_of(indices, "bits"));
}

static void print_states(const cJSON *states)
{
    const cJSON *state;
    puts("\nstate, where it differs from the default:");
    cJSON_ArrayForEach(state, states)
    {
        if (cJSON_HasObjectItem(state, "default"))
            printf("  %-46s default %s\n", text_of(state, "call"), text_of(state, "default"));
        else
            printf("  %s\n", text_of(state, "call"));
    }
}

void print_state(const cJSON *state)
{
    char place[PLACE];
    double primitives = number_of(state, "primitives");
    printf("%s: frame %.0f, draw %.0f of %.0f, %s\n", text_of(state, "stream"), number_of(state, "frame"),
           number_of(state, "draw"), number_of(state, "draws"), place_of(state, place));
    printf("%s: %.0f primitive%s; pixels covered %.0f, shaded %.0f, passed %.0f\n", text_of(state, "call"),
           primitives, plural(primitives), number_of(state, "covered"), number_of(state, "shaded"),
           number_of(state, "passed"));
    print_targets(cJSON_GetObjectItem(state, "targets"));
    print_shaders(cJSON_GetObjectItem(state, "shaders"));
    print_textures(cJSON_GetObjectItem(state, "textures"));
    print_buffers(cJSON_GetObjectItem(state, "buffers"), cJSON_GetObjectItem(state, "indices"));
    print_states(cJSON_GetObjectItem(state, "states"));
}

/* --- History -------------------------------------------------------------------------------------------- */

static const char *color_text(const cJSON *color, char text[COLOR])
{
    bool bytes = cJSON_HasObjectItem(color, "bytes");
    const cJSON *channel, *channels = cJSON_GetObjectItem(color, bytes ? "bytes" : "numbers");
    size_t used = 0;
    text[0] = 0;
    cJSON_ArrayForEach(channel, channels) used +=
        (size_t)snprintf(text + used, COLOR - used, "%s%.6g", used ? " " : "", cJSON_GetNumberValue(channel));
    return text;
}

static void print_label(const char *label, int number, int sample)
{
    char text[PLACE];
    if (number >= 0)
        snprintf(text, sizeof text, "%s %d", label, number);
    else
        snprintf(text, sizeof text, "%s", label);
    if (sample >= 0)
        snprintf(text + strlen(text), sizeof text - strlen(text), ", sample %d", sample);
    printf("    %-20s ", text);
}

static void print_change(const char *before, const char *after)
{
    if (strcmp(before, after))
        printf("%s -> %s\n", before, after);
    else
        printf("%s, unchanged\n", before);
}

static void print_number_change(const cJSON *before, const cJSON *after, const char *name, int sample)
{
    char text[2][COLOR];
    if (!cJSON_HasObjectItem(before, name))
        return;
    snprintf(text[0], COLOR, "%.9g", number_of(before, name));
    snprintf(text[1], COLOR, "%.9g", number_of(after, name));
    print_label(name, -1, sample);
    print_change(text[0], text[1]);
}

/* The stored values before and after, for each sample. */
static void print_words(const cJSON *before, const cJSON *after)
{
    int samples = cJSON_GetArraySize(before);
    for (int i = 0; i < samples; i++) {
        const cJSON *old = cJSON_GetArrayItem(before, i), *new = cJSON_GetArrayItem(after, i);
        const cJSON *colors = cJSON_GetObjectItem(old, "colors");
        int sample = samples > 1 ? i : -1;
        for (int t = 0; t < cJSON_GetArraySize(colors); t++) {
            char text[2][COLOR];
            print_label("stored colour", t, sample);
            print_change(color_text(cJSON_GetArrayItem(colors, t), text[0]),
                         color_text(cJSON_GetArrayItem(cJSON_GetObjectItem(new, "colors"), t), text[1]));
        }
        print_number_change(old, new, "depth", sample);
        print_number_change(old, new, "stencil", sample);
    }
}

static const char *verdict(const cJSON *test)
{
    return is_true(test, "passes") ? "passes" : "fails";
}

static void print_stencil(const cJSON *test, int sample)
{
    if (!test)
        return;
    print_label("stencil test", -1, sample);
    printf("%s: %.0f %s %.0f, both & %.0f\n", verdict(test), number_of(test, "reference"),
           text_of(test, "function"), number_of(test, "stored"), number_of(test, "mask"));
}

static void print_depth(const cJSON *test, int sample)
{
    if (!test)
        return;
    print_label("depth test", -1, sample);
    printf("%s: %.9g %s %.9g\n", verdict(test), number_of(test, "value"), text_of(test, "function"),
           number_of(test, "stored"));
}

static void print_tests(const cJSON *tests)
{
    int samples = cJSON_GetArraySize(tests);
    for (int i = 0; i < samples; i++) {
        const cJSON *test = cJSON_GetArrayItem(tests, i);
        int sample = samples > 1 ? i : -1;
        if (!is_true(test, "covered")) {
            print_label("coverage", -1, sample);
            puts("outside");
        }
        print_stencil(cJSON_GetObjectItem(test, "stencil"), sample);
        print_depth(cJSON_GetObjectItem(test, "depth"), sample);
    }
}

static void print_colors(const cJSON *primitive, const char *name, const char *label, const char *number)
{
    const cJSON *color;
    char text[COLOR];
    cJSON_ArrayForEach(color, cJSON_GetObjectItem(primitive, name))
    {
        print_label(label, (int)number_of(color, number), -1);
        puts(color_text(color, text));
    }
}

static void print_shading(const cJSON *primitive)
{
    const cJSON *alpha = cJSON_GetObjectItem(primitive, "alpha");
    print_colors(primitive, "texels", "texture stage", "stage");
    print_colors(primitive, "stages", "result of stage", "stage");
    print_colors(primitive, "colors", "new colour", "target");
    if (cJSON_HasObjectItem(primitive, "kept") && !is_true(primitive, "kept")) {
        print_label("shader", -1, -1);
        puts("discards the pixel");
    }
    if (!alpha)
        return;
    print_label("alpha test", -1, -1);
    printf("%s: %.0f %s %.0f\n", verdict(alpha), number_of(alpha, "value"), text_of(alpha, "function"),
           number_of(alpha, "reference"));
}

static void print_primitive(const cJSON *primitive)
{
    const cJSON *vertex;
    printf("  primitive %.0f", number_of(primitive, "primitive"));
    if (number_of(primitive, "instance") > 0)
        printf(" of instance %.0f", number_of(primitive, "instance"));
    printf(" (vert%s", cJSON_GetArraySize(cJSON_GetObjectItem(primitive, "vertices")) == 1 ? "ex" : "ices");
    cJSON_ArrayForEach(vertex, cJSON_GetObjectItem(primitive, "vertices"))
        printf(" %.0f", cJSON_GetNumberValue(vertex));
    printf("%s): %s\n", is_true(primitive, "clipped") ? ", clipped" : "", text_of(primitive, "result"));
    print_tests(cJSON_GetObjectItem(primitive, "tests"));
    print_shading(primitive);
    print_words(cJSON_GetObjectItem(primitive, "before"), cJSON_GetObjectItem(primitive, "after"));
}

static void print_event(const cJSON *event)
{
    const cJSON *primitive, *primitives = cJSON_GetObjectItem(event, "primitives");
    char place[PLACE];
    if (primitives)
        printf("\ndraw %.0f, %s: %s\n", number_of(event, "draw"), place_of(event, place),
               text_of(event, "call"));
    else
        printf("\n%s: %s\n", place_of(event, place), text_of(event, "call"));
    cJSON_ArrayForEach(primitive, primitives) print_primitive(primitive);
    if (!primitives)
        print_words(cJSON_GetObjectItem(event, "before"), cJSON_GetObjectItem(event, "after"));
}

void print_history(const cJSON *history)
{
    const cJSON *event, *events = cJSON_GetObjectItem(history, "events");
    printf("\npixel %.0f,%.0f:\n", number_of(history, "x"), number_of(history, "y"));
    if (!cJSON_GetArraySize(events))
        puts("  nothing touches it");
    cJSON_ArrayForEach(event, events) print_event(event);
    if (!is_true(history, "complete"))
        puts("\nfurther primitives of a draw are left out: there are too many");
}
