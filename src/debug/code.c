#include "debug/code.h"

#include <stdlib.h>
#include <string.h>

/* Makes room for one more row. Returns false and sets `failed` if the allocation fails. */
static bool grow(struct debug_code *code, void **rows, size_t size, uint32_t count, uint32_t *capacity)
{
    if (code->failed || count < *capacity)
        return !code->failed;
    uint32_t more = *capacity ? *capacity * 2 : 64;
    void *larger = realloc(*rows, more * size);
    if (larger) {
        *rows = larger;
        *capacity = more;
    }
    code->failed = !larger;
    return larger;
}

void debug_add_source(struct debug_code *code, uint32_t offset, const char *file, uint32_t line)
{
    void *rows = code->source;
    if (code->sources && code->source[code->sources - 1].offset == offset)
        code->sources--;
    const struct debug_source *last = code->sources ? code->source + code->sources - 1 : NULL;
    if (last && last->line == line && !strcmp(last->file, file))
        return;
    bool room = grow(code, &rows, sizeof *code->source, code->sources, &code->source_capacity);
    code->source = rows;
    if (room)
        code->source[code->sources++] = (struct debug_source){offset, line, file};
}

void debug_add_unwind(struct debug_code *code, uint32_t offset, enum debug_rule rule, unsigned reg,
                      int32_t value)
{
    void *rows = code->unwind;
    bool room = grow(code, &rows, sizeof *code->unwind, code->unwinds, &code->unwind_capacity);
    code->unwind = rows;
    if (room)
        code->unwind[code->unwinds++] = (struct debug_unwind){
            .offset = offset, .rule = (uint8_t)rule, .reg = (uint8_t)reg, .value = value};
}

void debug_code_free(struct debug_code *code)
{
    free(code->source);
    free(code->unwind);
    code->source = NULL;
    code->unwind = NULL;
}
