/* Shaders as text. */
#include "shader/shader.h"
#include "tests/command/fuzz/targets/sound.h"
#include "tests/command/fuzz/targets/target.h"

static void run(const uint8_t *data, size_t bytes)
{
    struct error error = {{0}};
    struct shader *shader;
    if (shader_assemble("fuzz.vs", (const char *)data, bytes, &shader, &error)) {
        expect(!shader, "a refused shader");
        expect_refusal_at(&error, "fuzz.vs");
        return;
    }
    expect(!error.text[0], "%s", error.text);
    expect_sound(shader);
    shader_free(shader);
}

const struct fuzz_target fuzz_shader = {"shader", run};
