/* Compares two PNG files. Prints the first pixel that differs. Ends with status 0 if the pictures are equal,
 * 1 if they differ, 2 if a file cannot be read. */
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

struct picture {
    uint32_t width, height;
    uint32_t *pixels;
};

static struct picture read_picture(const char *path)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    struct picture picture = {0};
    if (png_image_begin_read_from_file(&image, path)) {
        image.format = PNG_FORMAT_RGBA;
        picture = (struct picture){image.width, image.height, malloc(PNG_IMAGE_SIZE(image))};
        if (picture.pixels && png_image_finish_read(&image, NULL, picture.pixels, 0, NULL))
            return picture;
    }
    fprintf(stderr, "same: %s: %s\n", path, image.message);
    exit(2);
}

int main(int count, char **arguments)
{
    if (count != 3) {
        fprintf(stderr, "same: found %d arguments, expected EXPECTED.png ACTUAL.png\n", count - 1);
        return 2;
    }
    struct picture expected = read_picture(arguments[1]), actual = read_picture(arguments[2]);
    if (expected.width != actual.width || expected.height != actual.height) {
        printf("%s has %u x %u pixels, expected %u x %u\n", arguments[2], actual.width, actual.height,
               expected.width, expected.height);
        return 1;
    }
    for (uint32_t i = 0; i < expected.width * expected.height; i++)
        if (expected.pixels[i] != actual.pixels[i]) {
            printf("%s: pixel %u, %u is 0x%08x, expected 0x%08x\n", arguments[2], i % expected.width,
                   i / expected.width, actual.pixels[i], expected.pixels[i]);
            return 1;
        }
    return 0;
}
