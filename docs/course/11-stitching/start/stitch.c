#include "stitch.h"

int hole_offset(const struct fragment *fragment, enum hole hole)
{
    (void)fragment;
    (void)hole;
    return -1;
}

size_t stitch(const struct recording *recording, uint8_t *code, size_t room)
{
    (void)recording;
    (void)code;
    (void)room;
    return 0;
}
