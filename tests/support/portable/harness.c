/* Calls a routine of external:c=portable in a program of its own, for any machine with 64-bit little-endian
 * pointers: C11 and nothing else.
 *
 *   harness IMAGE RESULT
 *
 * IMAGE is the memory that the routine reads and writes (image.h). Its pointers are offsets in it. RESULT
 * becomes the part of it that the routine writes. */
#include "image.h"

#include <stdio.h>
#include <stdlib.h>

void routine(const char *call);

static void stop(const char *reason)
{
    fprintf(stderr, "harness: %s\n", reason);
    exit(2);
}

static void *read_whole(FILE *file, size_t bytes)
{
    void *memory = aligned_alloc(64, (bytes + 63) / 64 * 64);
    if (!memory || fread(memory, 1, bytes, file) != bytes)
        stop("cannot read the image");
    return memory;
}

int main(int count, char **argument)
{
    struct image_head head;
    FILE *in = count == 3 ? fopen(argument[1], "rb") : NULL;
    if (!in || fread(&head, sizeof head, 1, in) != 1)
        stop("expected an image and the name of a result");
    struct image_pointer *pointer = read_whole(in, head.pointers * sizeof *pointer);
    char *memory = read_whole(in, head.bytes);
    fclose(in);
    for (uint64_t n = 0; n < head.pointers; n++)
        *(char **)(void *)(memory + pointer[n].at) = memory + pointer[n].to;
    routine(memory + head.call);
    FILE *out = fopen(argument[2], "wb");
    if (!out || fwrite(memory + head.result, 1, head.result_bytes, out) != head.result_bytes || fclose(out))
        stop("cannot write the result");
    free(pointer);
    free(memory);
    return 0;
}
