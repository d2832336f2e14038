/* Arrays and structures by indices, and varyings that are arrays and matrices. */
struct Inner {
    vec2 a[2];
    mat2 m;
};
struct Outer {
    Inner inner[2];
    float f;
};
attribute vec4 position;
attribute mat3 basis;
uniform Outer outer[2];
uniform int first, second;
varying mat3 v_basis;
varying vec2 v_list[3];

void main()
{
    Outer local;
    local.inner[0].m = outer[first].inner[second].m;
    local.f = outer[first].f;
    local.inner[second].a[first] = position.xy;
    local.inner[0].m[second][first] += 1.0;
    for (int i = 0; i < 3; i++)
        v_list[i] = local.inner[second].a[first] * local.inner[0].m + vec2(i);
    v_basis = basis;
    v_basis[first] = basis[second] * local.f;
    gl_Position = position * outer[1].inner[first].m[0].y;
}
