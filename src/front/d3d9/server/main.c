/* triptych-d3d9-server ADDRESS PARENT: executes the calls of a 32-bit program's d3d9.dll, which starts it
 * with the shared memory as descriptor 3 (front/d3d9/remote/channel.h). */
#include "front/d3d9/remote/channel.h"

#include <stdio.h>
#include <stdlib.h>

enum { DESCRIPTOR = 3, ARGUMENTS = 3 };

int main(int count, char **arguments)
{
    if (count != ARGUMENTS) {
        fputs("triptych-d3d9-server: expected to be started by d3d9.dll of a 32-bit program\n", stderr);
        return 2;
    }
    return d3d9_serve(DESCRIPTOR, (uint32_t)strtoul(arguments[1], NULL, 10), atoi(arguments[2]));
}
