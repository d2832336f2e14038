#include "command/support/option.h"
#include "base/file.h"
#include "base/words.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *option_next_item(const char *list, char *piece, unsigned capacity)
{
    if (!list || !*list)
        return NULL;
    size_t length = strcspn(list, ",");
    snprintf(piece, capacity, "%.*s", length < capacity ? (int)length : 0, list);
    return list[length] ? list + length + 1 : list + length;
}

bool option_read_number(const char *text, unsigned least, unsigned most, unsigned *value)
{
    if (!*text || text[strspn(text, "0123456789")] || strlen(text) > 10)
        return false;
    unsigned long long number = strtoull(text, NULL, 10);
    if (number < least || number > most)
        return false;
    *value = (unsigned)number;
    return true;
}

static bool seconds_read(const char *text, unsigned least, unsigned most, double *value)
{
    if (!*text || text[strspn(text, "0123456789.")])
        return false;
    char *end;
    double seconds = strtod(text, &end);
    if (*end || seconds < least || seconds > most)
        return false;
    *value = seconds;
    return true;
}

/* --- The help ------------------------------------------------------------------------------------------- */

const char *options_usage(const struct command *self, char text[OPTIONS_USAGE])
{
    int length = 0;
    *text = 0;
    for (const struct operand *operand = self->operands; operand && operand->name; operand++)
        length += snprintf(text + length, OPTIONS_USAGE - (size_t)length, "%s%s%s%s%s", length ? " " : "",
                           operand->optional ? "[" : "", operand->name, operand->repeated ? "..." : "",
                           operand->optional ? "]" : "");
    return text;
}

const char *options_meaning(const struct option *option, char text[OPTIONS_MEANING])
{
    const char *semicolon = strrchr(option->meaning, ';');
    if (semicolon)
        snprintf(text, OPTIONS_MEANING, "%.*s (default: %s)", (int)(semicolon - option->meaning),
                 option->meaning, semicolon + 2);
    else
        snprintf(text, OPTIONS_MEANING, "%s", option->meaning);
    return text;
}

void options_print_help(const struct command *self, FILE *out)
{
    char usage[OPTIONS_USAGE], meaning[OPTIONS_MEANING];
    options_usage(self, usage);
    fprintf(out, "usage: triptych %s [OPTIONS]%s%s\n\n%s\n\n", self->name, *usage ? " " : "", usage,
            self->summary);
    for (const struct option *option = self->options; option && option->name; option++) {
        char left[64];
        snprintf(left, sizeof left, "--%s%s%s", option->name, option->argument ? " " : "",
                 option->argument ? option->argument : "");
        fprintf(out, "  %-22s %s\n", left, options_meaning(option, meaning));
    }
    fprintf(out, "  %-22s %s\n", "-h, --help", "this text");
    if (self->notes)
        fprintf(out, "\n%s\n", self->notes);
}

/* --- Words ---------------------------------------------------------------------------------------------- */

static const char *option_name_at(const struct words *words, unsigned index)
{
    static const char help[] = "help";
    const struct option *options = words->list;
    unsigned i = 0;
    while (i < index && options && options[i].name)
        i++;
    return options && options[i].name ? options[i].name : i == index ? help : NULL;
}

static const char *word_at(const struct words *words, unsigned index)
{
    option_words *const *at = words->list;
    return (*at)(index);
}

