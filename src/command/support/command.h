/* A subcommand as data: its options, its operands and its texts.
 *
 * src/command/tool makes everything from these tables: it reads the command line into the settings of the
 * subcommand, prints --help, and writes the manual pages and the completions of shells. docs/extending.md
 * shows how to add an option and a subcommand. */
#ifndef COMMAND_SUPPORT_COMMAND_H
#define COMMAND_SUPPORT_COMMAND_H

#include <stdbool.h>
#include <stddef.h>

/* A list of words: the word of that index, null after the last. */
typedef const char *option_words(unsigned index);

enum option_kind {
    OPTION_FLAG,    /* bool */
    OPTION_TEXT,    /* const char *, not empty */
    OPTION_LIST,    /* the same: words, separated by commas */
    OPTION_FILE,    /* the same: the path of a file that is written; - is standard output */
    OPTION_INPUT,   /* the same: the path of a file that is read; - is standard input */
    OPTION_FOLDER,  /* the same: the path of a folder */
    OPTION_WORD,    /* const char *: one of `words` */
    OPTION_WORDS,   /* struct option_given: one of `words`, which each occurrence of the option adds */
    OPTION_INDEX,   /* unsigned: the index of one of `words` */
    OPTION_NUMBER,  /* unsigned, from least to most */
    OPTION_SECONDS, /* double, from least to most */
};

/* A row of a table that ends with an empty row. `kind` and `value` are written together: OPTION_IS_NUMBER(
 * struct settings, draw). */
struct option {
    const char *name;     /* without dashes */
    const char *argument; /* the name of its value in the help; null for a flag */
    const char *meaning;  /* one phrase; only a default follows a semicolon: "which frame, from 0; 0" */
    enum option_kind kind;
    bool suffixed;         /* of a word: a colon and more may follow it, which the command checks */
    size_t value;          /* offset in the settings; the last occurrence of the option sets it */
    unsigned least, most;  /* of numbers and seconds */
    option_words *words;   /* of words, indices and lists; may be null for a list */
    const char *extension; /* of a file: the extensions that completion offers, such as "tri trib"; or null */
};

enum { OPTION_GIVEN = 32 };

/* The words of an option that may be repeated. */
struct option_given {
    unsigned count;
    const char *word[OPTION_GIVEN];
};

/* The offset of a member, if it has that type; otherwise the program does not compile. */
#define OPTION_OFFSET(structure, member, type)                                                               \
    _Generic(&((structure *)0)->member, type * : offsetof(structure, member))

#define OPTION_IS_FLAG(structure, member) .kind = OPTION_FLAG, .value = OPTION_OFFSET(structure, member, bool)
#define OPTION_IS_TEXT(structure, member)                                                                    \
    .kind = OPTION_TEXT, .value = OPTION_OFFSET(structure, member, const char *)
#define OPTION_IS_LIST(structure, member)                                                                    \
    .kind = OPTION_LIST, .value = OPTION_OFFSET(structure, member, const char *)
#define OPTION_IS_FILE(structure, member)                                                                    \
    .kind = OPTION_FILE, .value = OPTION_OFFSET(structure, member, const char *)
#define OPTION_IS_INPUT(structure, member)                                                                   \
    .kind = OPTION_INPUT, .value = OPTION_OFFSET(structure, member, const char *)
#define OPTION_IS_FOLDER(structure, member)                                                                  \
    .kind = OPTION_FOLDER, .value = OPTION_OFFSET(structure, member, const char *)
#define OPTION_IS_WORD(structure, member)                                                                    \
    .kind = OPTION_WORD, .value = OPTION_OFFSET(structure, member, const char *)
#define OPTION_IS_WORDS(structure, member)                                                                   \
    .kind = OPTION_WORDS, .value = OPTION_OFFSET(structure, member, struct option_given)
#define OPTION_IS_INDEX(structure, member)                                                                   \
    .kind = OPTION_INDEX, .value = OPTION_OFFSET(structure, member, unsigned)
#define OPTION_IS_NUMBER(structure, member)                                                                  \
    .kind = OPTION_NUMBER, .value = OPTION_OFFSET(structure, member, unsigned)
#define OPTION_IS_SECONDS(structure, member)                                                                 \
    .kind = OPTION_SECONDS, .value = OPTION_OFFSET(structure, member, double)

/* A row of a table that ends with an empty row. */
struct operand {
    const char *name; /* as the help shows it: STREAM */
    const char *meaning;
    enum operand_kind {
        OPERAND_INPUT,  /* the path of a file that is read; - is standard input */
        OPERAND_OUTPUT, /* the path of a file that is written; - is standard output */
        OPERAND_WORD,   /* one of `words` */
        OPERAND_TEXT,   /* anything */
    } kind;
    option_words *words;
    const char *extension; /* as in struct option */
    bool optional;
    bool repeated;     /* any number of times; only the last operand can be */
    bool ends_options; /* of the first operand: all arguments after it are operands */
};

/* The operands of a command line. Those that are -, and are files, have been replaced by the paths of the
 * standard streams (base/file.h), as have values of options. */
struct operands {
    int count;
    char **value;
    unsigned word; /* the index of the word that an operand of OPERAND_WORD is */
};

struct command {
    const char *name;
    const char *summary;
    const struct option *options;   /* may be null if there is none */
    const struct operand *operands; /* may be null if there is none */
    const char *notes;              /* the last paragraphs of the help; may be null */
    const void *defaults;           /* the settings before options are read; null: all zero */
    size_t settings_bytes;
    /* Runs the command with settings of its own. Returns the exit status (tool.h). */
    int (*run)(const struct command *self, void *settings, const struct operands *operands);
};

/* The commands of command.def: command_NAME. */
#define COMMAND(name) extern const struct command command_##name;
#include "command/support/command.def"
#undef COMMAND

#endif
