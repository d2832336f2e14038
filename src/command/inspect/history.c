/* The history of a pixel as JSON. */
#include "command/inspect/inspection_part.h"

#include "base/bits.h"
#include "machine/mxcsr.h"

static void add_number(cJSON *object, const char *name, double number)
{
    cJSON_AddNumberToObject(object, name, number);
}

static cJSON *add_object(cJSON *array)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddItemToArray(array, object);
    return object;
}

/* --- Colours -------------------------------------------------------------------------------------------- */

/* {"bytes": [r, g, b, a]} or {"numbers": [r, g, b, a]} */
static cJSON *color_of(const double channel[4], bool bytes)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddItemToObject(object, bytes ? "bytes" : "numbers", cJSON_CreateDoubleArray(channel, 4));
    return object;
}

/* The pairs rb and ga of a packed colour (spec/math/color.h). */
static cJSON *packed(const uint32_t part[OBSERVED_PARTS])
{
    const double channel[4] = {part[0] & 0xffff, part[1] & 0xffff, part[0] >> 16, part[1] >> 16};
    return color_of(channel, true);
}

static cJSON *exact(const uint32_t part[OBSERVED_PARTS])
{
    double channel[4];
    for (int c = 0; c < 4; c++)
        channel[c] = (double)bits_to_float(part[c]);
    return color_of(channel, false);
}

/* A colour as the target stores it. */
static cJSON *stored(const struct target_color *color, const uint32_t *planes)
{
    double channel[4];
    bool bytes = storage_planes[color->storage] == 1;
    float number[4];
    color_numbers(color->storage, planes + color->plane, number);
    for (int c = 0; c < 4; c++)
        channel[c] = bytes ? planes[color->plane] >> 8 * c & 255 : (double)number[c];
    return color_of(channel, bytes);
}

/* --- Stored words --------------------------------------------------------------------------------------- */

static cJSON *sample_words(const struct target *target, const struct pixel_words *words, uint32_t sample)
{
    cJSON *object = cJSON_CreateObject();
    cJSON *colors = cJSON_AddArrayToObject(object, "colors");
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].format)
            cJSON_AddItemToArray(colors, stored(&target->colors[t], words->color[sample]));
    if (!target->depth)
        return object;
    add_number(object, "depth", (double)depth_decode(target->depth_format, words->depth[sample]));
    if (stencil_mask(target->depth_format))
        add_number(object, "stencil", words->depth[sample] & stencil_mask(target->depth_format));
    return object;
}

