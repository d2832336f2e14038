/* The data of a page: JSON, in the order in which it is printed.
 *
 * The page shows panes of lines. A line has a list of its kin: numbers of recorded instructions, or numbers
 * from the recording's count on, which a pane has for itself (page_own_kin). Two lines of any panes are kin
 * if their lists share a number.
 *
 * Texts of lines are in a table, in which each text is once. All texts are escaped, so that the JSON can be
 * in a script element of HTML: whatever a stream contains, it cannot end the element. */
#ifndef COMMAND_EXPLORE_PAGE_H
#define COMMAND_EXPLORE_PAGE_H

#include "base/error.h"
#include "base/hash.h"
#include "command/explore/record.h"

#include <stdio.h>

struct page {
    FILE *out;
    const struct explore_recording *recording;
    enum unit unit;
    const union key *key;
    const char *engine; /* whose panes are printed; "" for those of all engines */
    char **text;        /* the table of texts */
    uint32_t texts, capacity;
    struct hash_table table;
    uint32_t kin;     /* the numbers of kin that are in use are below this */
    uint32_t panes;   /* their number */
    uint32_t engines; /* the number of engines whose panes are printed */
    bool begun;       /* the list that is printed has an item */
    bool failed;      /* memory was refused */
};

/* A page without panes. Returns 0, or -1 with the reason. */
int page_open(struct page *page, const struct explore_recording *recording, enum unit unit,
              const union key *key, struct error *error);

/* Completes the page. *html, of *bytes bytes, is freed by the caller. Returns 0, or -1 with the reason. */
int page_close(struct page *page, char **html, size_t *bytes, struct error *error);

/* Frees a page that is not completed. */
void page_discard(struct page *page);

/* Prints a JSON string. */
void page_string(struct page *page, const char *text);

/* Prints `"name":` and a string, after a comma. */
void page_member(struct page *page, const char *name, const char *text);

/* The number of a text in the table; `length` bytes of it. */
uint32_t page_text(struct page *page, const char *text, size_t length);

/* Begins an item of the list that is printed: a comma, except before the first. */
void page_item(struct page *page);

/* Begins and ends a pane and the list of its lines. The kinds are described in model.js. `name` is unique
 * among those of the engine. */
void page_begin_pane(struct page *page, const char *kind, const char *name, const char *title,
                     const char *note);
void page_end_pane(struct page *page);

/* Reserves `count` numbers for kin besides the recorded instructions, and returns the first. */
uint32_t page_own_kin(struct page *page, uint32_t count);

/* Prints kin: the instructions that a line of the specification recorded, and the pane's own number `own`.
 * The path of the file may begin with folders; null means no line. */
void page_kin_of_line(struct page *page, const char *file, unsigned line, uint32_t own);

/* Prints an engine's panes. Return 0, or -1 with the reason. */
struct engine;
int pane_specialize(struct page *page, const struct engine *engine, struct error *error);
int pane_stitch(struct page *page, const struct engine *engine, struct error *error);
int pane_batch(struct page *page, const struct engine *engine, struct error *error);
int pane_external(struct page *page, const struct engine *engine, struct error *error);

/* A program of the IR, without nops, as a pane shows it. */
struct version {
    uint32_t count;
    struct ir_instruction *instruction;
    uint32_t *number, *text; /* the number in the program; that of the text in the table */
};

/* Fills a version. Returns 0, or -1 if memory is refused. */
int version_take(struct version *version, struct page *page, const struct ir *ir);
void version_free(struct version *version);

/* The result of a pass compared with the program before it. */
struct change {
    uint32_t removed, added, altered;
};

/* Prints the lines of `after`, with the difference from `before`, which may be null. Returns 0, or -1 if
 * memory is refused. */
int version_print(struct page *page, const struct version *before, const struct version *after,
                  struct change *change);

/* Prints the parts of the page that all engines share: the key, the specification, and the shader, whose
 * text is null if there is none. */
int page_sources(struct page *page, const struct program_text *shader, struct error *error);

#endif
