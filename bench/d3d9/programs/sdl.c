/* Sprites, geometry, blending and render targets by SDL's renderer "direct3d" (SDL2.dll of pysdl2-dll).
 * frames.h defines the arguments. */
#include "frames.h"
#define SDL_MAIN_HANDLED
#include <SDL.h>
#include <math.h>

enum { WIDTH = 800, HEIGHT = 600, SPRITES = 600, SPRITE = 64, WHEEL = 24 };

struct scene {
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *sprite, *checker, *target;
};

static void fail(const char *what)
{
    fprintf(stderr, "sdl: %s: %s\n", what, SDL_GetError());
    exit(1);
}

/* A soft disc: white, with alpha that falls towards the border. */
static Uint32 disc(int x, int y)
{
    const float dx = (x + 0.5f) / SPRITE * 2 - 1, dy = (y + 0.5f) / SPRITE * 2 - 1;
    const float alpha = 1 - sqrtf(dx * dx + dy * dy);
    const Uint32 shade = (Uint32)(160 + 95 * (1 - dy) / 2);
    return (Uint32)(alpha <= 0 ? 0 : alpha * 255) << 24 | shade << 16 | shade << 8 | shade;
}

static Uint32 checker(int x, int y)
{
    return (x / 8 + y / 8) % 2 ? 0xffd0a040u : 0xff305090u;
}

static SDL_Texture *make_texture(SDL_Renderer *renderer, Uint32 (*texel)(int, int))
{
    static Uint32 texels[SPRITE * SPRITE];
    for (int i = 0; i < SPRITE * SPRITE; i++)
        texels[i] = texel(i % SPRITE, i / SPRITE);
    SDL_Texture *texture =
        SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ARGB8888, SDL_TEXTUREACCESS_STATIC, SPRITE, SPRITE);
    if (!texture || SDL_UpdateTexture(texture, NULL, texels, SPRITE * 4))
        fail("texture");
    SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_BLEND);
    return texture;
}

static struct scene open_scene(void)
{
    SDL_SetHint(SDL_HINT_RENDER_DRIVER, "direct3d");
    SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
    SDL_SetMainReady();
    struct scene scene = {0};
    if (SDL_Init(SDL_INIT_VIDEO))
        fail("video");
    scene.window = SDL_CreateWindow("sdl", 0, 0, WIDTH, HEIGHT, SDL_WINDOW_BORDERLESS);
    scene.renderer =
        SDL_CreateRenderer(scene.window, -1, SDL_RENDERER_ACCELERATED | SDL_RENDERER_TARGETTEXTURE);
    SDL_RendererInfo info;
    if (!scene.renderer || SDL_GetRendererInfo(scene.renderer, &info))
        fail("renderer");
    printf("renderer %s\n", info.name);
    scene.sprite = make_texture(scene.renderer, disc);
    scene.checker = make_texture(scene.renderer, checker);
    scene.target =
        SDL_CreateTexture(scene.renderer, SDL_PIXELFORMAT_ARGB8888, SDL_TEXTUREACCESS_TARGET, 256, 256);
    if (!scene.target)
        fail("target");
    return scene;
}

/* A wheel of triangles with a colour at each corner. */
static void draw_wheel(const struct scene *scene, float x, float y, float radius, float angle)
{
    SDL_Vertex corners[3 * WHEEL];
    for (int i = 0; i < WHEEL; i++) {
        const float a = angle + 6.2831853f * i / WHEEL, b = angle + 6.2831853f * (i + 1) / WHEEL;
        const Uint8 step = (Uint8)(255 * i / WHEEL);
        corners[3 * i] = (SDL_Vertex){{x, y}, {255, 255, 255, 255}, {0.5f, 0.5f}};
        corners[3 * i + 1] = (SDL_Vertex){
            {x + radius * cosf(a), y + radius * sinf(a)}, {step, (Uint8)(255 - step), 128, 255}, {0, 0}};
        corners[3 * i + 2] = (SDL_Vertex){
            {x + radius * cosf(b), y + radius * sinf(b)}, {255, step, (Uint8)(255 - step), 160}, {1, 1}};
    }
    SDL_SetRenderDrawBlendMode(scene->renderer, SDL_BLENDMODE_BLEND);
    SDL_RenderGeometry(scene->renderer, NULL, corners, 3 * WHEEL, NULL, 0);
    SDL_RenderGeometry(scene->renderer, scene->checker, corners, 3 * WHEEL / 2, NULL, 0);
}

