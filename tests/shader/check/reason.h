/* The validator's reason for a text. */
#ifndef TESTS_SHADER_CHECK_REASON_H
#define TESTS_SHADER_CHECK_REASON_H

#include "shader/shader.h"

#include <string.h>
#include <unity.h>

static struct error error;

/* Returns the reason for which the text is refused, or "" if it is valid. */
static inline const char *reason_of(const char *text)
{
    struct shader *shader;
    error_clear(&error);
    if (!shader_assemble("t", text, strlen(text), &shader, &error)) {
        int bad = shader_validate(shader, NULL, &error);
        TEST_ASSERT_EQUAL_INT_MESSAGE(bad, error.text[0] ? -1 : 0, text);
        shader_free(shader);
    }
    return error.text;
}

#endif
