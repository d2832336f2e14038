/* Matrices in an array with an index of an attribute; a texture in a vertex shader. */
attribute vec4 position, weights;
attribute vec4 bones;
uniform vec4 matrices[60];
uniform mat4 projection;
uniform sampler2D heights;
varying float v_height;

vec4 place(float bone)
{
    int i = int(bone) * 3;
    return vec4(dot(matrices[i], position), dot(matrices[i + 1], position), dot(matrices[i + 2], position), 1.0);
}

void main()
{
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++)
        sum += place(bones[i]) * weights[i];
    v_height = texture2DLod(heights, sum.xz * 0.01, 0.0).r;
    sum.y += v_height;
    gl_Position = projection * sum;
    gl_PointSize = clamp(10.0 / sum.w, 1.0, 8.0);
}