static void draw_target(const struct scene *scene, long frame)
{
    SDL_SetRenderTarget(scene->renderer, scene->target);
    SDL_SetRenderDrawColor(scene->renderer, 16, 32, 48, 255);
    SDL_RenderClear(scene->renderer);
    draw_wheel(scene, 128, 128, 110, 0.02f * (float)frame);
    SDL_SetRenderDrawColor(scene->renderer, 255, 255, 0, 255);
    for (int i = 0; i < 256; i += 16)
        SDL_RenderDrawLine(scene->renderer, i, 0, 255 - i, 255);
    SDL_SetRenderTarget(scene->renderer, NULL);
}

static void draw_sprites(const struct scene *scene, long frame)
{
    static const SDL_BlendMode modes[] = {SDL_BLENDMODE_BLEND, SDL_BLENDMODE_ADD, SDL_BLENDMODE_MOD,
                                          SDL_BLENDMODE_MUL};
    for (int i = 0; i < SPRITES; i++) {
        const float a = 0.013f * (float)frame + 0.71f * (float)i,
                    b = 0.017f * (float)frame + 0.37f * (float)i;
        const float size = 16 + (float)(i % 7) * 8;
        const SDL_FRect place = {(WIDTH - size) * (0.5f + 0.5f * sinf(a)),
                                 (HEIGHT - size) * (0.5f + 0.5f * cosf(b)), size, size};
        SDL_Texture *texture = i % 16 ? scene->sprite : scene->checker;
        SDL_SetTextureBlendMode(texture, modes[i / (SPRITES / 4) % 4]);
        SDL_SetTextureColorMod(texture, (Uint8)(i * 37), (Uint8)(i * 91), (Uint8)(255 - i * 53));
        SDL_SetTextureAlphaMod(texture, (Uint8)(128 + i % 128));
        SDL_RenderCopyExF(scene->renderer, texture, NULL, &place, i % 3 ? a * 57.2957795f : 0, NULL,
                          SDL_FLIP_NONE);
    }
}

static void draw_frame(const struct scene *scene, long frame)
{
    const SDL_FRect left = {20, 20, 300, 300}, right = {420, 250, 360, 330};
    const SDL_Rect clip = {430, 20, 340, 200};
    draw_target(scene, frame);
    SDL_SetRenderDrawColor(scene->renderer, 40, 44, 52, 255);
    SDL_RenderClear(scene->renderer);
    SDL_SetTextureBlendMode(scene->target, SDL_BLENDMODE_NONE);
    SDL_RenderCopyF(scene->renderer, scene->target, NULL, &left);
    SDL_RenderCopyExF(scene->renderer, scene->target, NULL, &right, (double)frame, NULL, SDL_FLIP_HORIZONTAL);
    SDL_RenderSetClipRect(scene->renderer, &clip);
    draw_wheel(scene, 600, 120, 180, -0.01f * (float)frame);
    SDL_RenderSetClipRect(scene->renderer, NULL);
    draw_sprites(scene, frame);
    SDL_RenderPresent(scene->renderer);
}

int main(int count, char **arguments)
{
    struct frames frames = frames_begin(count, arguments);
    const struct scene scene = open_scene();
    for (long frame; (frame = frames_next(&frames)) >= 0;) {
        SDL_Event event;
        while (SDL_PollEvent(&event))
            ;
        draw_frame(&scene, frame);
    }
    SDL_DestroyRenderer(scene.renderer);
    SDL_Quit();
    return 0;
}
