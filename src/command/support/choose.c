#include "command/support/choose.h"
#include "engines/list.h"
#include "engines/variant.h"
#include "command/support/option.h"
#include "triptych.h"

#include <stdio.h>
#include <string.h>

enum { NAME_CAPACITY = ENGINE_NAME_CAPACITY, THREADS_MAXIMUM = 256 };

static const char *engine_at_index(const struct words *words, unsigned index)
{
    (void)words;
    return triptych_engine_name(index);
}

static const struct words engine_names = {.at = engine_at_index};

static bool find_engine(const char *name, unsigned *index)
{
    return words_find(engine_names, name, strlen(name), index);
}

/* Returns true if `engine` is `name` itself or its variant `name`-WIDTH. */
static bool is_variant(unsigned engine, const char *name)
{
    char variant[NAME_CAPACITY];
    if (!strcmp(triptych_engine_name(engine), name))
        return true;
    return snprintf(variant, sizeof variant, "%s-%u", name, triptych_engine_width(engine)) <
               (int)sizeof variant &&
           !strcmp(triptych_engine_name(engine), variant);
}

/* Returns true if the engine has no width in its name and another engine has the same name with the width. */
static bool has_twin(unsigned engine)
{
    char twin[NAME_CAPACITY];
    unsigned index;
    snprintf(twin, sizeof twin, "%s-%u", triptych_engine_name(engine), triptych_engine_width(engine));
    return find_engine(twin, &index);
}

static int find_variant(const struct command *self, const char *name, unsigned width, unsigned *index)
{
    char widths[128] = "";
    for (unsigned i = 0; triptych_engine_name(i); i++) {
        if (!is_variant(i, name))
            continue;
        if (triptych_engine_width(i) == width)
            return *index = i, STATUS_OK;
        if (has_twin(i) || !triptych_engine_width(i))
            continue;
        snprintf(widths + strlen(widths), sizeof widths - strlen(widths), "%s%u", widths[0] ? ", " : "",
                 triptych_engine_width(i));
    }
    return tool_fail(self, "engine %s has no width %u, expected one of: %s", name, width, widths);
}

/* Makes the variant of engine *index with the given options, each after a colon. */
static int add_options(const struct command *self, const char *options, unsigned *index)
{
    struct error error = {""};
    char name[2 * NAME_CAPACITY];
    snprintf(name, sizeof name, "%s%s", triptych_engine_name(*index), options);
    const struct engine *engine = engine_named(name, &error);
    if (!engine)
        return tool_fail(self, "%s", error.text);
    *index = engine_number(engine);
    return STATUS_OK;
}

int choose_engine(const struct command *self, const char *name, unsigned width, unsigned *index)
{
    char plain[NAME_CAPACITY];
    size_t length = strcspn(name, ":");
    snprintf(plain, sizeof plain, "%.*s", (int)(length < sizeof plain ? length : 0), name);
    if (!find_engine(plain, index))
        return tool_fail_word(self, "unknown engine", plain, engine_names);
    if (width && find_variant(self, plain, width, index))
        return STATUS_BAD;
    if (name[length] && add_options(self, name + length, index))
        return STATUS_BAD;
    const char *reason = triptych_engine_unavailable(*index);
    if (reason)
        return tool_fail(self, "engine %s cannot run here: %s", triptych_engine_name(*index), reason);
    return STATUS_OK;
}

static bool is_chosen(const struct choice *choice, unsigned value)
{
    for (unsigned i = 0; i < choice->count; i++)
        if (choice->index[i] == value)
            return true;
    return false;
}

static int add(const struct command *self, struct choice *choice, unsigned value, const char *text)
{
    if (is_chosen(choice, value))
        return tool_fail(self, "\"%s\" is listed twice", text);
    if (choice->count == CHOICE_CAPACITY)
        return tool_fail(self, "more than %d values in a list", CHOICE_CAPACITY);
    choice->index[choice->count++] = value;
    return STATUS_OK;
}

/* The reason is copied, because a second call might find another one, or none. */
static int add_if_available(const struct command *self, struct choice *choice, unsigned engine)
{
    const char *reason = triptych_engine_unavailable(engine);
    if (!reason)
        return add(self, choice, engine, triptych_engine_name(engine));
    unsigned i = choice->left_out_count++;
    choice->left_out[i].index = engine;
    snprintf(choice->left_out[i].reason, sizeof choice->left_out[i].reason, "%s", reason);
    return STATUS_OK;
}

