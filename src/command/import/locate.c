/* Each format has a function that returns true at the first fault. The functions do not replace Assimp's
 * readers: they find the faults that those do not accept, and ignore all else. */
#include "command/import/locate.h"

#include "base/position.h"

#include <cjson/cJSON.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { NUMBER_CAPACITY = 64, PROPERTIES_MAXIMUM = 64 };

/* Words of a text, line by line. */
struct scan {
    const char *path;
    const char *at, *end, *line_start;
    uint32_t line;
    const char *word; /* the current word; at the end of a line, none */
    size_t length;
    struct error *error;
};

static void start(struct scan *scan, const char *path, const char *text, size_t bytes, struct error *error)
{
    *scan = (struct scan){
        .path = path, .at = text, .end = text + bytes, .line_start = text, .line = 1, .error = error};
}

static bool next_word(struct scan *scan)
{
    while (scan->at < scan->end && (*scan->at == ' ' || *scan->at == '\t' || *scan->at == '\r'))
        scan->at++;
    scan->word = scan->at;
    while (scan->at < scan->end && !strchr(" \t\r\n", *scan->at))
        scan->at++;
    scan->length = (size_t)(scan->at - scan->word);
    return scan->length > 0;
}

/* Skips the rest of the line. Returns false at the end of the text. */
static bool next_line(struct scan *scan)
{
    const char *feed = scan->at < scan->end ? memchr(scan->at, '\n', (size_t)(scan->end - scan->at)) : NULL;
    if (!feed)
        return false;
    scan->at = scan->line_start = feed + 1;
    scan->line++;
    return true;
}

static bool is(const struct scan *scan, const char *word)
{
    return strlen(word) == scan->length && !memcmp(word, scan->word, scan->length);
}

static bool fault(const struct scan *scan, const char *expected, ...) __attribute__((format(printf, 2, 3)));
static bool fault(const struct scan *scan, const char *expected, ...)
{
    char quoted[POSITION_QUOTED];
    struct position position = {scan->path, scan->line, (uint32_t)(scan->word - scan->line_start) + 1};
    va_list arguments;
    va_start(arguments, expected);
    position_expected(scan->error, position,
                      scan->length ? position_quote(scan->word, scan->length, POSITION_SHOWN, quoted)
                                   : "the end of the line",
                      expected, arguments);
    va_end(arguments);
    return true;
}

static bool is_number(const struct scan *scan)
{
    char text[NUMBER_CAPACITY], *end;
    if (!scan->length || scan->length >= sizeof text)
        return false;
    memcpy(text, scan->word, scan->length);
    text[scan->length] = 0;
    strtod(text, &end);
    return !*end;
}

/* Reads numbers and returns true at a word that is none. */
static bool lacks_numbers(struct scan *scan, unsigned count, const char *what)
{
    for (unsigned i = 0; i < count; i++) {
        next_word(scan);
        if (!is_number(scan))
            return fault(scan, "%u numbers of %s", count, what);
    }
    return false;
}

/* --- OBJ ------------------------------------------------------------------------------------------------ */

enum { OBJ_POSITION, OBJ_TEXCOORD, OBJ_NORMAL, OBJ_LISTS };

static const struct {
    const char *word, *what;
    unsigned numbers;
} obj_lists[OBJ_LISTS] = {{"v", "a vertex", 3}, {"vt", "a texture coordinate", 1}, {"vn", "a normal", 3}};

/* POSITION[/[TEXCOORD][/NORMAL]]: numbers from 1, or from -1 backwards. */
static bool is_bad_corner(const struct scan *scan, const long count[OBJ_LISTS])
{
    const char *at = scan->word, *end = at + scan->length;
    for (int list = 0; list < OBJ_LISTS && at <= end; list++) {
        char *after;
        bool missing = list && (at == end || *at == '/');
        long index = missing ? 1 : strtol(at, &after, 10);
        if (!missing && (after == at || after > end || !index || index > count[list] || index < -count[list]))
            return fault(scan, "the number of %s from 1 to %ld", obj_lists[list].what, count[list]);
        at = missing ? at : after;
        if (at == end)
            return false;
        if (*at++ != '/')
            return fault(scan, "numbers and / in the corner of a face");
    }
    return false;
}

static bool is_bad_face(struct scan *scan, const long count[OBJ_LISTS])
{
    unsigned corners = 0;
    for (; next_word(scan) && *scan->word != '#'; corners++)
        if (is(scan, "\\"))
            return false; /* the face continues on the next line */
        else if (is_bad_corner(scan, count))
            return true;
    return false;
}

static bool locate_obj(const char *path, const char *text, size_t bytes, struct error *error)
{
    struct scan scan;
    long count[OBJ_LISTS] = {0};
    start(&scan, path, text, bytes, error);
    do {
        next_word(&scan);
        for (int list = 0; list < OBJ_LISTS; list++)
            if (is(&scan, obj_lists[list].word)) {
                count[list]++;
                if (lacks_numbers(&scan, obj_lists[list].numbers, obj_lists[list].what))
                    return true;
                break;
            }
    } while (next_line(&scan));
    start(&scan, path, text, bytes, error);
    do
        if (next_word(&scan) && is(&scan, "f") && is_bad_face(&scan, count))
            return true;
    while (next_line(&scan));
    return false;
}

/* --- PLY ------------------------------------------------------------------------------------------------ */

