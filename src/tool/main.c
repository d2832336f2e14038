/* The command `triptych`. */
#include "tool/interrupt.h"
#include "tool/command_line.h"

#include <fcntl.h>
#include <unistd.h>

/* What is opened next must not become the standard output that somebody closed: it would be printed into. */
static int open_standard(void)
{
    int descriptor;
    do
        descriptor = open("/dev/null", O_RDONLY);
    while (descriptor >= 0 && descriptor <= STDERR_FILENO);
    return descriptor < 0 ? -1 : close(descriptor);
}

int main(int count, char **arguments)
{
    interrupt_catch();
    open_standard();
    return command_line_run(count, arguments);
}
