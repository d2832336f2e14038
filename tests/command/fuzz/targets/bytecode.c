/* Shaders as bytecode. */
#include "shader/shader.h"
#include "tests/command/fuzz/targets/sound.h"
#include "tests/command/fuzz/targets/target.h"

static void run(const uint8_t *data, size_t bytes)
{
    struct error error = {{0}};
    struct shader *shader;
    if (shader_read("fuzz.vso", data, bytes, &shader, &error)) {
        expect(!shader, "a refused shader");
        expect_refusal(&error, "fuzz.vso");
        return;
    }
    expect(!error.text[0], "%s", error.text);
    expect_sound(shader);
    shader_free(shader);
}

const struct fuzz_target fuzz_bytecode = {"bytecode", run};
