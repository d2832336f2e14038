#include "base/leftover.h"

#include <stdatomic.h>
#include <stddef.h>
#include <unistd.h>

enum { LEFTOVERS = 64 };

static _Atomic(const char *) paths[LEFTOVERS];

int leftover_note(const char *path)
{
    for (int i = 0; i < LEFTOVERS; i++) {
        const char *none = NULL;
        if (atomic_compare_exchange_strong(&paths[i], &none, path))
            return i;
    }
    return -1;
}

void leftover_forget(int number)
{
    if (number >= 0)
        atomic_store(&paths[number], NULL);
}

void leftovers_remove(void)
{
    for (int folders = 0; folders < 2; folders++)
        for (int i = 0; i < LEFTOVERS; i++) {
            const char *path = atomic_load(&paths[i]);
            if (path && folders)
                rmdir(path);
            else if (path)
                unlink(path);
        }
}
