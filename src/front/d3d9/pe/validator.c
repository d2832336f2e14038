/* Direct3DShaderValidatorCreate9: an object through which the shader compiler of the DirectX SDK checks its
 * output. It accepts every instruction: CreateVertexShader and CreatePixelShader check shaders. There is one,
 * which exists as long as the DLL, so that its references are not counted. */
#include <windows.h>
#include <d3d9.h>

struct validator;

typedef HRESULT(WINAPI *validator_callback)(const char *file, int line, DWORD_PTR reserved, DWORD_PTR message,
                                            const char *text, void *context);

struct validator_vtable {
    HRESULT(WINAPI *QueryInterface)(struct validator *, REFIID, void **);
    ULONG(WINAPI *AddRef)(struct validator *);
    ULONG(WINAPI *Release)(struct validator *);
    HRESULT(WINAPI *Begin)(struct validator *, validator_callback, void *context, DWORD_PTR reserved);
    HRESULT(WINAPI *Instruction)
    (struct validator *, const char *file, int line, const DWORD *tokens, UINT count);
    HRESULT(WINAPI *End)(struct validator *);
};

struct validator {
    const struct validator_vtable *vtable;
};

static HRESULT WINAPI query_interface(struct validator *self, REFIID iid, void **out)
{
    (void)self, (void)iid;
    *out = NULL;
    return E_NOINTERFACE;
}

static ULONG WINAPI add_ref(struct validator *self)
{
    (void)self;
    return 2;
}

static ULONG WINAPI release(struct validator *self)
{
    (void)self;
    return 1;
}

static HRESULT WINAPI begin(struct validator *self, validator_callback callback, void *context,
                            DWORD_PTR reserved)
{
    (void)self, (void)callback, (void)context, (void)reserved;
    return S_OK;
}

static HRESULT WINAPI instruction(struct validator *self, const char *file, int line, const DWORD *tokens,
                                  UINT count)
{
    (void)self, (void)file, (void)line, (void)tokens, (void)count;
    return S_OK;
}

static HRESULT WINAPI end(struct validator *self)
{
    (void)self;
    return S_OK;
}

void *WINAPI Direct3DShaderValidatorCreate9(void)
{
    static const struct validator_vtable vtable = {query_interface, add_ref,     release,
                                                   begin,           instruction, end};
    static struct validator validator = {&vtable};
    return &validator;
}
