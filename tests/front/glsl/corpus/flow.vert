/* Loops without a constant bound, returns from them, out parameters. */
attribute vec4 position;
uniform int count;
uniform bool bent;
varying vec4 v;

bool solve(in float x, out float root, inout int steps)
{
    root = x;
    while (true) {
        float next = 0.5 * (root + x / root);
        if (abs(next - root) < 1e-6)
            return true;
        if (++steps > count)
            return false;
        root = next;
    }
    return false;
}

void main()
{
    int steps = 0;
    float root;
    bool good = solve(position.x, root, steps) && (bent || solve(root, root, steps));
    v = vec4(root, steps, good, bent ? position.y : position.z);
    gl_Position = position;
}
