#include "command/fuzz/case/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 4096 };

/* Room for `more` bytes and the zero after them. */
static bool reserve(struct text *text, size_t more)
{
    size_t capacity = text->capacity ? text->capacity : FIRST_CAPACITY;
    while (capacity <= text->length + more)
        capacity *= 2;
    if (text->failed || capacity == text->capacity)
        return !text->failed;
    char *larger = realloc(text->data, capacity);
    if (!larger) {
        text->failed = true;
        return false;
    }
    text->data = larger;
    text->capacity = capacity;
    return true;
}

void text_add_bytes(struct text *text, const char *bytes, size_t count)
{
    if (!reserve(text, count))
        return;
    memcpy(text->data + text->length, bytes, count);
    text->data[text->length += count] = 0;
}

void text_add(struct text *text, const char *format, ...)
{
    char line[512];
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (length >= 0 && (size_t)length < sizeof line) {
        text_add_bytes(text, line, (size_t)length);
    } else if (length >= 0 && reserve(text, (size_t)length)) {
        vsnprintf(text->data + text->length, (size_t)length + 1, format, again);
        text->length += (size_t)length;
    }
    va_end(again);
}

void text_cut(struct text *text, size_t length)
{
    if (text->data && length < text->length)
        text->data[text->length = length] = 0;
}

void text_free(struct text *text)
{
    free(text->data);
    *text = (struct text){0};
}
