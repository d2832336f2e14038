precision mediump float;
varying vec4 v;
uniform float bound;

float triangle(float n)
{
    float sum = 0.0;
    for (float i = 1.0; i <= n; i++) {
        if (i == 3.0)
            continue;
        sum += i;
        if (sum > bound)
            break;
    }
    return sum;
}

void main()
{
    float x = 0.0;
    int i = 0;
    do {
        x += triangle(v.x + float(i));
        i++;
    } while (i < 3 && x < bound);
    if (v.y > 1.0)
        return;
    gl_FragColor = vec4(x, i, v.z, 1.0);
}
