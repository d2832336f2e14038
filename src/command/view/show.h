/* The contents of the window as a picture: the picture of the scene or a result of its analysis, enlarged,
 * with tiles and text. */
#ifndef COMMAND_VIEW_SHOW_H
#define COMMAND_VIEW_SHOW_H

#include "command/view/scene.h"

enum show_mode { SHOW_PICTURE, SHOW_OVERDRAW, SHOW_TRIANGLES };

enum { SHOW_LINES = 40, SHOW_COLUMNS = 160 };

/* Lines of text, from the top. */
struct show_text {
    unsigned lines;
    char line[SHOW_LINES][SHOW_COLUMNS];
};

struct show {
    enum show_mode mode;
    bool tiles;
    unsigned zoom;
    const struct show_text *text; /* null: none */
    const char *message;          /* at the bottom; empty: none */
    /* The result: zoom times as large as the scene's picture. */
    unsigned width, height;
    uint32_t *color;
    size_t capacity;
};

void show_line(struct show_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Makes the picture. Without an analysis of the picture's size, the mode is that of the picture. Returns 0,
 * or -1 with the reason. */
int show_make(struct show *show, const struct scene *scene, struct error *error);

#endif
