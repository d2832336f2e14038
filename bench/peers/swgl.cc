// Mozilla's swgl as a renderer that is measured: generic|span. It takes part in the workloads that it is
// made for: rectangles without perspective, and pages. `span` uses the paths for whole spans that swgl's
// users write into shaders by hand, and takes part only in workloads that have one. bench/swgl.sh builds it
// with swgl's sources from its crate.
#include <gl.cc>

#include <vector>

extern "C" {
#include "gles_texel.h"
#include "peer.h"
}
#include "swgl_page.h"

enum geometry { QUAD, QUADS, COLORS, ARITHMETIC };
enum picture { NONE, CHECKER, PICTURE, PATTERN, BYTES };

struct scene {
    const char *name, *shader;
    enum geometry geometry;
    float low, high;
    bool linear, blend, depth;
    uint32_t color;
    enum picture picture;
};

static const struct scene scenes[] = {
    {"flat", "flat", QUAD, 0, 1, false, false, false, 0xff4080c0},
    {"flat-one", "flat", QUAD, 0, 1, false, false, false, 0xff4080c0},
    {"depth-fail", "flat", QUAD, 0, 1, false, false, true, 0xff4080c0},
    {"depth-pass", "flat", QUADS, 0, 1, false, false, true, 0xff4080c0},
    {"rectangle-blend", "flat", QUAD, 0, 1, false, true, false, 0x48362412},
    {"rectangle-nearest", "tex", QUAD, 0, 0.9f, false, false, false, 0, CHECKER},
    {"rectangle-bilinear", "tex", QUAD, 0, 0.9f, true, false, false, 0, CHECKER},
    {"rectangle-bilinear-blend", "tex", QUAD, 0, 0.9f, true, true, false, 0, CHECKER},
    {"rectangle-two-textures", "two", QUAD, 0, 0.9f, true, false, false, 0, CHECKER},
    {"rectangle-solid", "flat", QUAD, 0, 1, false, false, false, 0xff336699},
    {"rectangle-copy", "tex", QUAD, 0, 1, false, false, false, 0, PICTURE},
    {"rectangle-repeat", "repeat", QUAD, 0, 16, false, false, false, 0, PATTERN},
    {"rectangle-modulate", "modulate", QUAD, 0, 1, false, true, false, 0xc0808040, PICTURE},
    {"rectangle-mask", "mask", QUAD, 0, 1, false, true, false, 0xff336699, BYTES},
    {"rectangle-mask-inverted", "inverse", QUAD, 0, 1, false, true, false, 0xff336699, BYTES},
    {"multiply-add", "mads", COLORS, 0, 1, false, false, false, 0},
    {"phong", "phong", ARITHMETIC, 0, 1, false, false, false, 0},
};

static bool span;
static const struct workload *workload;
static const struct scene *scene;
static GLuint program, invert, textures[2], buffers[2], array, bytes, bytes_target;

extern "C" const char *renderer_start(int count, char **arguments, char *description)
{
    if (count != 2)
        return "expected generic|span";
    span = !strcmp(arguments[1], "span");
    MakeCurrent(CreateContext());
    InitDefaultFramebuffer(0, 0, SIDE, SIDE, 0, nullptr);
    snprintf(description, 256, "Mozilla's swgl 0.70, %s paths", span ? "span" : "generic");
    GenVertexArrays(1, &array);
    return nullptr;
}

static void set4(const char *name, float x, float y, float z, float w)
{
    const float v[] = {x, y, z, w};
    GLint at = GetUniformLocation(program, (char *)name);
    if (at >= 0)
        Uniform4fv(at, 1, v);
}

// True if swgl's users write a path for whole spans of the scene's shader.
static bool has_span()
{
    for (const char *name : {"flat", "tex", "modulate", "repeat", "mask", "inverse"})
        if (!strcmp(scene->shader, name))
            return true;
    return false;
}

// The inverse of a mask is drawn to bytes first, and is then a mask.
static bool inverts()
{
    return span && !strcmp(scene->shader, "inverse");
}

static GLuint link(const char *name)
{
    GLuint vs = CreateShader(GL_VERTEX_SHADER), fs = CreateShader(GL_FRAGMENT_SHADER), made = CreateProgram();
    ShaderSourceByName(vs, (char *)name);
    ShaderSourceByName(fs, (char *)name);
    AttachShader(made, vs);
    AttachShader(made, fs);
    BindAttribLocation(made, 0, (char *)"position");
    BindAttribLocation(made, 1, (char *)(scene->geometry == QUAD ? "texcoord" : "first"));
    BindAttribLocation(made, 2, (char *)"second");
    LinkProgram(made);
    UseProgram(made);
    GLint sampler = GetUniformLocation(made, (char *)"checker");
    if (sampler >= 0)
        Uniform1i(sampler, 0);
    return made;
}

