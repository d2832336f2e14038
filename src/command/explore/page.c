#include "command/explore/page.h"

#include "base/memory_file.h"
#include "command/explore/embed.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

int page_open(struct page *page, const struct explore_recording *recording, enum unit unit,
              const union key *key, struct error *error)
{
    *page = (struct page){.out = memory_file_open(),
                          .recording = recording,
                          .unit = unit,
                          .key = key,
                          .engine = "",
                          .kin = recording->ir->count};
    return page->out ? 0 : error_set(error, "out of memory for a page");
}

static void free_texts(struct page *page)
{
    for (uint32_t i = 0; i < page->texts; i++)
        free(page->text[i]);
    free(page->text);
    free(page->table.slot);
}

void page_discard(struct page *page)
{
    char *text;
    size_t bytes;
    if (page->out)
        memory_file_close(page->out, &text, &bytes);
    if (page->out)
        free(text);
    free_texts(page);
    *page = (struct page){0};
}

/* --- Strings ------------------------------------------------------------------------------------------- */

/* The bytes of a character in UTF-8, or 0 if there is none: a wrong or overlong form, a surrogate, or more
 * than U+10FFFF. */
static unsigned character_bytes(const unsigned char *at)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    unsigned bytes = at[0] < 0x80 ? 1 : at[0] >> 5 == 6 ? 2 : at[0] >> 4 == 14 ? 3 : at[0] >> 3 == 30 ? 4 : 0;
    uint32_t code = bytes < 2 ? at[0] : at[0] & (0x7fu >> bytes);
    for (unsigned i = 1; i < bytes; i++) {
        if (at[i] >> 6 != 2)
            return 0;
        code = code << 6 | (at[i] & 63);
    }
    bool valid = bytes == 1 || (code >= least[bytes] && code < 0x110000 && code >> 11 != 0x1b);
    return bytes && valid ? bytes : 0;
}

/* `<`, `>` and `&` are escaped because of HTML. */
static void print_ascii(FILE *out, char c)
{
    if (c == '"' || c == '\\')
        fprintf(out, "\\%c", c);
    else if (c == '\n')
        fputs("\\n", out);
    else if (c < ' ' || c == 127 || c == '<' || c == '>' || c == '&')
        fprintf(out, "\\u%04x", (unsigned)c);
    else
        fputc(c, out);
}

void page_string(struct page *page, const char *text)
{
    const unsigned char *at = (const unsigned char *)text;
    fputc('"', page->out);
    while (*at) {
        unsigned bytes = character_bytes(at);
        if (bytes == 1)
            print_ascii(page->out, (char)*at);
        else if (bytes)
            fwrite(at, 1, bytes, page->out);
        else
            fputs("\\ufffd", page->out);
        at += bytes ? bytes : 1;
    }
    fputc('"', page->out);
}

void page_member(struct page *page, const char *name, const char *text)
{
    fprintf(page->out, ",\"%s\":", name);
    page_string(page, text);
}

struct sought {
    const struct page *page;
    const char *text;
    size_t length;
};

static bool is_text(const void *context, uint32_t number)
{
    const struct sought *sought = context;
    const char *text = sought->page->text[number - 1];
    return !strncmp(text, sought->text, sought->length) && !text[sought->length];
}

static uint32_t hash_of_text(const void *context, uint32_t number)
{
    const char *text = ((const struct page *)context)->text[number - 1];
    return (uint32_t)XXH3_64bits(text, strlen(text));
}

static bool reserve_text(struct page *page)
{
    if (page->texts < page->capacity)
        return true;
    uint32_t capacity = page->capacity ? 2 * page->capacity : 1024;
    char **larger = realloc(page->text, capacity * sizeof *larger);
    if (!larger)
        return false;
    page->text = larger;
    page->capacity = capacity;
    return true;
}

static uint32_t add_text(struct page *page, uint32_t slot, const char *text, size_t length)
{
    page->text[page->texts] = strndup(text, length);
    if (!page->text[page->texts])
        return page->failed = true, 0;
    hash_set(page->table, slot, ++page->texts);
    return page->texts - 1;
}

uint32_t page_text(struct page *page, const char *text, size_t length)
{
    const struct sought sought = {page, text, length};
    if (page->failed || !reserve_text(page) || hash_reserve(&page->table, page->texts, hash_of_text, page))
        return page->failed = true, 0;
    uint32_t slot = hash_find(page->table, (uint32_t)XXH3_64bits(text, length), is_text, &sought);
    uint32_t number = hash_get(page->table, slot);
    return number ? number - 1 : add_text(page, slot, text, length);
}

/* --- Panes --------------------------------------------------------------------------------------------- */

void page_item(struct page *page)
{
    if (page->begun)
        fputs(",\n", page->out);
    page->begun = true;
}

void page_begin_pane(struct page *page, const char *kind, const char *name, const char *title,
                     const char *note)
{
    if (page->panes++)
        fputs(",\n", page->out);
    fprintf(page->out, "{\"kind\":\"%s\",\"id\":\"%s%s%s\"", kind, page->engine, *page->engine ? "/" : "",
            name);
    page_member(page, "engine", page->engine);
    page_member(page, "title", title);
    page_member(page, "note", note);
    fputs(",\"lines\":[", page->out);
    page->begun = false;
}

void page_end_pane(struct page *page)
{
    fputs("]}", page->out);
}

uint32_t page_own_kin(struct page *page, uint32_t count)
{
    uint32_t first = page->kin;
    page->kin += count;
    return first;
}

void page_kin_of_line(struct page *page, const char *file, unsigned line, uint32_t own)
{
    const char *path = file ? strstr(file, "spec/") : NULL;
    fprintf(page->out, "{\"own\":%u", own);
    if (path)
        fprintf(page->out, ",\"line\":\"%s:%u\"", path, line);
    fputc('}', page->out);
}

/* --- The whole page ------------------------------------------------------------------------------------ */

static void print_texts(struct page *page)
{
    fputs("],\n\"texts\":[", page->out);
    for (uint32_t i = 0; i < page->texts; i++) {
        fputs(i ? ",\n" : "", page->out);
        page_string(page, page->text[i]);
    }
    fprintf(page->out, "],\n\"kin\":%u}\n", page->kin);
}

/* Prints the template, with the texts of its marks. */
static void print_page(FILE *out, const char *model)
{
    const struct {
        const char *mark, *text[4];
    } parts[] = {
        {"{{style}}", {embed_style}},
        {"{{model}}", {model}},
        {"{{script}}", {embed_script_model, embed_script_panes, embed_script_pictures, embed_script_page}},
    };
    const char *at = embed_page;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const char *mark = strstr(at, parts[i].mark);
        fprintf(out, "%.*s", (int)(mark - at), at);
        for (unsigned t = 0; t < 4 && parts[i].text[t]; t++)
            fputs(parts[i].text[t], out);
        at = mark + strlen(parts[i].mark);
    }
    fputs(at, out);
}

/* Closes the data and returns them; null if memory was refused. */
static char *take_model(struct page *page)
{
    FILE *out = page->out;
    char *model;
    size_t bytes;
    print_texts(page);
    page->out = NULL;
    return memory_file_close(out, &model, &bytes) ? NULL : model;
}

int page_close(struct page *page, char **html, size_t *bytes, struct error *error)
{
    char *model = page->failed ? NULL : take_model(page);
    FILE *out = model ? memory_file_open() : NULL;
    if (out)
        print_page(out, model);
    bool failed = !out || memory_file_close(out, html, bytes);
    free(model);
    page_discard(page);
    return failed ? error_set(error, "out of memory for a page") : 0;
}
