#include "hook.h"
#include <stdlib.h>

/* A replaced procedure. It is kept after the device's end if the program has put another one before it. */
struct hook {
    struct hook *next;
    HWND window;
    WNDPROC previous;
    BOOL unicode;
    struct device_data *device; /* null: messages only pass through */
};

static struct hook *hooks;
static SRWLOCK lock = SRWLOCK_INIT;

/* With the lock held. A window may have hooks of several devices; the first is the newest. */
static struct hook **find(HWND window, const struct device_data *device)
{
    struct hook **link = &hooks;
    while (*link && ((*link)->window != window || (device && (*link)->device != device)))
        link = &(*link)->next;
    return link;
}

static LRESULT CALLBACK procedure(HWND window, UINT message, WPARAM wparam, LPARAM lparam)
{
    struct hook hook = {.device = NULL};
    AcquireSRWLockShared(&lock);
    struct hook *found = *find(window, NULL);
    if (found)
        hook = *found;
    ReleaseSRWLockShared(&lock);

    BOOL unicode = hook.previous ? hook.unicode : IsWindowUnicode(window);
    LRESULT(*WINAPI default_procedure)
    (HWND, UINT, WPARAM, LPARAM) = unicode ? DefWindowProcW : DefWindowProcA;
    if (!hook.previous || (hook.device && hook.device->filter && message != WM_DISPLAYCHANGE))
        return default_procedure(window, message, wparam, lparam);
    if (hook.device && message == WM_ACTIVATEAPP)
        fullscreen_activate(hook.device, wparam != 0);
    if (hook.device && message == WM_SYSCOMMAND && wparam == SC_RESTORE)
        default_procedure(window, message, wparam, lparam);
    if (message == WM_NCDESTROY) {
        AcquireSRWLockExclusive(&lock);
        struct hook **link = find(window, NULL), *gone = *link;
        if (gone)
            *link = gone->next;
        ReleaseSRWLockExclusive(&lock);
        free(gone);
    }
    return unicode ? CallWindowProcW(hook.previous, window, message, wparam, lparam)
                   : CallWindowProcA(hook.previous, window, message, wparam, lparam);
}

static LONG_PTR set_procedure(HWND window, BOOL unicode, WNDPROC with)
{
    return unicode ? SetWindowLongPtrW(window, GWLP_WNDPROC, (LONG_PTR)with)
                   : SetWindowLongPtrA(window, GWLP_WNDPROC, (LONG_PTR)with);
}

static LONG_PTR get_procedure(HWND window, BOOL unicode)
{
    return unicode ? GetWindowLongPtrW(window, GWLP_WNDPROC) : GetWindowLongPtrA(window, GWLP_WNDPROC);
}

void hook_set(struct device_data *device)
{
    struct hook *hook = calloc(1, sizeof *hook);
    if (!hook || !IsWindow(device->focus)) {
        free(hook);
        return;
    }
    *hook =
        (struct hook){.window = device->focus, .unicode = IsWindowUnicode(device->focus), .device = device};
    AcquireSRWLockExclusive(&lock);
    struct hook *same = *find(device->focus, device), *other = *find(device->focus, NULL);
    if (same) {
        free(hook);
    } else {
        hook->previous = other ? other->previous : (WNDPROC)get_procedure(hook->window, hook->unicode);
        hook->next = hooks;
        hooks = hook;
    }
    ReleaseSRWLockExclusive(&lock);
    if (!same && !other)
        set_procedure(hook->window, hook->unicode, procedure);
}

void hook_remove(struct device_data *device)
{
    AcquireSRWLockExclusive(&lock);
    struct hook **link = find(device->focus, device), *hook = *link;
    BOOL restore = FALSE;
    if (hook) {
        *link = hook->next;
        BOOL shared = *find(hook->window, NULL) != NULL;
        BOOL ours = get_procedure(hook->window, hook->unicode) == (LONG_PTR)procedure;
        restore = !shared && ours;
        if (!shared && !ours && IsWindow(hook->window)) {
            hook->device = NULL;
            hook->next = hooks;
            hooks = hook;
            hook = NULL;
        }
    }
    ReleaseSRWLockExclusive(&lock);
    if (restore)
        set_procedure(hook->window, hook->unicode, hook->previous);
    free(hook);
}
