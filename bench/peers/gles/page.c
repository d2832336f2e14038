#include "page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct head {
    char magic[4];
    uint32_t textures, draws, zero, vertices[PAGE_KINDS], indices[PAGE_KINDS];
    float clear[4];
};

static char reason[1200];

static const char *fail(const char *path, const char *what)
{
    snprintf(reason, sizeof reason, "%s: %s", path, what);
    return reason;
}

static uint8_t *read_file(const char *path, size_t *bytes)
{
    FILE *file = fopen(path, "rb");
    uint8_t *memory = NULL;
    long length = -1;
    if (file && !fseek(file, 0, SEEK_END))
        length = ftell(file);
    if (length > 0 && !fseek(file, 0, SEEK_SET) && (memory = malloc((size_t)length)) &&
        fread(memory, 1, (size_t)length, file) != (size_t)length) {
        free(memory);
        memory = NULL;
    }
    if (file)
        fclose(file);
    *bytes = memory ? (size_t)length : 0;
    return memory;
}

/* The next part of the file; null at its end. Parts are multiples of four bytes. */
static const void *take(const uint8_t **at, const uint8_t *end, size_t bytes)
{
    const uint8_t *part = *at;
    size_t all = (bytes + 3) / 4 * 4;
    if (!part || all > (size_t)(end - part))
        return *at = NULL;
    *at = part + all;
    return part;
}

static void take_texture(struct page_texture *texture, const uint8_t **at, const uint8_t *end)
{
    const uint32_t *fields = take(at, end, 3 * sizeof *fields);
    if (!fields)
        return;
    memcpy(texture, fields, 3 * sizeof *fields);
    texture->texels = take(at, end, (size_t)texture->width * texture->height * (texture->alpha ? 1 : 4));
}

const char *workload_page_read(struct page *page, const char *name)
{
    char path[1024];
    const char *folder = getenv("PAGES");
    size_t bytes;
    snprintf(path, sizeof path, "%s/%s.page", folder ? folder : ".", name);
    *page = (struct page){.file = read_file(path, &bytes)};
    const uint8_t *at = page->file, *end = at + bytes;
    const struct head *head = take(&at, end, sizeof *head);
    if (!head || memcmp(head->magic, "PAGE", 4) || head->textures > PAGE_TEXTURES)
        return fail(path, "expected a page of bench/peers/gles/page.py");
    page->clear = head->clear;
    page->texture_count = head->textures;
    page->draw_count = head->draws;
    page->draws = take(&at, end, head->draws * sizeof *page->draws);
    for (int kind = 0; kind < PAGE_KINDS; kind++) {
        page->vertex_count[kind] = head->vertices[kind];
        page->index_count[kind] = head->indices[kind];
        page->vertices[kind] =
            take(&at, end, (size_t)head->vertices[kind] * (kind ? PAGE_ROUND_BYTES : PAGE_FLAT_BYTES));
    }
    for (int kind = 0; kind < PAGE_KINDS; kind++)
        page->indices[kind] = take(&at, end, head->indices[kind] * sizeof(uint16_t));
    for (uint32_t i = 0; i < head->textures; i++)
        take_texture(page->textures + i, &at, end);
    return at == end ? NULL : fail(path, "expected a page of bench/peers/gles/page.py, found another length");
}

void workload_page_free(struct page *page)
{
    free(page->file);
    *page = (struct page){0};
}