static bool is_ply_type(const struct scan *scan)
{
    static const char *const types[] = {"char",  "uchar",  "short",   "ushort", "int",   "uint",
                                        "float", "double", "int8",    "uint8",  "int16", "uint16",
                                        "int32", "uint32", "float32", "float64"};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (is(scan, types[i]))
            return true;
    return false;
}

static bool is_bad_property(struct scan *scan)
{
    next_word(scan);
    bool list = is(scan, "list");
    for (int i = 0; i < (list ? 2 : 1); i++) {
        if (list)
            next_word(scan);
        if (!is_ply_type(scan))
            return fault(scan, "a type: char, uchar, short, ushort, int, uint, float, double");
    }
    return next_word(scan) ? false : fault(scan, "the name of a property");
}

/* The rows of an element: a number for each property, or a count and the numbers of a list. */
struct element {
    long count;
    unsigned properties;
    bool list[PROPERTIES_MAXIMUM];
};

static bool is_bad_row(struct scan *scan, const struct element *element)
{
    for (unsigned i = 0; i < element->properties; i++) {
        next_word(scan);
        if (!is_number(scan))
            return fault(scan, "%u values", element->properties);
        long more = element->list[i] ? strtol(scan->word, NULL, 10) : 0;
        for (long j = 0; j < more; j++) {
            next_word(scan);
            if (!is_number(scan))
                return fault(scan, "a list of %ld numbers", more);
        }
    }
    return false;
}

static bool is_bad_body(struct scan *scan, const struct element *elements, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        for (long row = 0; row < elements[i].count; row++) {
            if (!next_line(scan)) {
                scan->word = scan->at;
                scan->length = 0;
                return fault(scan, "%ld more rows", elements[i].count - row);
            }
            if (is_bad_row(scan, &elements[i]))
                return true;
        }
    return false;
}

static bool locate_ply(const char *path, const char *text, size_t bytes, struct error *error)
{
    enum { ELEMENTS_MAXIMUM = 8 };
    struct element elements[ELEMENTS_MAXIMUM] = {{0}};
    unsigned count = 0;
    bool is_text = false;
    struct scan scan;
    start(&scan, path, text, bytes, error);
    for (bool more = true; more; more = next_line(&scan)) {
        next_word(&scan);
        struct element *last = count ? &elements[count - 1] : NULL;
        if (is(&scan, "format")) {
            is_text = next_word(&scan) && is(&scan, "ascii");
        } else if (is(&scan, "element")) {
            if (!next_word(&scan) || !next_word(&scan) || !is_number(&scan))
                return fault(&scan, "element NAME COUNT");
            if (count == ELEMENTS_MAXIMUM)
                return false;
            elements[count++].count = strtol(scan.word, NULL, 10);
        } else if (is(&scan, "property")) {
            const char *type = scan.at + strspn(scan.at, " \t");
            if (is_bad_property(&scan))
                return true;
            if (!last || last->properties == PROPERTIES_MAXIMUM)
                return false;
            last->list[last->properties++] = !strncmp(type, "list", 4);
        } else if (is(&scan, "end_header")) {
            return is_text && is_bad_body(&scan, elements, count);
        }
    }
    return false;
}

/* --- STL ------------------------------------------------------------------------------------------------ */

static bool locate_stl(const char *path, const char *text, size_t bytes, struct error *error)
{
    struct scan scan;
    start(&scan, path, text, bytes, error);
    if (!next_word(&scan) || !is(&scan, "solid"))
        return false;
    while (next_line(&scan)) {
        next_word(&scan);
        if (is(&scan, "vertex") && lacks_numbers(&scan, 3, "a vertex"))
            return true;
        if (!is(&scan, "facet"))
            continue;
        next_word(&scan);
        if (!is(&scan, "normal"))
            return fault(&scan, "normal and 3 numbers");
        if (lacks_numbers(&scan, 3, "a normal"))
            return true;
    }
    return false;
}

/* --- glTF ----------------------------------------------------------------------------------------------- */

static bool locate_gltf(const char *path, const char *text, size_t bytes, struct error *error)
{
    const char *stop = text;
    struct scan scan;
    cJSON *json = cJSON_ParseWithLengthOpts(text, bytes, &stop, false);
    cJSON_Delete(json);
    if (json || stop < text || stop > text + bytes)
        return false;
    start(&scan, path, text, bytes, error);
    while (true) {
        const char *feed = memchr(scan.at, '\n', (size_t)(scan.end - scan.at));
        if (!feed || feed >= stop)
            break;
        next_line(&scan);
    }
    scan.word = stop;
    scan.length = stop < scan.end && (unsigned char)*stop > ' ' ? 1 : 0;
    return fault(&scan, "valid JSON");
}

bool locate_fault(const char *path, const char *text, size_t bytes, struct error *error)
{
    static const struct {
        const char *ending;
        bool (*locate)(const char *path, const char *text, size_t bytes, struct error *error);
    } formats[] = {{".obj", locate_obj}, {".ply", locate_ply}, {".stl", locate_stl}, {".gltf", locate_gltf}};
    const char *ending = strrchr(path, '.');
    for (size_t i = 0; i < sizeof formats / sizeof *formats && ending; i++)
        if (!strcasecmp(ending, formats[i].ending))
            return formats[i].locate(path, text, bytes, error);
    return false;
}
