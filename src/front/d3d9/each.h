/* D3D9_EACH(f, (a, b), (c, d), ...) is f(a, b) f(c, d) ..., for up to 12 lists in parentheses. The arguments
 * of the methods in the folder calls are such lists. */
#ifndef D3D9_EACH_H
#define D3D9_EACH_H

#define D3D9_EACH(f, ...)                                                                                    \
    __VA_OPT__(D3D9_EACH_COUNT(__VA_ARGS__, D3D9_EACH12, D3D9_EACH11, D3D9_EACH10, D3D9_EACH9, D3D9_EACH8,   \
                               D3D9_EACH7, D3D9_EACH6, D3D9_EACH5, D3D9_EACH4, D3D9_EACH3, D3D9_EACH2,       \
                               D3D9_EACH1)(f, __VA_ARGS__))
#define D3D9_EACH_COUNT(a, b, c, d, e, f, g, h, i, j, k, l, name, ...) name

#define D3D9_EACH1(f, a)       f a
#define D3D9_EACH2(f, a, ...)  f a D3D9_EACH1(f, __VA_ARGS__)
#define D3D9_EACH3(f, a, ...)  f a D3D9_EACH2(f, __VA_ARGS__)
#define D3D9_EACH4(f, a, ...)  f a D3D9_EACH3(f, __VA_ARGS__)
#define D3D9_EACH5(f, a, ...)  f a D3D9_EACH4(f, __VA_ARGS__)
#define D3D9_EACH6(f, a, ...)  f a D3D9_EACH5(f, __VA_ARGS__)
#define D3D9_EACH7(f, a, ...)  f a D3D9_EACH6(f, __VA_ARGS__)
#define D3D9_EACH8(f, a, ...)  f a D3D9_EACH7(f, __VA_ARGS__)
#define D3D9_EACH9(f, a, ...)  f a D3D9_EACH8(f, __VA_ARGS__)
#define D3D9_EACH10(f, a, ...) f a D3D9_EACH9(f, __VA_ARGS__)
#define D3D9_EACH11(f, a, ...) f a D3D9_EACH10(f, __VA_ARGS__)
#define D3D9_EACH12(f, a, ...) f a D3D9_EACH11(f, __VA_ARGS__)

#endif
