/* Command lines, read into the settings of a subcommand (command.h): `--name value`, `--name=value` and
 * `--name`, in any order with the operands.
 *
 * Every command also takes --help and -h, and `--`, after which all arguments are operands. */
#ifndef COMMAND_SUPPORT_OPTION_H
#define COMMAND_SUPPORT_OPTION_H

#include "command/support/command.h"
#include "command/support/tool.h"

#include <stdio.h>

enum options_result {
    OPTIONS_GO,   /* the command can run */
    OPTIONS_HELP, /* the help is requested, and the rest is not read */
    OPTIONS_BAD   /* the reason was printed: exit with STATUS_BAD */
};

/* Reads a command line. `settings` has the defaults. Moves the operands to the front of `arguments`, in
 * order. */
enum options_result options_read(const struct command *self, int count, char **arguments, void *settings,
                                 struct operands *operands);

/* The operands as the help shows them: "STREAM...". */
enum { OPTIONS_USAGE = 64 };
const char *options_usage(const struct command *self, char text[OPTIONS_USAGE]);

/* The meaning of an option for people: "which frame, from 0 (default: 0)". */
enum { OPTIONS_MEANING = 256 };
const char *options_meaning(const struct option *option, char text[OPTIONS_MEANING]);

void options_print_help(const struct command *self, FILE *out);

/* Copies the next item of a comma-separated list to `piece`, or an empty string if it does not fit. Returns
 * the rest of the list, or null after the last item. */
const char *option_next_item(const char *list, char *piece, unsigned capacity);

/* Reads a whole decimal number from `least` to `most`. Returns true if `text` is one. */
bool option_read_number(const char *text, unsigned least, unsigned most, unsigned *value);

#endif