static int unknown_option(const struct command *self, const char *given)
{
    struct words names = {option_name_at, .list = self->options};
    char list[512] = "";
    const char *name;
    for (unsigned i = 0; (name = names.at(&names, i)); i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s--%s", i ? ", " : "", name);
    const char *bare = given + strspn(given, "-"), *near = words_nearest(names, bare, strcspn(bare, "="));
    return tool_fail(self, "unknown option %s, expected one of: %s%s%s%s", given, list,
                     near ? "; did you mean --" : "", near ? near : "", near ? "?" : "");
}

/* Finds the word, or prints the words. `what` is the option or operand, and a verb. */
static int find_word(const struct command *self, const char *what, option_words *words, const char *given,
                     size_t length, unsigned *index)
{
    struct words list = {word_at, .list = &words};
    return words_find(list, given, length, index) ? STATUS_OK : tool_fail_word(self, what, given, list);
}

/* --- Values --------------------------------------------------------------------------------------------- */

/* The command line while it is read. */
struct reading {
    const struct command *self;
    char *settings;
    bool input_taken, output_taken; /* by a - */
};

static int take_standard(struct reading *reading, const char *what, bool output, const char **path)
{
    bool *taken = output ? &reading->output_taken : &reading->input_taken;
    if (*taken)
        return tool_fail(reading->self, "%s is \"-\", expected a file: standard %s has another use", what,
                         output ? "output" : "input");
    *taken = true;
    *path = output ? file_standard_output : file_standard_input;
    if (output)
        tool_print_to_error();
    return STATUS_OK;
}

static int store_path(struct reading *reading, const struct option *option, const char *text)
{
    char what[64];
    const char **path = (const char **)(reading->settings + option->value);
    snprintf(what, sizeof what, "--%s", option->name);
    *path = text;
    return strcmp(text, "-") ? STATUS_OK : take_standard(reading, what, option->kind == OPTION_FILE, path);
}

static int add_word(struct reading *reading, const struct option *option, const char *text)
{
    struct option_given *given = (struct option_given *)(void *)(reading->settings + option->value);
    if (given->count == OPTION_GIVEN)
        return tool_fail(reading->self, "--%s is given more than %d times", option->name, OPTION_GIVEN);
    given->word[given->count++] = text;
    return STATUS_OK;
}

static int store_word(struct reading *reading, const struct option *option, const char *text)
{
    char what[64];
    unsigned index;
    snprintf(what, sizeof what, "--%s is", option->name);
    if (find_word(reading->self, what, option->words, text,
                  option->suffixed ? strcspn(text, ":") : strlen(text), &index))
        return STATUS_BAD;
    if (option->kind == OPTION_WORDS)
        return add_word(reading, option, text);
    if (option->kind == OPTION_INDEX)
        *(unsigned *)(reading->settings + option->value) = index;
    else
        *(const char **)(reading->settings + option->value) = text;
    return STATUS_OK;
}

static int store_number(struct reading *reading, const struct option *option, const char *text)
{
    void *value = reading->settings + option->value;
    if (option->kind == OPTION_NUMBER ? option_read_number(text, option->least, option->most, value)
                                      : seconds_read(text, option->least, option->most, value))
        return STATUS_OK;
    return tool_fail(reading->self, "--%s is \"%s\", expected a %s from %u to %u", option->name, text,
                     option->kind == OPTION_NUMBER ? "whole number" : "number of seconds", option->least,
                     option->most);
}

static int store(struct reading *reading, const struct option *option, const char *text)
{
    if (!*text && option->kind != OPTION_NUMBER && option->kind != OPTION_SECONDS)
        return tool_fail(reading->self, "--%s is empty, expected %s", option->name, option->argument);
    switch (option->kind) {
    case OPTION_FLAG: break; /* has no text */
    case OPTION_TEXT:
    case OPTION_LIST:
    case OPTION_FOLDER: *(const char **)(reading->settings + option->value) = text; break;
    case OPTION_FILE:
    case OPTION_INPUT: return store_path(reading, option, text);
    case OPTION_WORD:
    case OPTION_WORDS:
    case OPTION_INDEX: return store_word(reading, option, text);
    case OPTION_NUMBER:
    case OPTION_SECONDS: return store_number(reading, option, text);
    }
    return STATUS_OK;
}

static const struct option *find_option(const struct command *self, const char *name, size_t length)
{
    for (const struct option *option = self->options; option && option->name; option++)
        if (strlen(option->name) == length && !memcmp(option->name, name, length))
            return option;
    return NULL;
}

/* Reads the option at arguments[*at] and moves *at to the last argument that it used. */
static int read_option(struct reading *reading, int count, char **arguments, int *at)
{
    const char *given = arguments[*at], *name = given + 2;
    size_t length = strcspn(name, "=");
    const struct option *option = strncmp(given, "--", 2) ? NULL : find_option(reading->self, name, length);
    if (!option)
        return unknown_option(reading->self, given);
    const char *text = name[length] ? name + length + 1 : NULL;
    if (option->kind == OPTION_FLAG) {
        *(bool *)(reading->settings + option->value) = true;
        return text ? tool_fail(reading->self, "--%s takes no value", option->name) : STATUS_OK;
    }
    if (!text && *at + 1 == count)
        return tool_fail(reading->self, "--%s has no value, expected %s", option->name, option->argument);
    return store(reading, option, text ? text : arguments[++*at]);
}

/* --- Operands ------------------------------------------------------------------------------------------- */

static int check_operand(struct reading *reading, const struct operand *operand, struct operands *operands,
                         int number)
{
    char **value = operands->value + number, what[64];
    const char *path = *value;
    snprintf(what, sizeof what, "%s is", operand->name);
    if (operand->kind == OPERAND_WORD)
        return find_word(reading->self, what, operand->words, *value, strlen(*value), &operands->word);
    if (operand->kind == OPERAND_TEXT)
        return STATUS_OK;
    if (!strcmp(path, "-") && take_standard(reading, operand->name, operand->kind == OPERAND_OUTPUT, &path))
        return STATUS_BAD;
    *value = (char *)(uintptr_t)path; /* arguments of main are not const */
    return STATUS_OK;
}

static int check_operands(struct reading *reading, struct operands *operands)
{
    const struct command *self = reading->self;
    const struct operand *operand = self->operands;
    char usage[OPTIONS_USAGE];
    options_usage(self, usage);
    for (int i = 0; i < operands->count; i++) {
        if (!operand || !operand->name)
            return tool_fail(self, "unexpected \"%s\", expected only %s", operands->value[i],
                             *usage ? usage : "options");
        if (check_operand(reading, operand, operands, i))
            return STATUS_BAD;
        operand += !operand->repeated || i + 1 == operands->count;
    }
    if (operand && operand->name && !operand->optional)
        return tool_fail(self, "expected %s, got %d of them", usage, operands->count);
    return STATUS_OK;
}

/* --- Files that are read and written -------------------------------------------------------------------- */

/* Finds an input that is the output: a file that would be replaced by what is made from it. */
static int check_output(const struct reading *reading, const struct operands *operands, const char *what,
                        const char *output)
{
    const struct command *self = reading->self;
    const struct operand *operand = self->operands;
    for (const struct option *option = self->options; option && option->name; option++) {
        const char *input =
            option->kind == OPTION_INPUT ? *(const char **)(reading->settings + option->value) : NULL;
        if (input && tool_is_same_file(output, input))
            return tool_fail(self, "%s is \"%s\", the file of --%s, expected another", what, output,
                             option->name);
    }
    for (int i = 0; i < operands->count; operand += !operand->repeated, i++)
        if (operand->kind == OPERAND_INPUT && tool_is_same_file(output, operands->value[i]))
            return tool_fail(self, "%s is \"%s\", the file of %s, expected another", what, output,
                             operand->name);
    return STATUS_OK;
}

static int check_outputs(const struct reading *reading, const struct operands *operands)
{
    const struct command *self = reading->self;
    const struct operand *operand = self->operands;
    char what[64];
    for (const struct option *option = self->options; option && option->name; option++) {
        const char *output =
            option->kind == OPTION_FILE ? *(const char **)(reading->settings + option->value) : NULL;
        snprintf(what, sizeof what, "--%s", option->name);
        if (output && check_output(reading, operands, what, output))
            return STATUS_BAD;
    }
    for (int i = 0; i < operands->count; operand += !operand->repeated, i++)
        if (operand->kind == OPERAND_OUTPUT &&
            check_output(reading, operands, operand->name, operands->value[i]))
            return STATUS_BAD;
    return STATUS_OK;
}

enum options_result options_read(const struct command *self, int count, char **arguments, void *settings,
                                 struct operands *operands)
{
    struct reading reading = {.self = self, .settings = settings};
    bool all_operands = false;
    *operands = (struct operands){.value = arguments};
    for (int i = 0; i < count; i++) {
        char *given = arguments[i];
        if (all_operands || given[0] != '-' || !given[1]) {
            arguments[operands->count++] = given;
            all_operands |= self->operands && self->operands->ends_options;
        } else if (!strcmp(given, "--")) {
            all_operands = true;
        } else if (!strcmp(given, "--help") || !strcmp(given, "-h")) {
            return OPTIONS_HELP;
        } else if (read_option(&reading, count, arguments, &i)) {
            return OPTIONS_BAD;
        }
    }
    return check_operands(&reading, operands) || check_outputs(&reading, operands) ? OPTIONS_BAD : OPTIONS_GO;
}
