/* Settings of the renderer: how it works, and never what it draws (def/setting.def).
 *
 * A device has one value of each. As text they are a list of NAME=VALUE, separated by commas:
 * "order=stripes,geometry=serial". Settings that the text does not name have their default. A setting can
 * be named twice: the last value counts. */
#ifndef SETTING_SETTING_H
#define SETTING_SETTING_H

#include "base/error.h"

#include <stdint.h>

enum setting_number {
#define SETTING(name, meaning, values) SETTING_##name,
#define VALUE(setting, name, meaning)
#include "def/setting.def"
#undef VALUE
#undef SETTING
    SETTING_COUNT
};

#define SETTING(name, meaning, values) enum setting_##name{values};
#define VALUE(setting, name, meaning)  SETTING_##setting##_##name,
#include "def/setting.def"
#undef VALUE
#undef SETTING

/* The number of the value of each setting: 0 is the default. */
struct setting_values {
    uint8_t of[SETTING_COUNT];
};

/* The names and meanings of the settings and their values, null past the last. */
const char *setting_name(unsigned setting);
const char *setting_meaning(unsigned setting);
const char *setting_value_name(unsigned setting, unsigned value);
const char *setting_value_meaning(unsigned setting, unsigned value);

/* All pairs as texts, "order=tiles" and so on; null past the last. */
const char *setting_choice(unsigned i);

/* Sets the values that a list names; null names none. Returns 0, or -1 with the reason. */
int setting_read(const char *list, struct setting_values *values, struct error *error);

enum { SETTING_TEXT = 512 };

/* Writes the list of the values that are not defaults, and returns it. */
const char *setting_write(const struct setting_values *values, char text[SETTING_TEXT]);

#endif
