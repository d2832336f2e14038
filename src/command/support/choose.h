/* Engines, widths and thread counts on the command line. */
#ifndef COMMAND_SUPPORT_CHOOSE_H
#define COMMAND_SUPPORT_CHOOSE_H

#include "base/error.h"
#include "command/support/command.h"
#include "command/support/tool.h"
#include "setting/setting.h"

enum { CHOICE_CAPACITY = 64 };

struct choice {
    unsigned count;
    unsigned index[CHOICE_CAPACITY]; /* arguments of triptych_engine_name() */
    unsigned left_out_count;         /* engines that are omitted because they cannot run here */
    struct {
        unsigned index;
        char reason[ERROR_CAPACITY];
    } left_out[CHOICE_CAPACITY];
};

/* Options that change all chosen engines that take them (engines/variant.h). */
struct variation {
    const char *registers; /* null: not given */
    struct option_given without;
};

/* The rows of a table of options for a member of that type. */
#define OPTIONS_OF_VARIATION(structure, member)                                                              \
    {"registers", "N", "vector registers of engines that take this option; all",                             \
     OPTION_IS_TEXT(structure, member.registers)},                                                           \
    {                                                                                                        \
        "without", "PASS", "a pass that engines leave out, which may be repeated",                           \
            OPTION_IS_WORDS(structure, member.without), .words = pass_name                                   \
    }

/* Finds the engine of that name, which options may follow. `width`, unless 0, selects the engine's variant of
 * that width: itself or the engine NAME-WIDTH. Returns 0, or STATUS_BAD after printing the alternatives or
 * why it cannot run here. */
int choose_engine(const struct command *self, const char *name, unsigned width, unsigned *index);

/* Reads a comma-separated list of engines, each once. All must be able to run here. A null list means every
 * engine that can run here and is not on request only (engine.on_request); those that cannot run are in
 * left_out. */
int choose_engines(const struct command *self, const char *list, struct choice *choice);

/* Replaces the chosen engines that take options by their variants, if any option is given. Returns 0, or
 * STATUS_BAD after printing the reason, also if no chosen engine takes an option. */
int choose_variants(const struct command *self, const struct variation *variation, struct choice *choice);

/* The settings with these pairs, words of setting_choice. */
struct setting_values choose_settings(const struct option_given *set);

/* The words of the state `precision`, by their numbers; null past the last. */
const char *choose_precision(unsigned i);

enum { SETTINGS_CHOICE = 64 };

/* Settings of the renderer that are compared with each other. */
struct settings_choice {
    unsigned count;
    struct setting_values values[SETTINGS_CHOICE];
};

/* The settings with the pairs of `set`; and the same with each other value of each setting that the
 * comma-separated list names, one at a time. "all" names every setting, null names none. Returns 0, or
 * STATUS_BAD after printing the reason. */
int choose_varied_settings(const struct command *self, const struct option_given *set, const char *list,
                           struct settings_choice *choice);

/* Reads a comma-separated list of thread counts. */
int choose_threads(const struct command *self, const char *list, struct choice *threads);

#endif
