#include "command/tool/manual.h"
#include "command/support/option.h"
#include "command/tool/command_line.h"
#include "triptych.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* --- Texts ---------------------------------------------------------------------------------------------- */

/* Prints a part of a line. Hyphens are those of ASCII, so that options can be copied. */
static void put_bytes(const char *text, size_t length, FILE *out)
{
    for (size_t i = 0; i < length; i++)
        if (text[i] == '-')
            fputs("\\-", out);
        else if (text[i] == '\\')
            fputs("\\e", out);
        else
            putc(text[i], out);
}

static void put(const char *text, FILE *out)
{
    put_bytes(text, strlen(text), out);
}

/* The position of the first two spaces in a line, which separate the columns of a table; its length if there
 * are none. */
static size_t column_of(const char *line, size_t length)
{
    for (size_t i = 0; i + 1 < length; i++)
        if (line[i] == ' ' && line[i + 1] == ' ')
            return i;
    return length;
}

/* Prints a row of a table as an indented paragraph. Its tag is not a sign of the language. */
static void put_row(const char *line, size_t column, size_t length, FILE *out)
{
    fputs(".TP\n\\&", out);
    put_bytes(line, column, out);
    putc('\n', out);
    while (column < length && line[column] == ' ')
        column++;
    fputs("\\&", out);
    put_bytes(line + column, length - column, out);
    putc('\n', out);
}

/* Rows of tables become indented paragraphs, other lines are filled. */
static void put_notes(const char *notes, FILE *out)
{
    bool in_table = false;
    for (const char *line = notes; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        size_t length = strcspn(line, "\n"), column = column_of(line, length);
        bool is_row = column && column < length;
        if (!length || (in_table && column == length))
            fputs(".PP\n", out);
        if (is_row) {
            put_row(line, column, length, out);
        } else if (length) {
            size_t spaces = strspn(line, " ");
            fputs("\\&", out);
            put_bytes(line + spaces, length - spaces, out);
            putc('\n', out);
        }
        in_table = length && (is_row || (in_table && !column));
    }
}

/* --- Sections ------------------------------------------------------------------------------------------- */

static void put_title(const char *name, const char *summary, FILE *out)
{
    char title[64];
    snprintf(title, sizeof title, "triptych%s%s", *name ? "-" : "", name);
    fputs(".TH ", out);
    for (const char *c = title; *c; c++)
        putc(toupper((unsigned char)*c), out);
    fprintf(out, " 1 \"\" \"Triptych %s\" \"Triptych\"\n.SH NAME\n", TRIPTYCH_VERSION);
    put(title, out);
    fputs(" \\- ", out);
    put(summary, out);
    fputs("\n.SH SYNOPSIS\n", out);
}

static void put_operands(const struct command *command, FILE *out)
{
    if (!command->operands)
        return;
    fputs(".SH OPERANDS\n", out);
    for (const struct operand *operand = command->operands; operand->name; operand++) {
        fprintf(out, ".TP\n.I %s\n", operand->name);
        put(operand->meaning, out);
        putc('\n', out);
    }
}

static void put_words(option_words *words, FILE *out)
{
    const char *word;
    fputs(".br\nOne of:", out);
    for (unsigned i = 0; (word = words(i)); i++) {
        fputs(i ? ", " : " ", out);
        put(word, out);
    }
    fputs(".\n", out);
}

static void put_option(const struct option *option, FILE *out)
{
    char meaning[OPTIONS_MEANING];
    fputs(".TP\n\\fB\\-\\-", out);
    put(option->name, out);
    fputs("\\fR", out);
    if (option->argument) {
        fputs(" \\fI", out);
        put(option->argument, out);
        fputs("\\fR", out);
    }
    putc('\n', out);
    put(options_meaning(option, meaning), out);
    putc('\n', out);
    if (option->words)
        put_words(option->words, out);
}

static void put_options(const struct command *command, FILE *out)
{
    fputs(".SH OPTIONS\n", out);
    for (const struct option *option = command->options; option && option->name; option++)
        put_option(option, out);
    fputs(".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nprint a summary of these options\n", out);
}

static void put_status(FILE *out)
{
    fputs(".SH EXIT STATUS\n"
          "0 success; 1 a difference was found; 2 bad input or usage, or a refusal by the system; 128 + N "
          "stopped by signal N.\n",
          out);
}

/* --- Pages ---------------------------------------------------------------------------------------------- */

static void print_command(const struct command *command, FILE *out)
{
    char usage[OPTIONS_USAGE];
    put_title(command->name, command->summary, out);
    options_usage(command, usage);
    fprintf(out, ".B triptych %s\n[\\fIOPTIONS\\fR]%s%s\n", command->name, *usage ? " " : "", usage);
    put_operands(command, out);
    put_options(command, out);
    if (command->notes) {
        fputs(".SH NOTES\n", out);
        put_notes(command->notes, out);
    }
    put_status(out);
    fputs(".SH SEE ALSO\n.BR triptych (1)\n", out);
}

static void print_program(FILE *out)
{
    const struct command *command;
    put_title("", "one graphics pipeline run by interchangeable engines", out);
    fputs(".B triptych\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] ...\n.SH COMMANDS\n", out);
    for (unsigned i = 0; (command = command_line_at(i)); i++) {
        fprintf(out, ".TP\n.BR triptych\\-%s (1)\n", command->name);
        put(command->summary, out);
        putc('\n', out);
    }
    fputs(".SH OPTIONS\n"
          ".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nprint the list of commands\n"
          ".TP\n\\fB\\-\\-version\\fR\nprint the version\n"
          ".SH NOTES\n",
          out);
    put_notes(command_line_notes, out);
}

void manual_print(const struct command *command, FILE *out)
{
    if (command)
        print_command(command, out);
    else
        print_program(out);
}
