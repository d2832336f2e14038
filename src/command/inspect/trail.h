/* A frame played call by call up to a draw, and what each call did to one pixel.
 *
 * A canvas is what draws go to: a target, or surfaces of textures together. A call that is not a draw is an
 * event if it changed the pixel. So the words after an event are those before the canvas's next event. */
#ifndef COMMAND_INSPECT_TRAIL_H
#define COMMAND_INSPECT_TRAIL_H

#include "command/inspect/watch.h"
#include "command/stream/stream.h"

struct trail_canvas {
    struct triptych_target_surfaces surfaces; /* zero: a target */
    uint32_t generation;                      /* of a target: how many the frame has set before it */
    uint32_t width, height;
    uint32_t *count; /* how often each pixel was counted; null: not */
    struct watch_owner *owner;
    struct pixel_words last; /* of the pixel, if it is within the canvas */
};

struct trail_draw {
    uint32_t position; /* in stream->executed */
    uint32_t canvas;
    struct watch_counts counts;
};

struct trail_event {
    uint32_t position, canvas;
    uint32_t draw; /* its number in the frame; TRAIL_LAST: it is not a draw */
    struct pixel_words before, after;
    uint32_t touch, touches; /* of a draw: the first, and how many */
};

struct trail {
    struct trail_options options;
    const struct stream *stream;
    struct stream view; /* of the stream: a frame for each call that may change pixels */
    struct watch *watch;
    struct triptych_device *device; /* in the state of the draw */
    struct player *player;
    uint32_t generation;
    struct trail_canvas *canvas;
    uint32_t canvases;
    struct trail_draw *draw;
    uint32_t draws, frame_draws; /* up to the draw; of the frame */
    struct trail_event *event;   /* of all canvases, in order */
    uint32_t events;
    struct touch *touch;
    uint32_t touches;
    bool incomplete; /* touches are missing (watch_is_incomplete) */
    bool starved;    /* memory for a report was refused */
};

/* Plays the frame up to the draw. The stream must outlive the trail. Returns 0, or -1 with the reason: no
 * such frame or draw, no memory, a stream that cannot be played. The trail must be closed in both cases. */
int trail_open(struct trail *trail, const struct stream *stream, const struct trail_options *options,
               struct error *error);
void trail_close(struct trail *trail);

#endif
