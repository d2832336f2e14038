#include "fuzz/hunt.h"

int hunt_stages(struct hunt *hunt, unsigned side, struct error *error)
{
    (void)hunt, (void)side, (void)error;
    return 0;
}
