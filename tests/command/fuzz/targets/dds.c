/* DDS files, and their texels decoded as a device does it. */
#include "command/assets/dds.h"

#include "render/texture/texture.h"
#include "tests/support/blit/blits.h"
#include "tests/command/fuzz/targets/target.h"

static void update(struct triptych_texture *texture, const uint8_t *texels, size_t bytes)
{
    size_t at = 0;
    for (unsigned face = 0; face < texture->faces; face++)
        for (unsigned level = 0; level < texture->levels; level++) {
            const struct texture_level *l = &texture->level[level];
            size_t row = texture_row_bytes(texture->format, (uint32_t)l->width);
            size_t slice = row * format_blocks(texture->format, (uint32_t)l->height);
            expect(!texture_check_update(texture, face, level, NULL, row, slice, NULL), "level %u", level);
            texture_update(texture, face, level, NULL, texels + at, row, slice);
            at += texture_level_bytes(texture, level);
        }
    expect(at == bytes, "%zu of %zu bytes of texels", at, bytes);
}

static void make_mips(struct triptych_texture *texture)
{
    struct error error = {{0}};
    struct texture_mips mips;
    expect(!texture_prepare_mips(texture, &emulated_blits, &mips, &error), "%s", error.text);
    texture_generate_mips(texture, &mips);
    texture_drop_mips(&emulated_blits, &mips);
}

static void run(const uint8_t *data, size_t bytes)
{
    struct error error = {{0}};
    struct triptych_texture_description description;
    struct triptych_texture *texture;
    size_t offset;
    if (dds_read("fuzz.dds", data, bytes, &description, &offset, &error)) {
        expect_refusal(&error, "fuzz.dds");
        return;
    }
    expect(offset <= bytes && !error.text[0], "%s", error.text);
    expect(!texture_create(&description, false, &texture, &error), "%s", error.text);
    update(texture, data + offset, bytes - offset);
    if (texture->format->coding == CODING_PACKED)
        make_mips(texture);
    texture_destroy(texture);
}

const struct fuzz_target fuzz_dds = {"dds", run};
