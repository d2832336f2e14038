#include "command/support/json.h"
#include "base/file.h"

#include <stdalign.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* The header of each block. */
struct block {
    alignas(max_align_t) struct block *next;
    struct block **link; /* the pointer to this block */
};

static struct block *blocks;

static void *allocate(size_t bytes)
{
    struct block *block = malloc(sizeof *block + bytes);
    if (!block) {
        tool_report_mark_incomplete();
        return NULL;
    }
    *block = (struct block){.next = blocks, .link = &blocks};
    if (blocks)
        blocks->link = &block->next;
    blocks = block;
    return block + 1;
}

static void release(void *memory)
{
    if (!memory)
        return;
    struct block *block = (struct block *)memory - 1;
    *block->link = block->next;
    if (block->next)
        block->next->link = block->link;
    free(block);
}

void json_begin(void)
{
    cJSON_InitHooks(&(cJSON_Hooks){.malloc_fn = allocate, .free_fn = release});
}

void json_end(void)
{
    while (blocks)
        release(blocks + 1);
    cJSON_InitHooks(NULL);
}

char *json_text(const struct command *self, const cJSON *json)
{
    char *text = tool_report_is_complete() ? cJSON_Print(json) : NULL;
    if (!text)
        tool_fail(self, "out of memory for the report");
    return text;
}

int json_write(const struct command *self, const cJSON *json, const char *path)
{
    struct error error = {""};
    char *text = json_text(self, json);
    if (!text)
        return STATUS_BAD;
    size_t length = strlen(text);
    text[length] = '\n'; /* replaces the zero byte: a text file ends with a line feed */
    int bad = file_write(path, text, length + 1, &error);
    cJSON_free(text);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}