int choose_engines(const struct command *self, const char *list, struct choice *choice)
{
    choice->count = choice->left_out_count = 0;
    for (unsigned i = 0; !list && triptych_engine_name(i); i++)
        if (!engine_at(i)->on_request && add_if_available(self, choice, i))
            return STATUS_BAD;
    char name[NAME_CAPACITY];
    while ((list = option_next_item(list, name, sizeof name))) {
        unsigned index = 0;
        if (choose_engine(self, name, 0, &index) || add(self, choice, index, name))
            return STATUS_BAD;
    }
    return STATUS_OK;
}

/* Writes the options as a part of an engine's name. Returns false if they do not fit. */
static bool write_variation(const struct variation *variation, char text[NAME_CAPACITY])
{
    int length = 0;
    *text = 0;
    if (variation->registers)
        length = snprintf(text, NAME_CAPACITY, ":registers=%s", variation->registers);
    for (unsigned i = 0; i < variation->without.count && length < NAME_CAPACITY; i++)
        length += snprintf(text + length, NAME_CAPACITY - (size_t)length, ":without=%s",
                           variation->without.word[i]);
    return length < NAME_CAPACITY;
}

int choose_variants(const struct command *self, const struct variation *variation, struct choice *choice)
{
    char options[NAME_CAPACITY];
    bool varied = false;
    if (!write_variation(variation, options))
        return tool_fail(self, "--registers and --without are too long");
    if (!*options)
        return STATUS_OK;
    const char *option = variation->registers ? "registers" : "without";
    for (unsigned i = 0; i < choice->count; i++) {
        if (!engine_takes_option(engine_at(choice->index[i]), option))
            continue;
        varied = true;
        if (add_options(self, options, &choice->index[i]))
            return STATUS_BAD;
    }
    return varied ? STATUS_OK
                  : tool_fail(self, "none of the engines takes --%s, expected specialize or one of its kind",
                              option);
}

/* --- Settings of the renderer --- */

struct setting_values choose_settings(const struct option_given *set)
{
    struct setting_values values = {{0}};
    for (unsigned i = 0; i < set->count; i++)
        setting_read(set->word[i], &values, NULL);
    return values;
}

static const char *setting_at(const struct words *words, unsigned index)
{
    (void)words;
    return setting_name(index);
}

/* Adds the first settings of the choice with each other value of one of them. */
static int vary(const struct command *self, unsigned setting, struct settings_choice *choice)
{
    for (unsigned value = 0; setting_value_name(setting, value); value++) {
        if (value == choice->values->of[setting])
            continue;
        if (choice->count == SETTINGS_CHOICE)
            return tool_fail(self, "more than %d settings to compare", SETTINGS_CHOICE);
        choice->values[choice->count] = *choice->values;
        choice->values[choice->count++].of[setting] = (uint8_t)value;
    }
    return STATUS_OK;
}

int choose_varied_settings(const struct command *self, const struct option_given *set, const char *list,
                           struct settings_choice *choice)
{
    const struct words names = {.at = setting_at};
    char name[NAME_CAPACITY];
    unsigned setting = 0;
    choice->count = 1;
    choice->values[0] = choose_settings(set);
    for (; list && !strcmp(list, "all") && setting_name(setting); setting++)
        if (vary(self, setting, choice))
            return STATUS_BAD;
    while (!setting && (list = option_next_item(list, name, sizeof name))) {
        if (!words_find(names, name, strlen(name), &setting))
            return tool_fail_word(self, "--settings has", name, names);
        if (vary(self, setting, choice))
            return STATUS_BAD;
        setting = 0;
    }
    return STATUS_OK;
}

int choose_threads(const struct command *self, const char *list, struct choice *threads)
{
    threads->count = 0;
    char text[NAME_CAPACITY];
    while ((list = option_next_item(list, text, sizeof text))) {
        unsigned count;
        if (!option_read_number(text, 1, THREADS_MAXIMUM, &count))
            return tool_fail(self, "\"%s\" is not a number of threads, expected 1 to %d", text,
                             THREADS_MAXIMUM);
        if (add(self, threads, count, text))
            return STATUS_BAD;
    }
    return STATUS_OK;
}

const char *choose_precision(unsigned i)
{
    const struct triptych_state_row *row =
        triptych_state_at(TRIPTYCH_RENDER_STATES, TRIPTYCH_STATE_PRECISION);
    const struct triptych_value *value = triptych_value_at(row->kind, i);
    return value ? value->word : NULL;
}