static void make_program()
{
    char name[32];
    snprintf(name, sizeof name, "%s%s", inverts() ? "mask" : scene->shader, span ? "_span" : "");
    if (inverts())
        invert = link("invert_span");
    program = link(name);
    uint32_t c = scene->color;
    set4("constant", (c >> 16 & 255) / 255.0f, (c >> 8 & 255) / 255.0f, (c & 255) / 255.0f,
         (c >> 24) / 255.0f);
    if (!strcmp(scene->shader, "mads")) {
        set4("factor", 0.99f, 0.985f, 0.99f, 1);
        set4("term", 0.002f, 0.003f, 0.004f, 0);
    }
    if (!strcmp(scene->shader, "phong")) {
        set4("light", 0.5f, 0.8f, 1.5f, 0);
        set4("eye", 0, 0, 2, 0);
        set4("diffuse", 0.2f, 0.4f, 0.7f, 0);
        set4("ambient", 0.05f, 0.05f, 0.1f, 1);
        set4("specular", 0.8f, 0.8f, 0.6f, 0);
    }
    if (!strcmp(scene->shader, "two"))
        Uniform1i(GetUniformLocation(program, (char *)"gradient"), 1);
}

static void set_filter()
{
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, scene->linear ? GL_LINEAR : GL_NEAREST);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, scene->linear ? GL_LINEAR : GL_NEAREST);
}

static void make_texture(unsigned unit, unsigned side, uint32_t (*at)(unsigned, unsigned, unsigned))
{
    static uint32_t texels[SIDE * SIDE];
    for (unsigned i = 0; i < side * side; i++)
        texels[i] = at(i % side, i / side, side);
    ActiveTexture(GL_TEXTURE0 + unit);
    BindTexture(GL_TEXTURE_2D, textures[unit]);
    TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    set_filter();
}

// A clip mask has the rows of the target, from the bottom.
static void make_bytes()
{
    static uint8_t texels[SIDE * SIDE];
    bool upward = span && !inverts();
    for (unsigned i = 0; i < SIDE * SIDE; i++)
        texels[i] = gles_mask(i % SIDE, upward ? SIDE - 1 - i / SIDE : i / SIDE);
    ActiveTexture(GL_TEXTURE0);
    BindTexture(GL_TEXTURE_2D, textures[0]);
    PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    TexImage2D(GL_TEXTURE_2D, 0, GL_R8, SIDE, SIDE, 0, GL_RED, GL_UNSIGNED_BYTE, texels);
    set_filter();
    if (!inverts())
        return;
    GenTextures(1, &bytes);
    BindTexture(GL_TEXTURE_2D, bytes);
    TexImage2D(GL_TEXTURE_2D, 0, GL_R8, SIDE, SIDE, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
    GenFramebuffers(1, &bytes_target);
    BindFramebuffer(GL_DRAW_FRAMEBUFFER, bytes_target);
    FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, bytes, 0);
    BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
}

static void make_textures()
{
    GenTextures(2, textures);
    switch (scene->picture) {
    case NONE: break;
    case CHECKER:
        make_texture(0, 256, gles_checker);
        if (!strcmp(scene->shader, "two"))
            make_texture(1, 256, gles_gradient);
        break;
    case PICTURE: make_texture(0, SIDE, gles_gradient); break;
    case PATTERN: make_texture(0, 64, gles_gradient); break;
    case BYTES: make_bytes(); break;
    }
}

