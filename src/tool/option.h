/* Long options, described by a table: `--name value`, `--name=value`, `--name`, in any order with the
 * operands.
 *
 * Every command also takes --help, which is made from the same table, and `--`, behind which all are
 * operands. */
#ifndef TOOL_OPTION_H
#define TOOL_OPTION_H

#include "tool/tool.h"

enum option_kind {
    OPTION_FLAG,   /* value: bool */
    OPTION_TEXT,   /* value: const char *, not empty */
    OPTION_NUMBER, /* value: unsigned, from least to most */
    OPTION_SECONDS /* value: double, from least to most */
};

struct option {
    const char *name;     /* without dashes */
    const char *argument; /* what the help calls its value; null for a flag */
    const char *meaning;
    enum option_kind kind;
    void *value; /* holds the default; written when the option is given, the last time if often */
    unsigned least, most;
};

struct operands {
    int least, most; /* how many there must be */
    int count;
    char **value;
};

enum { ANY_NUMBER = 0x7fffffff };

enum options_result {
    OPTIONS_GO,   /* run the command */
    OPTIONS_DONE, /* help was asked for and printed: exit with STATUS_OK */
    OPTIONS_BAD   /* exit with STATUS_BAD; the reason has been printed */
};

/* Reads a command line. The operands are moved to the front of `arguments`, in order. `notes`, which may be
 * null, is the help's last paragraph. */
enum options_result options_read(const struct command *self, const struct option *options,
                                 unsigned option_count, const char *notes, int count, char **arguments,
                                 struct operands *operands);

/* The exit status when the result is not OPTIONS_GO. */
static inline int options_status(enum options_result result)
{
    return result == OPTIONS_DONE ? STATUS_OK : STATUS_BAD;
}

/* Takes the next piece of a comma-separated list: writes it to `piece` (empty when it does not fit) and
 * returns where to go on, or null when the list has ended. */
const char *list_next(const char *list, char *piece, unsigned capacity);

/* Reads a whole decimal number from least to most. */
bool number_read(const char *text, unsigned least, unsigned most, unsigned *value);

#endif
