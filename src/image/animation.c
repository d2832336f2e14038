#include "image/animation_part.h"
#include "image/png.h"

#include <stdlib.h>

int animation_begin(struct animation *animation, enum animation_form form, const char *path, unsigned frames,
                    unsigned rate, struct error *error)
{
    *animation = (struct animation){
        .path = path, .form = form, .frames = frames, .rate = rate, .level = PNG_LEVEL_DEFAULT};
    return file_begin(&animation->output, path, error);
}

int animation_add(struct animation *animation, unsigned width, unsigned height, const uint32_t *rgba,
                  struct error *error)
{
    if (!animation->added) {
        animation->width = width;
        animation->height = height;
    }
    if (width != animation->width || height != animation->height)
        return error_set(error, "%s: picture %u has %u x %u pixels, expected %u x %u, like the first",
                         animation->path, animation->added, width, height, animation->width,
                         animation->height);
    int bad = animation->form == ANIMATION_APNG ? apng_frame(animation, rgba, error)
                                                : y4m_frame(animation, rgba, error);
    animation->added++;
    return bad;
}

int animation_end(struct animation *animation, struct error *error)
{
    if (animation->form == ANIMATION_APNG && apng_end(animation, error)) {
        animation_discard(animation);
        return -1;
    }
    free(animation->planes);
    animation->planes = NULL;
    return file_commit(&animation->output, error);
}

void animation_discard(struct animation *animation)
{
    free(animation->planes);
    animation->planes = NULL;
    file_discard(&animation->output);
}
