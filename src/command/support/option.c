#include "command/support/option.h"

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

static void print_help(const struct command *self, const struct option *options, unsigned option_count,
                       const char *notes)
{
    printf("usage: triptych %s [OPTIONS]%s%s\n\n%s\n\n", self->name, *self->operands ? " " : "",
           self->operands, self->summary);
    for (unsigned i = 0; i < option_count; i++) {
        char left[64];
        snprintf(left, sizeof left, "--%s%s%s", options[i].name, options[i].argument ? " " : "",
                 options[i].argument ? options[i].argument : "");
        printf("  %-22s %s\n", left, options[i].meaning);
    }
    printf("  %-22s %s\n", "--help", "this text");
    if (notes)
        printf("\n%s\n", notes);
}

static const struct option *find_option(const struct option *options, unsigned count, const char *name,
                                        size_t length)
{
    for (unsigned i = 0; i < count; i++)
        if (strlen(options[i].name) == length && !memcmp(options[i].name, name, length))
            return options + i;
    return NULL;
}

static int unknown_option(const struct command *self, const struct option *options, unsigned option_count,
                          const char *given)
{
    char names[512] = "";
    for (unsigned i = 0; i < option_count; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "--%s, ", options[i].name);
    return tool_fail(self, "unknown option %s, expected one of: %s--help", given, names);
}

static int bad_value(const struct command *self, const struct option *option, const char *text)
{
    if (option->kind == OPTION_TEXT)
        return tool_fail(self, "--%s is empty, expected %s", option->name, option->argument);
    return tool_fail(self, "--%s is \"%s\", expected a %s from %u to %u", option->name, text,
                     option->kind == OPTION_NUMBER ? "whole number" : "number of seconds", option->least,
                     option->most);
}

static bool store(const struct option *option, const char *text)
{
    switch (option->kind) {
    case OPTION_FLAG: *(bool *)option->value = true; return true;
    case OPTION_TEXT: *(const char **)option->value = text; return *text;
    case OPTION_NUMBER: return option_read_number(text, option->least, option->most, option->value);
    case OPTION_SECONDS: return seconds_read(text, option->least, option->most, option->value);
    }
    return false;
}

/* Reads the option at arguments[*at] and moves *at to the last argument that it used. */
static int read_option(const struct command *self, const struct option *options, unsigned option_count,
                       int count, char **arguments, int *at)
{
    const char *given = arguments[*at];
    const char *name = given + 2;
    size_t length = strcspn(name, "=");
    const struct option *option =
        strncmp(given, "--", 2) ? NULL : find_option(options, option_count, name, length);
    if (!option)
        return unknown_option(self, options, option_count, given);
    const char *text = name[length] ? name + length + 1 : NULL;
    if (option->kind == OPTION_FLAG && text)
        return tool_fail(self, "--%s takes no value", option->name);
    if (option->kind != OPTION_FLAG && !text) {
        if (*at + 1 == count)
            return tool_fail(self, "--%s has no value, expected %s", option->name, option->argument);
        text = arguments[++*at];
    }
    return store(option, text) ? STATUS_OK : bad_value(self, option, text);
}

enum options_result options_read(const struct command *self, const struct option *options,
                                 unsigned option_count, const char *notes, int count, char **arguments,
                                 struct operands *operands)
{
    bool all_operands = false;
    operands->count = 0;
    operands->value = arguments;
    for (int i = 0; i < count; i++) {
        char *given = arguments[i];
        if (all_operands || given[0] != '-' || !given[1]) {
            arguments[operands->count++] = given;
        } else if (!strcmp(given, "--")) {
            all_operands = true;
        } else if (!strcmp(given, "--help")) {
            print_help(self, options, option_count, notes);
            return OPTIONS_DONE;
        } else if (read_option(self, options, option_count, count, arguments, &i)) {
            return OPTIONS_BAD;
        }
    }
    if (operands->count >= operands->least && operands->count <= operands->most)
        return OPTIONS_GO;
    if (operands->count < operands->least)
        tool_fail(self, "expected %s, got %d of them", self->operands, operands->count);
    else
        tool_fail(self, "unexpected \"%s\", expected only %s", arguments[operands->most],
                  *self->operands ? self->operands : "options");
    return OPTIONS_BAD;
}
