/* The files of rendered pictures: one for each picture, or one for all.
 *
 * The path of several files contains one number of the picture: %d, or with a width %4d, or with zeros
 * %04d. */
#ifndef COMMAND_SUPPORT_SINK_H
#define COMMAND_SUPPORT_SINK_H

#include "command/support/session.h"
#include "image/animation.h"
#include "image/sheet.h"

/* The forms of files. Words for --format: the form of that index, null after the last. */
enum { SINK_BY_NAME = 0xffff };
const char *sink_form_name(unsigned index);

enum { SINK_RATE = 30 };

struct sink_options {
    const char *path;
    unsigned form;         /* an index of sink_form_name, or SINK_BY_NAME: by the extension of the path */
    unsigned columns;      /* of a contact sheet; 0: none */
    unsigned rate;         /* frames a second of an animation; 0: SINK_RATE */
    unsigned compression;  /* of PNG and APNG (image/png.h) */
    unsigned first, count; /* the pictures' numbers */
    bool numbered;         /* the path may contain %d */
};

struct sink_form;

struct sink {
    const struct command *self;
    struct sink_options options;
    const struct sink_form *form;
    struct animation animation;
    struct sheet sheet;
};

/* Functions that return int return 0, or STATUS_BAD after printing the reason. sink_open checks what it can
 * before anything is drawn. A sink that is open must be closed. */
int sink_open(const struct command *self, const struct sink_options *options, struct sink *sink);

/* The parts of a picture that the form needs. */
enum readback_what sink_needs(const struct sink *sink);

/* Adds the next picture. */
int sink_add(struct sink *sink, const struct readback *readback);

/* Finishes the file of all pictures if `status` is STATUS_OK; otherwise discards it. Returns the status, or
 * STATUS_BAD. */
int sink_close(struct sink *sink, int status);

#endif