/* For each sample: colours, depth, stencil. */
static cJSON *words_of(const struct target *target, const struct pixel_words *words)
{
    cJSON *array = cJSON_CreateArray();
    unsigned saved = mxcsr_enter();
    for (uint32_t i = 0; i < target->samples; i++)
        cJSON_AddItemToArray(array, sample_words(target, words, i));
    mxcsr_leave(saved);
    return array;
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

/* The words of comparisons are those of the state zfunc. */
static const char *compare_word(unsigned function)
{
    const struct triptych_state_row *row = triptych_state_at(TRIPTYCH_RENDER_STATES, TRIPTYCH_STATE_ZFUNC);
    return triptych_value_word(row->kind, function + 1);
}

static bool is_seen(const struct touch *touch, enum observed name, unsigned number)
{
    return touch->seen[name] >> number & 1;
}

static bool passes(const struct touch *touch, enum observed name, unsigned number)
{
    return !is_seen(touch, name, number) || touch->value[name][number][0];
}

static cJSON *add_test(cJSON *object, const char *name, const struct touch *touch, enum observed test,
                       unsigned number, unsigned function)
{
    cJSON *added = cJSON_AddObjectToObject(object, name);
    cJSON_AddStringToObject(added, "function", compare_word(function));
    cJSON_AddBoolToObject(added, "passes", passes(touch, test, number));
    return added;
}

static void add_stencil(cJSON *object, const struct touch *touch, uint32_t word, unsigned sample)
{
    const struct touch_tests *tests = &touch->tests;
    cJSON *test = add_test(object, "stencil", touch, OBSERVED_stencil, sample, tests->stencil);
    add_number(test, "reference", tests->stencil_reference);
    add_number(test, "mask", tests->stencil_mask);
    add_number(test, "stored", word & 255);
}

static void add_depth(cJSON *object, const struct target *target, const struct touch *touch, uint32_t word,
                      unsigned sample)
{
    cJSON *test = add_test(object, "depth", touch, OBSERVED_depth, sample, touch->tests.depth);
    add_number(test, "value", (double)bits_to_float(touch->value[OBSERVED_depth_value][sample][0]));
    add_number(test, "stored", (double)depth_decode(target->depth_format, word));
}

/* Each sample's coverage and tests. A test that follows one that failed is left out. */
static cJSON *tests_of(const struct target *target, const struct touch *touch)
{
    cJSON *array = cJSON_CreateArray();
    for (uint32_t i = 0; i < target->samples; i++) {
        cJSON *sample = add_object(array);
        bool covered = touch->value[OBSERVED_covered][i][0];
        uint32_t word = touch->before.depth[i];
        cJSON_AddBoolToObject(sample, "covered", covered);
        if (!covered)
            continue;
        if (is_seen(touch, OBSERVED_remaining, i))
            cJSON_AddBoolToObject(sample, "remaining", passes(touch, OBSERVED_remaining, i));
        if (is_seen(touch, OBSERVED_stencil, i))
            add_stencil(sample, touch, word, i);
        if (is_seen(touch, OBSERVED_depth, i) && passes(touch, OBSERVED_stencil, i))
            add_depth(sample, target, touch, word, i);
    }
    return array;
}

static bool sample_passes(const struct touch *touch, unsigned sample)
{
    return touch->value[OBSERVED_covered][sample][0] && passes(touch, OBSERVED_remaining, sample) &&
           passes(touch, OBSERVED_stencil, sample) && passes(touch, OBSERVED_depth, sample);
}

/* The first test that leaves no sample. */
static const char *result_of(const struct target *target, const struct touch *touch)
{
    bool remaining = false, stencil = false, all = false;
    if (touch->kind != TOUCH_DRAWN)
        return touch->kind == TOUCH_CULLED ? "culled" : "scissored";
    for (uint32_t i = 0; i < target->samples; i++) {
        bool covered = touch->value[OBSERVED_covered][i][0] && passes(touch, OBSERVED_remaining, i);
        remaining |= covered;
        stencil |= covered && passes(touch, OBSERVED_stencil, i);
        all |= sample_passes(touch, i);
    }
    if (!passes(touch, OBSERVED_kept, 0))
        return "discarded by the shader";
    if (!passes(touch, OBSERVED_alpha, 0))
        return "failed alpha";
    if (!remaining)
        return "covers no sample by alpha";
    return !stencil ? "failed stencil" : !all ? "failed depth" : "passed";
}

/* --- Primitives ----------------------------------------------------------------------------------------- */

/* Adds an array of the colours with the name, each with its number; none: adds nothing. */
static void add_colors(cJSON *object, const char *name, const char *number, const struct touch *touch,
                       enum observed bytes, enum observed numbers)
{
    cJSON *array = NULL;
    for (unsigned i = 0; i < OBSERVED_NUMBERS; i++) {
        cJSON *color = is_seen(touch, bytes, i)     ? packed(touch->value[bytes][i])
                       : is_seen(touch, numbers, i) ? exact(touch->value[numbers][i])
                                                    : NULL;
        if (!color)
            continue;
        if (!array)
            array = cJSON_AddArrayToObject(object, name);
        add_number(color, number, i);
        cJSON_AddItemToArray(array, color);
    }
}

static void add_shading(cJSON *object, const struct touch *touch)
{
    bool shaded = is_seen(touch, OBSERVED_shaded, 0) && passes(touch, OBSERVED_shaded, 0);
    cJSON_AddBoolToObject(object, "shaded", shaded);
    if (!shaded)
        return;
    add_colors(object, "texels", "stage", touch, OBSERVED_texel, OBSERVED_texel_exact);
    add_colors(object, "stages", "stage", touch, OBSERVED_stage, OBSERVED_stage_exact);
    add_colors(object, "colors", "target", touch, OBSERVED_color, OBSERVED_color_exact);
    if (is_seen(touch, OBSERVED_kept, 0))
        cJSON_AddBoolToObject(object, "kept", passes(touch, OBSERVED_kept, 0));
    if (!is_seen(touch, OBSERVED_alpha, 0) || !passes(touch, OBSERVED_kept, 0))
        return;
    cJSON *test = add_test(object, "alpha", touch, OBSERVED_alpha, 0, touch->tests.alpha);
    add_number(test, "value", touch->value[OBSERVED_alpha_value][0][0]);
    add_number(test, "reference", touch->tests.alpha_reference);
}

static cJSON *primitive_of(const struct target *target, const struct touch *touch)
{
    cJSON *object = cJSON_CreateObject(), *vertices;
    add_number(object, "instance", touch->instance);
    add_number(object, "primitive", touch->primitive);
    vertices = cJSON_AddArrayToObject(object, "vertices");
    for (uint32_t i = 0; i < touch->vertices; i++)
        cJSON_AddItemToArray(vertices, cJSON_CreateNumber(touch->vertex[i]));
    cJSON_AddBoolToObject(object, "clipped", touch->clipped);
    cJSON_AddStringToObject(object, "result", result_of(target, touch));
    if (touch->kind != TOUCH_DRAWN)
        return object;
    cJSON_AddItemToObject(object, "tests", tests_of(target, touch));
    add_shading(object, touch);
    cJSON_AddItemToObject(object, "before", words_of(target, &touch->before));
    cJSON_AddItemToObject(object, "after", words_of(target, &touch->after));
    return object;
}

/* --- Events --------------------------------------------------------------------------------------------- */

static cJSON *event_of(struct trail *trail, const struct trail_event *event)
{
    const struct target *target = device_target(trail->device);
    cJSON *object = cJSON_CreateObject();
    if (event->draw != TRAIL_LAST)
        add_number(object, "draw", event->draw);
    inspection_call(trail, event->position, object);
    cJSON_AddItemToObject(object, "before", words_of(target, &event->before));
    if (event->draw != TRAIL_LAST) {
        cJSON *primitives = cJSON_AddArrayToObject(object, "primitives");
        for (uint32_t i = 0; i < event->touches; i++)
            cJSON_AddItemToArray(primitives, primitive_of(target, trail->touch + event->touch + i));
    }
    cJSON_AddItemToObject(object, "after", words_of(target, &event->after));
    return object;
}

cJSON *inspection_history(struct trail *trail, struct error *error)
{
    const struct trail_canvas *canvas = inspection_canvas(trail);
    const struct target *target = device_target(trail->device);
    uint32_t x = (uint32_t)trail->options.x, y = (uint32_t)trail->options.y;
    if (x >= canvas->width || y >= canvas->height) {
        error_set(error, "pixel %u,%u is outside of the target of %u x %u pixels", x, y, canvas->width,
                  canvas->height);
        return NULL;
    }
    cJSON *object = cJSON_CreateObject();
    add_number(object, "x", x);
    add_number(object, "y", y);
    cJSON *events = cJSON_AddArrayToObject(object, "events");
    for (uint32_t i = 0; i < trail->events; i++)
        if (trail->canvas + trail->event[i].canvas == canvas)
            cJSON_AddItemToArray(events, event_of(trail, trail->event + i));
    cJSON_AddItemToObject(object, "last", words_of(target, &canvas->last));
    cJSON_AddBoolToObject(object, "complete", !trail->incomplete);
    return object;
}
