#include "setting/setting.h"

#include "base/words.h"

#include <stdio.h>
#include <string.h>

struct value {
    const char *name, *meaning;
};

#define VALUE(setting, name, meaning)  {#name, meaning},
#define SETTING(name, meaning, values) static const struct value name##_values[] = {values{0}};
#include "def/setting.def"
#undef SETTING

static const struct row {
    const char *name, *meaning;
    const struct value *value;
} rows[] = {
#define SETTING(name, meaning, values) {#name, meaning, name##_values},
#include "def/setting.def"
#undef SETTING
};
#undef VALUE

static const char *const choices[] = {
#define VALUE(setting, name, meaning)  #setting "=" #name,
#define SETTING(name, meaning, values) values
#include "def/setting.def"
#undef SETTING
#undef VALUE
};

const char *setting_name(unsigned setting)
{
    return setting < SETTING_COUNT ? rows[setting].name : NULL;
}

const char *setting_meaning(unsigned setting)
{
    return setting < SETTING_COUNT ? rows[setting].meaning : NULL;
}

/* The row of a value, or the empty last row. */
static const struct value *find_value(unsigned setting, unsigned value)
{
    static const struct value none;
    const struct value *found = setting < SETTING_COUNT ? rows[setting].value : &none;
    while (found->name && value--)
        found++;
    return found;
}

const char *setting_value_name(unsigned setting, unsigned value)
{
    return find_value(setting, value)->name;
}

const char *setting_value_meaning(unsigned setting, unsigned value)
{
    return find_value(setting, value)->meaning;
}

const char *setting_choice(unsigned i)
{
    return i < sizeof choices / sizeof *choices ? choices[i] : NULL;
}

/* --- Texts ---------------------------------------------------------------------------------------------- */

static const char *value_at(const struct words *words, unsigned index)
{
    return setting_value_name(words->count, index);
}

static int refuse(struct words words, const char *text, size_t length, struct error *error)
{
    char all[ERROR_CAPACITY / 2];
    words_join(words, all, sizeof all);
    error_set(error, "settings have \"%.*s\", expected one of: %s", (int)(length < 64 ? length : 64), text,
              all);
    return words_suggest_in(words, text, length, error);
}

/* Reads NAME=VALUE, `length` bytes. */
static int read_pair(const char *pair, size_t length, struct setting_values *values, struct error *error)
{
    size_t name = strcspn(pair, "=,");
    unsigned setting, value;
    if (!words_find(WORDS_OF_ROWS(rows), pair, name, &setting))
        return refuse(WORDS_OF_ROWS(rows), pair, name, error);
    const struct words all = {.at = value_at, .count = setting};
    if (name == length)
        return error_set(error, "settings have \"%s\" without a value, expected %s=VALUE", rows[setting].name,
                         rows[setting].name);
    if (!words_find(all, pair + name + 1, length - name - 1, &value))
        return refuse(all, pair + name + 1, length - name - 1, error);
    values->of[setting] = (uint8_t)value;
    return 0;
}

int setting_read(const char *list, struct setting_values *values, struct error *error)
{
    while (list && *list) {
        size_t length = strcspn(list, ",");
        if (read_pair(list, length, values, error))
            return -1;
        list += length + (list[length] == ',');
    }
    return 0;
}

const char *setting_write(const struct setting_values *values, char text[SETTING_TEXT])
{
    size_t length = 0;
    *text = 0;
    for (unsigned i = 0; i < SETTING_COUNT; i++)
        if (values->of[i] && length < SETTING_TEXT)
            length += (size_t)snprintf(text + length, SETTING_TEXT - length, "%s%s=%s", length ? "," : "",
                                       rows[i].name, setting_value_name(i, values->of[i]));
    return text;
}
