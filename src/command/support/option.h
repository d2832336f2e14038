/* Long options, described by a table: `--name value`, `--name=value`, `--name`, in any order with the
 * operands.
 *
 * Every command also takes --help, whose text is made from the same table, and `--`, after which all
 * arguments are operands. */
#ifndef COMMAND_SUPPORT_OPTION_H
#define COMMAND_SUPPORT_OPTION_H

#include "command/support/tool.h"

enum option_kind {
    OPTION_FLAG,   /* value: bool */
    OPTION_TEXT,   /* value: const char *, not empty */
    OPTION_NUMBER, /* value: unsigned, from least to most */
    OPTION_SECONDS /* value: double, from least to most */
};

struct option {
    const char *name;     /* without dashes */
    const char *argument; /* the name of its value in the help; null for a flag */
    const char *meaning;
    enum option_kind kind;
    void *value; /* holds the default; the last occurrence of the option sets it */
    unsigned least, most;
};

struct operands {
    int least, most; /* their allowed number */
    int count;
    char **value;
};

enum { ANY_NUMBER = 0x7fffffff };

enum options_result {
    OPTIONS_GO,   /* the command can run */
    OPTIONS_DONE, /* --help was printed: exit with STATUS_OK */
    OPTIONS_BAD   /* the reason was printed: exit with STATUS_BAD */
};

/* Reads a command line. Moves the operands to the front of `arguments`, in order. `notes`, the last paragraph
 * of the help, may be null. */
enum options_result options_read(const struct command *self, const struct option *options,
                                 unsigned option_count, const char *notes, int count, char **arguments,
                                 struct operands *operands);

/* The exit status of a result other than OPTIONS_GO. */
static inline int options_status(enum options_result result)
{
    return result == OPTIONS_DONE ? STATUS_OK : STATUS_BAD;
}

/* Copies the next item of a comma-separated list to `piece`, or an empty string if it does not fit. Returns
 * the rest of the list, or null after the last item. */
const char *option_next_item(const char *list, char *piece, unsigned capacity);

/* Reads a whole decimal number from `least` to `most`. Returns true if `text` is one. */
bool option_read_number(const char *text, unsigned least, unsigned most, unsigned *value);

#endif
