#include "front/glsl/preprocess/scan.h"

#include "front/glsl/context.h"

#include <string.h>

void glsl_scan_match(struct glsl_scan *scan, size_t offset)
{
    unsigned string = scan->place.string;
    while (string + 1 < scan->count && offset >= scan->end[string]) {
        scan->line_start = scan->end[string];
        scan->place.line = 1;
        scan->place.string = (uint16_t)++string;
    }
    size_t column = offset - scan->line_start + 1;
    scan->place.column = column > UINT16_MAX ? 0 : (uint16_t)column;
}

void glsl_scan_line(struct glsl_scan *scan, size_t offset)
{
    scan->place.line++;
    scan->line_start = offset;
}

static void grow(struct glsl_scan *scan)
{
    size_t capacity = scan->capacity ? 2 * scan->capacity : 512;
    struct glsl_token *token = glsl_take(&scan->context->arena, capacity * sizeof *token);
    if (scan->tokens)
        memcpy(token, scan->token, scan->tokens * sizeof *token);
    scan->token = token;
    scan->capacity = capacity;
}

void glsl_scan_add(struct glsl_scan *scan, enum glsl_token_kind kind, const char *text, size_t length)
{
    if (scan->tokens == scan->capacity)
        grow(scan);
    if (length > GLSL_NAME_BYTES) {
        glsl_error(scan->context, scan->place,
                   "found a name or number of %zu characters, expected at most %d", length, GLSL_NAME_BYTES);
        length = GLSL_NAME_BYTES;
    }
    scan->token[scan->tokens++] = (struct glsl_token){
        .kind = (uint8_t)kind,
        .spaced = scan->spaced,
        .length = (uint16_t)length,
        .text = text,
        .place = scan->place,
    };
    scan->spaced = false;
}

/* The length of string i. */
static size_t length_of(const char *const *strings, const int *lengths, unsigned i)
{
    return lengths && lengths[i] >= 0 ? (size_t)lengths[i] : strlen(strings[i]);
}

/* All strings in one text, with two zeros after it; sets the offsets where they end. A zero inside of a
 * string is a stray character to the scanner. */
static char *join(struct glsl_context *context, const char *const *strings, const int *lengths,
                  unsigned count, size_t *end)
{
    size_t bytes = 0;
    for (unsigned i = 0; i < count; i++)
        end[i] = bytes += length_of(strings, lengths, i);
    char *text = glsl_take(&context->arena, bytes + 2);
    for (unsigned i = 0; i < count; i++)
        memcpy(text + (i ? end[i - 1] : 0), strings[i], end[i] - (i ? end[i - 1] : 0));
    return text;
}

struct glsl_token *glsl_tokens(struct glsl_context *context, const char *const *strings, const int *lengths,
                               unsigned count)
{
    size_t *end = glsl_take(&context->arena, (count + 1) * sizeof *end);
    char *text = join(context, strings, lengths, count, end);
    size_t bytes = count ? end[count - 1] : 0;
    struct glsl_scan scan = {
        .context = context, .text = text, .end = end, .count = count, .place = {.line = 1}};
    if (bytes > GLSL_SOURCE_BYTES)
        glsl_error(context, scan.place, "found a source of %zu bytes, expected at most %d", bytes,
                   GLSL_SOURCE_BYTES);
    else
        glsl_scan_run(&scan, text, bytes);
    glsl_scan_add(&scan, GLSL_LINE_END, "\n", 1);
    glsl_scan_add(&scan, GLSL_END, "", 0);
    return scan.token;
}