static void make_geometry()
{
    static const float arithmetic[4][4] = {
        {-0.6f, 0.7f, 1, 1}, {0.8f, 0.5f, 1, 1}, {-0.5f, -0.6f, 1, 1}, {0.9f, -0.8f, 1, 1}};
    static const float colors[4][4] = {
        {0.1f, 0.9f, 0.3f, 1}, {0.7f, 0.7f, 0.2f, 1}, {0.3f, 0.2f, 0.9f, 1}, {0.9f, 0, 0.8f, 1}};
    static float vertices[32 * 4][12];
    static uint16_t indices[32][6];
    for (unsigned i = 0; i < 128; i++) {
        float x = i % 2 ? 1 : -1, y = i % 4 < 2 ? 1 : -1;
        float *v = vertices[i];
        v[0] = x, v[1] = y, v[2] = scene->geometry == QUADS ? 0.9f - (float)(i / 4) * 0.03125f : 0, v[3] = 1;
        if (scene->geometry == QUAD) {
            v[4] = x > 0 ? scene->high : scene->low, v[5] = y > 0 ? scene->low : scene->high;
        } else {
            memcpy(v + 4, scene->geometry == COLORS ? colors[i % 4] : arithmetic[i % 4], 16);
            v[8] = x, v[9] = y, v[10] = 0, v[11] = 0;
        }
    }
    for (unsigned i = 0; i < 32; i++) {
        const uint16_t quad[6] = {0, 1, 2, 2, 1, 3};
        for (unsigned k = 0; k < 6; k++)
            indices[i][k] = (uint16_t)(quad[k] + 4 * i);
    }
    BindVertexArray(array);
    GenBuffers(2, buffers);
    BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    BufferData(GL_ARRAY_BUFFER, sizeof vertices, vertices, 0);
    BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    BufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, 0);
    for (GLuint i = 0; i < 3; i++) {
        EnableVertexAttribArray(i);
        VertexAttribPointer(i, i == 1 && scene->geometry == QUAD ? 2 : 4, GL_FLOAT, false, 48, 16 * i);
    }
}

extern "C" const char *renderer_open(const struct workload *wanted)
{
    workload = nullptr;
    if (wanted->group == PAGE) {
        const char *failed = swgl_page_open(wanted->name, span);
        workload = failed ? nullptr : wanted;
        return failed;
    }
    scene = nullptr;
    for (const struct scene &each : scenes)
        if (!strcmp(each.name, wanted->name))
            scene = &each;
    if (!scene || (span && !has_span()))
        return "none";
    workload = wanted;
    make_textures();
    make_geometry();
    (scene->blend ? Enable : Disable)(GL_BLEND);
    if (scene->blend)
        BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    (scene->depth ? Enable : Disable)(GL_DEPTH_TEST);
    DepthFunc(scene->geometry == QUADS ? GL_LESS : GL_LEQUAL);
    DepthMask(true);
    bool fails = scene->depth && scene->geometry == QUAD;
    ClearColor(fails ? 0.2f : 0, fails ? 0.4f : 0, fails ? 0.6f : 0, 1);
    ClearDepth(fails ? 0.25 : 1);
    SetViewport(0, 0, SIDE, SIDE);
    Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    program = 0;
    return nullptr;
}

extern "C" const char *renderer_limit(bool limited)
{
    if (workload->group == PAGE)
        return nullptr;
    (limited ? Enable : Disable)(GL_SCISSOR_TEST);
    SetScissor(508, 508, 8, 8);
    return nullptr;
}

static void draw_inverse()
{
    BindFramebuffer(GL_DRAW_FRAMEBUFFER, bytes_target);
    Disable(GL_BLEND);
    BindTexture(GL_TEXTURE_2D, textures[0]);
    UseProgram(invert);
    DrawElementsInstanced(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, 0, 1);
    BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    Enable(GL_BLEND);
    BindTexture(GL_TEXTURE_2D, bytes);
    UseProgram(program);
}

extern "C" const char *renderer_frame(bool less)
{
    if (workload->group == PAGE) {
        swgl_page_draw();
        return nullptr;
    }
    if (!program)
        make_program();
    if (workload->kind != LAYER)
        Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (inverts())
        draw_inverse();
    for (unsigned i = 0; i < (less ? workload->less : workload->full); i++)
        DrawElementsInstanced(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, scene->geometry == QUADS ? i * 12 : 0, 1);
    GetColorBuffer(0, true, nullptr, nullptr, nullptr); // carries out a clear that was put off
    Finish();
    return nullptr;
}

extern "C" const char *renderer_read(uint32_t *rgba, bool *upward)
{
    *upward = true;
    ReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    return nullptr;
}

extern "C" const char *renderer_build(unsigned)
{
    return "no compiler";
}
extern "C" double renderer_build_us(void)
{
    return -1;
}
extern "C" void renderer_close(void)
{
    if (workload && workload->group == PAGE) {
        swgl_page_close();
        workload = nullptr;
    }
    if (!workload)
        return;
    for (GLuint *each : {&program, &invert}) {
        if (*each)
            DeleteProgram(*each);
        *each = 0;
    }
    if (bytes)
        DeleteFramebuffer(bytes_target), DeleteTexture(bytes);
    bytes = 0;
    for (int i = 0; i < 2; i++)
        DeleteTexture(textures[i]), DeleteBuffer(buffers[i]);
    workload = nullptr;
}
