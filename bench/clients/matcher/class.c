#include "bench/clients/matcher/class.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void class_fail(struct class_reader *reader, const char *format, ...)
{
    char reason[128];
    va_list list;
    va_start(list, format);
    vsnprintf(reason, sizeof reason, format, list);
    va_end(list);
    if (!reader->failed)
        error_set(reader->error, "%s, at character %d of the expression \"%s\"", reason,
                  (int)(reader->at - reader->start) + 1, reader->start);
    reader->failed = true;
}

static void add_range(struct byte_set *set, int low, int high)
{
    for (int byte = low; byte <= high; byte++)
        byte_add(set, byte);
}

static void complement(struct byte_set *set)
{
    for (int w = 0; w < 8; w++)
        set->word[w] = ~set->word[w];
}

/* Adds the class of an escape. Returns false if the letter is not a class. */
static bool add_escape(struct byte_set *set, char letter)
{
    struct byte_set class = {{0}};
    switch (letter | 32) {
    case 'd': add_range(&class, '0', '9'); break;
    case 's':
        byte_add(&class, ' ');
        add_range(&class, '\t', '\r');
        break;
    case 'w':
        add_range(&class, 'a', 'z');
        add_range(&class, 'A', 'Z');
        add_range(&class, '0', '9');
        byte_add(&class, '_');
        break;
    default: return false;
    }
    if (!(letter & 32))
        complement(&class);
    for (int w = 0; w < 8; w++)
        set->word[w] |= class.word[w];
    return true;
}

static int hexadecimal(char digit)
{
    const char *digits = "0123456789abcdef", *found = digit ? strchr(digits, digit | 32) : NULL;
    return found ? (int)(found - digits) : -1;
}

/* Reads the byte of an escape that is not a class; `at` is after the backslash. */
static int read_escape(struct class_reader *reader)
{
    char letter = *reader->at;
    if (letter == 'x') {
        int high = hexadecimal(reader->at[1]), low = high < 0 ? -1 : hexadecimal(reader->at[2]);
        if (low < 0)
            return class_fail(reader, "found \"\\x\", expected two hexadecimal digits after it"), 0;
        reader->at += 3;
        return 16 * high + low;
    }
    if (!letter || (letter != 't' && strchr("abcdefghijklmnopqrstuvwxyz0123456789", letter | 32)))
        return class_fail(reader, "found the escape \"\\%.1s\", expected \\d \\w \\s \\t \\x or punctuation",
                          reader->at),
               0;
    reader->at++;
    return letter == 't' ? '\t' : (uint8_t)letter;
}

/* Reads a byte in brackets. Returns -1 if it was a class, which is added. */
static int read_member(struct class_reader *reader, struct byte_set *set)
{
    if (*reader->at != '\\')
        return (uint8_t)*reader->at++;
    reader->at++;
    if (add_escape(set, *reader->at))
        return reader->at++, -1;
    return read_escape(reader);
}

static void read_brackets(struct class_reader *reader, struct byte_set *set)
{
    bool negated = *reader->at == '^';
    reader->at += negated;
    do {
        if (!*reader->at) {
            class_fail(reader, "found the end, expected ]");
            return;
        }
        int low = read_member(reader, set), high = low;
        if (low >= 0 && *reader->at == '-' && reader->at[1] != ']') {
            reader->at++;
            high = read_member(reader, set);
            if (high < low)
                class_fail(reader, "found a range whose end is before its begin");
        }
        if (low >= 0)
            add_range(set, low, high);
    } while (!reader->failed && *reader->at != ']');
    reader->at += !reader->failed;
    if (negated)
        complement(set);
}

void class_read(struct class_reader *reader, struct byte_set *set)
{
    char c = *reader->at;
    memset(set, 0, sizeof *set);
    if (strchr("*+?{^$", c) && c) {
        class_fail(reader, "found \"%c\", expected a character before it or a backslash", c);
        return;
    }
    reader->at++;
    if (c == '[')
        read_brackets(reader, set);
    else if (c == '.')
        complement(set);
    else if (c != '\\')
        byte_add(set, (uint8_t)c);
    else if (add_escape(set, *reader->at))
        reader->at++;
    else
        byte_add(set, read_escape(reader));
    set->word['\n' / 32] &= ~(1u << '\n' % 32);
}

bool class_is_all(const struct byte_set *set)
{
    for (int byte = 0; byte < 256; byte++)
        if (!byte_in(set, byte) && byte != '\n')
            return false;
    return true;
}
