/* Bad streams: each gives one line that begins with the place, says what was found and what was expected;
 * none has any effect. The texts' line 1 is the header, so that a case's first line is line 2. */
#include "stream/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct error error;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

struct bad {
    const char *text;  /* after the header */
    const char *place; /* LINE:COLUMN */
    const char *part;  /* of the reason */
};

/* The whole text is bad from the first line on, or not text at all. */
static const struct bad whole[] = {
    {"", "1:1", "found the end of the file, expected the first line: triptych 1"},
    {"triptych", "1:9", "expected version 1"},
    {"triptych 2\n", "1:10", "found '2', expected version 1"},
    {"\ntriptych 1\n", "1:1", "found the end of the line, expected the first line"},
    {"triptych 1 x\n", "1:12", "found 'x', expected the end of the line"},
    {"\x89PNG\r\n\x1a\n", "1:1", "found byte 0x89, expected UTF-8"},
    {"triptych 1\n# \xc3\x28\n", "2:3", "found byte 0xc3, expected UTF-8"},
    {"triptych 1\n# \xed\xa0\x80\n", "2:3", "found byte 0xed, expected UTF-8"},
    {"triptych 1\n\tframe\x07\n", "2:7", "found control character 0x07"},
    {"triptych 1\nframe\rframe\n", "2:6", "found control character 0x0d"},
    {"triptych 1\n", "2:1", "expected at least one call"},
    {"triptych 1\nsequence s\nend\nplay s\n", "5:1", "expected at least one call that is executed"},
};

static const struct bad lines[] = {
    /* Lines */
    {"paint it\n", "2:1", "found 'paint', expected a call: target, viewport, scissor, state, sampler"},
    {"  # fine\n\n   paint it\n", "4:4", "found 'paint'"},
    {"\"frame\"\n", "2:1", "found '\"frame\"', expected a call"},
    {"}\n", "2:1", "found '}', expected a call"},
    {"frame frame\n", "2:7", "found 'frame', expected the end of the line"},
    {"texture t file \"no end\n", "2:16", "found a string without an end"},
    {"texture t file \"no end\\\"\n", "2:16", "found a string without an end"},

    /* Targets and viewports */
    {"target 0 10\n", "2:8", "found '0', expected an integer (target width) from 1 to 8192"},
    {"target 10 8193\n", "2:11", "expected an integer (target height) from 1 to 8192"},
    {"target 10\n", "2:10", "found the end of the line, expected an integer (target height)"},
    {"target 99999999999999999999 1\n", "2:8", "expected an integer"},
    {"target 1e1 1\n", "2:8", "found '1e1', expected an integer"},
    {"viewport 0 0 1 1 0 1\n", "2:1", "found no target, expected target WIDTH HEIGHT before it"},
    {"target 8 8\nviewport 1 0 8 8 0 1\n", "3:1", "expected a part of the target of 8x8 pixels"},
    {"target 8 8\nviewport 0 0 8 8 0 2\n", "3:1", "expected values from 0 to 1"},
    {"scissor 0 0 1 1\n", "2:1", "found no target, expected target WIDTH HEIGHT before it"},
    {"target 8 8\nscissor 1 0 8 8\n", "3:1", "expected a part of the target of 8x8 pixels"},
    {"target 8 8\nscissor 0 0 8\n", "3:14", "expected an integer (scissor height) from 0 to 8192"},
    {"target 8 8\nviewport 0 0 8 8 0\n", "3:19", "expected a number (viewport X Y WIDTH HEIGHT NEAR FAR)"},
    {"target 8 8\nclear depth 2\n", "3:1", "clear depth 2: expected 0 to 1"},
    {"target 8 8\nclear stencil 1\n", "3:1",
     "clear of stencil: the target's depth format is d32f_lockable, expected one with stencil"},
    {"target 8 8 depth none\nclear depth 1\n", "3:1",
     "clear of depth: the target's depth format is none, expected one with depth"},
    {"target 8 8 depth d24s8\nclear stencil 256\n", "3:7",
     "found stencil 256, expected an integer from 0 to 255"},
    {"target 8 8 depth d24s8\nclear stencil 0.5\n", "3:7", "expected an integer from 0 to 255"},
    {"target 8 8 samples 2 color A8R8G8B8 A8R8G8B8\n", "2:12",
     "found several colours, expected one with 2 samples"},
    {"target 8 8 samples 3\n", "2:12", "found 3 samples, expected 1, 2, 4 or 8"},
    {"target 8 8 samples 16\n", "2:20", "expected an integer (samples per pixel) from 1 to 8"},
    {"target 8 8 depth d23\n", "2:18", "found 'd23', expected a depth format: d32f_lockable, d16, "},
    {"attach\n", "2:7", "found the end of the line, expected none, color TEXTURE or depth TEXTURE"},
    {"texture t 2d L8 4 4 empty\nattach color t\n", "3:1", "colour target 0: format L8 cannot be drawn to"},
    {"texture t 2d R32F 4 4 levels 2 empty\nattach color t level 1 color t level 1\n", "3:1",
     "colour targets 0 and 1: the same surface, expected another one"},
    {"texture t 2d R32F 4 4 empty\nattach color t level 3\n", "3:1",
     "colour target 0: level 3 of a texture with 1"},
    {"texture t 2d R32F 4 4 empty\nattach color t depthformat d17\n", "3:28",
     "found 'd17', expected a depth format: d32f_lockable, d16, "},
    {"texture t 2d R32F 4 4 empty\ncopy t target\n", "3:8",
     "found 'target', expected level, slice, part, or to"},
    {"texture t 2d R32F 4 4 empty\ncopy t to target\n", "3:1",
     "target of a copy: colour target 0: the target has none of that number"},
    {"texture t 2d R32F 4 4 empty\ntarget 8 8\ncopy t part 3 0 2 2 to target linear\n", "4:1",
     "source of a copy: 2x2 pixels at 3, 0: expected a part of 4x4"},
    {"target 8 8 color DXT1\n", "2:18", "found 'DXT1', expected the name of a format that can be a target"},
    {"target 8 8 depth none color\n", "2:28", "expected the name of a format that can be a target"},
    {"target 8 8 color R32F R32F R32F R32F R32F\n", "2:38", "found 'R32F', expected the end of the line"},
    {"target 8 8\nclear\n", "3:6", "expected color R G B A, depth D, stencil S, or several of them"},
    {"target 8 8\nclear color 1 1 1\n", "3:18", "expected a number (color)"},
    {"target 8 8\nclear depth 1 depth 1\n", "3:15",
     "found 'depth', expected color, stencil, or the end of the line"},
    {"clear depth 1\n", "2:1", "found no target"},

    /* Queries */
    {"query q\nbegin-query r\n", "3:13", "expected the name of a query defined before"},
    {"query q\nquery q\n", "3:7", "expected a name that is not in use"},
    {"query q\nend-query q\n", "3:1", "found query q not begun, expected begin-query q before it"},
    {"query q\nbegin-query q\nbegin-query q\n", "4:1", "found query q begun again"},
    {"query q\nbegin-query q\nframe\nend-query q\n", "3:1", "expected end-query q in its frame"},
    {"query q\nbegin-query q\n", "3:1", "found query q begun and not ended"},
    {"sequence s\nquery q\nend\n", "3:1", "found 'query'"},

    /* Conventions and clip planes */
    {"convention pixelcentre half\n", "2:12", "expected a convention: pixelcenter, depthrange, multiply"},
    {"convention pixelcenter zero\n", "2:24", "expected its value: half, integer"},
    {"convention depthrange\n", "2:22", "expected its value: zero, minus"},
    {"convention multiply zero\n", "2:21", "expected its value: ieee, legacy"},
    {"clipplane 6 0 0 0 0\n", "2:11", "expected an integer (clip plane) from 0 to 5"},
    {"clipplane 0 1 2 3\n", "2:18", "expected a number (clipplane I A B C D)"},
    {"clipplane 0 1 2 3 inf\n", "2:19", "expected a number"},
    {"state clipplaneenable 64\n", "2:1", "expected 0 to 63"},
    {"state pointsize -1\n", "2:1", "expected a finite number from 0 up"},

    /* States */
    {"state zfunk less\n", "2:7", "found 'zfunk', expected the name of a state"},
    {"state zfunc lesser\n", "2:13", "expected a value of zfunc: never, less, equal, lessequal"},
    {"state zfunc\n", "2:12", "found the end of the line, expected a value of zfunc"},
    {"state zfunc 9\n", "2:1", "state zfunc: value 9 does not exist"},
    {"state ambient 0xfff\n", "2:15", "expected a color (ambient)"},
    {"state ambient red\n", "2:15", "expected a value of ambient: a number"},
    {"state colorwriteenable 16\n", "2:1", "expected 0 to 15"},
    {"sampler 0 addressu once\n", "2:20",
     "expected a value of addressu: wrap, mirror, clamp, border, mirroronce"},
    {"sampler 20 addressu wrap\n", "2:9", "expected an integer (sampler) from 0 to 19"},
    {"sampler addressu wrap\n", "2:9", "found 'addressu', expected an integer (sampler)"},
    {"sampler 0 colorop add\n", "2:11", "found 'colorop', expected the name of a sampler state"},
    {"stage 8 colorop add\n", "2:7", "expected an integer (stage) from 0 to 7"},
    {"stage 0 zfunc less\n", "2:9", "found 'zfunc', expected the name of a stage state"},
    {"stage 0 colorop always\n", "2:17", "expected a value of colorop: disable, selectarg1"},
    {"state depthbias inf\n", "2:17", "found 'inf', expected a number (depthbias)"},
    {"state adaptivetess_x 0.5\n", "2:1", "state adaptivetess_x: value 0.5 is not supported, expected 0"},

    /* Numbers and transforms */
    {"transform world scale 1 nan 1\n", "2:25", "found 'nan', expected a number (scale)"},
    {"transform world scale 1 1e39 1\n", "2:25", "in the range of binary32"},
    {"transform world scale 1 1x 1\n", "2:25", "found '1x', expected a number"},
    {"transform world scale 1 -inf 1\n", "2:25", "found '-inf', expected a number"},
    {"transform world\n", "2:16", "found the end of the line, expected identity, matrix"},
    {"transform model identity\n", "2:11", "expected a transform: world, view, projection, texture"},
    {"transform texture identity\n", "2:19", "expected an integer (texture matrix) from 0 to 7"},
    {"transform texture 8 identity\n", "2:19", "expected an integer (texture matrix) from 0 to 7"},
    {"transform world 256 identity\n", "2:17", "expected an integer (world matrix) from 0 to 255"},
    {"light 0 spot theta 2 phi 1\n", "2:1", "light theta 2: expected an angle from 0 to phi, 1"},
    {"light 0 spot phi 4\n", "2:1", "light phi 4: expected an angle from 0 to pi"},
    {"light 0 spot falloff -1\n", "2:1", "light falloff -1: expected 0 or more"},
    {"light 0 point theta 1\n", "2:15", "found 'theta', expected diffuse, ambient, specular, position"},
    {"material power -1\n", "2:1", "material power -1: expected 0 or more"},
    {"transform view skew 1 2 3\n", "2:16", "found 'skew', expected identity"},
    {"transform world rotate 90 0 0 0\n", "2:17", "expected an axis that is not zero"},
    {"transform view lookat 1 2 3 1 2 3 0 1 0\n", "2:16", "expected a point to look at that is not the eye"},
    {"transform view lookat-rh 0 0 0 0 2 0 0 1 0\n", "2:16",
     "expected an up direction that is not along the view"},
    {"transform projection perspective 180 1 1 2\n", "2:22", "expected 0 < FOVY < 180"},
    {"transform projection perspective 90 1 2 2\n", "2:22", "0 < NEAR < FAR"},
    {"transform projection orthographic 1 1 0 1 0 1\n", "2:22", "LEFT and RIGHT"},
    {"transform world scale 1e30 1 1 scale 1e30 1 1\n", "2:17", "found a matrix with infinite values"},
    {"transform world matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0\n", "2:53", "expected a number (matrix)"},

    /* Light */
    {"light 8 on\n", "2:7", "expected an integer (light) from 0 to 7"},
    {"light 0 area\n", "2:9", "expected directional, point, spot, on or off"},
    {"light 0 directional position 0 0 0\n", "2:21",
     "found 'position', expected diffuse, ambient, specular, direction"},
    {"light 0 directional direction 0 0 0\n", "2:1", "expected a direction other than zero"},
    {"light 0 point range -1\n", "2:1", "expected 0 or more"},
    {"material shiny 1\n", "2:10",
     "found 'shiny', expected diffuse, ambient, emissive, specular, power, or the end of the line"},

    /* Names and resources */
    {"texture none 1 1 { ffffffff }\n", "2:9", "found 'none', expected a name"},
    {"texture 1a 1 1 { ffffffff }\n", "2:9", "found '1a', expected a name"},
    {"texture a 1 1 { ffffffff }\nindices a 16 { 1 }\n", "3:9",
     "found 'a', expected a name that is not in use"},
    {"texture a 1 1 { fffffff }\n", "2:17", "found 'fffffff', expected a color (texel)"},
    {"texture a 1 2 { ffffffff }\n", "2:15", "found 1 texels, expected 2"},
    {"texture a 1 1 { ffffffff ffffffff }\n", "2:26", "expected at most 1 texels"},
    {"texture a 1 1 {\n  ffffffff\n", "4:1", "found the end of the file, expected texel or }"},
    {"texture a 1 1 ffffffff\n", "2:15", "found 'ffffffff', expected {"},
    {"texture a 0 1 { ffffffff }\n", "2:11", "texture width"},
    {"texture a\n", "2:10", "expected file \"PATH\", WIDTH HEIGHT { color... }, 2d, cube or volume"},
    {"texture a 2d A8 1 1\n", "2:20", "expected the contents: empty, bytes, colors, fill, checker, gradient"},
    {"texture a 2d A9 1 1 empty\n", "2:14", "found 'A9', expected the name of a format of Direct3D 9"},
    {"texture a 2d P8 1 1 empty\n", "2:11", "format P8 is not supported for textures"},
    {"texture a 2d L8 1 0 empty\n", "2:19", "expected an integer (texture height) from 1 to 8192"},
    {"texture a volume L8 1 1 2049 empty\n", "2:11", "depth 2049: expected 1 to 2048"},
    {"texture a cube D16 1 empty\n", "2:11", "format D16 for a cube texture: expected 2d"},
    {"texture a 2d L8 2 2 levels 3 empty\n", "2:11", "3 levels: expected at most 2"},
    {"texture a 2d L8 2 2 levels 15 empty\n", "2:28", "expected an integer (levels) from 0 to 14"},
    {"texture a volume A32B32G32R32F 500 500 500 empty\n", "2:11", "expected less"},
    {"texture a 2d L8 2 1 bytes { 0 }\n", "2:29", "found '0', expected bytes: pairs of hexadecimal digits"},
    {"texture a 2d L8 2 1 bytes { 0g }\n", "2:29", "expected bytes: pairs of hexadecimal digits"},
    {"texture a 2d L8 2 1 bytes { 00 }\n", "2:27", "found 1 bytes, expected 2"},
    {"texture a 2d L8 2 1 bytes { 00 0011 }\n", "2:32", "expected at most 2 bytes"},
    {"texture a 2d L8 2 1 bytes 0011\n", "2:27", "expected {"},
    {"texture a 2d L8 2 1 bytes { 00 00\n", "3:1", "expected bytes or }"},
    {"texture a 2d L8 2 1 colors { 00000000 }\n", "2:28", "found 1 texels, expected 2"},
    {"texture a cube L8 4 levels 2 fill { 00000000 }\n", "2:35", "found 1 colors, expected 12"},
    {"texture a 2d DXT1 4 4 gradient\n", "2:23", "found 'gradient', expected empty or bytes for format DXT1"},
    {"texture a 2d L8 4 4 checker 0 00000000 00000000\n", "2:29", "expected an integer (side of a square)"},
    {"texture a 2d L8 4 4 checker 1 00000000\n", "2:39", "expected a color"},
    {"texture a 2d L8 4 4 levels 2 files \"a.png\"\n", "2:36", "expected one level and one slice, or mips"},
    {"texture a 2d L8 4 4 files \"a.png\"\n", "2:27", "a.png: cannot open"},
    {"update a b\n", "2:8", "expected the name of a texture defined before"},
    {"mips a\n", "2:6", "expected the name of a texture defined before"},
    {"texture a 1 1 { ffffffff }\nupdate a b\n", "3:10",
     "expected the name of face, level, box, or a buffer"},
    {"texture a 1 1 { ffffffff }\nbuffer b u16 { 1 }\nupdate a b\n", "4:8", "found 2 bytes in b, expected 4"},
    {"texture a 1 1 { ffffffff }\nbuffer b u16 { 1 }\nupdate a level 1 b\n", "4:8",
     "face 0, level 1: expected 0 to 0, 0 to 0"},
    {"texture a 1 1 { ffffffff }\nbuffer b u32 { 1 }\nupdate a box 0 0 0 1 2 1 b\n", "4:8",
     "expected a part of level 0's 1x1x1"},
    {"texture a 1 1 { ffffffff }\nbuffer b u32 { 1 }\nupdate a box 0 0 0 0 1 1 b\n", "4:8",
     "found a box without texels"},
    {"texture a file \"\"\n", "2:16", "found a path of 0 bytes"},
    {"texture a file \"a\\b\"\n", "2:16", "in which \\ is only followed by"},
    {"texture a file \"missing.png\"\n", "2:16", "missing.png: cannot open: No such file or directory"},
    {"texture a file \"/dev/zero\"\n", "2:16", "/dev/zero: is no regular file, expected one"},
    {"mesh a file \"/dev/zero\"\n", "2:13", "/dev/zero: is no regular file, expected one"},
    {"mesh a bezier \"/dev/zero\" subdivisions 1\n", "2:15", "/dev/zero: is no regular file, expected one"},
    {"shader a \"/dev/zero\"\n", "2:10", "/dev/zero: is no regular file, expected one"},
    {"texture a file missing.png\n", "2:16", "expected the path of a file in double quotes"},
    {"vertices v position:float5 {\n1\n}\n", "2:12", "expected a format: float1, float2"},
    {"vertices v place:float3 {\n1\n}\n", "2:12", "expected ATTRIBUTE:FORMAT with position, normal"},
    {"vertices v position {\n1\n}\n", "2:12", "expected ATTRIBUTE:FORMAT with position, normal"},
    {"vertices v indices:ubyte4 {\n1 2 3 256\n}\n", "3:7", "expected an integer (indices) from 0 to 255"},
    {"vertices v normal:dec3n {\n1 2 512\n}\n", "3:5", "expected an integer (normal) from -512 to 511"},
    {"vertices v texcoord3:short2 {\n1 -32769\n}\n", "3:3", "(texcoord3) from -32768 to 32767"},
    {"vertices v specular:ushort4n {\n1 1 1\n}\n", "3:6", "expected an integer (specular)"},
    {"vertices v position:float16_2 {\n1 65520\n}\n", "3:3",
     "found 65520, expected a number in the range of binary16"},
    {"vertices v position:float1 position:float1 {\n1\n}\n", "2:28", "expected each attribute once"},
    {"vertices v position:float2 { 1 2\n}\n", "2:30", "expected the end of the line before the first vertex"},
    {"vertices v position:float2 {\n1 2 3\n}\n", "3:5",
     "expected the end of the line after a vertex of 2 values"},
    {"vertices v position:float2 {\n1 2\n1\n}\n", "4:2",
     "found the end of the line, expected a number (position)"},
    {"vertices v position:float1 diffuse:color {\n1 red\n}\n", "3:3", "expected a color (diffuse)"},
    {"vertices v position:float1 {\n}\n", "3:1", "expected a vertex before it"},
    {"vertices v position:float1 {\n1\n", "4:1", "expected a vertex or }"},
    {"indices i 8 { 1 }\n", "2:11", "expected 16 or 32"},
    {"indices i 16 { 65536 }\n", "2:16", "from 0 to 65535"},
    {"indices i 32 { -1 }\n", "2:16", "from 0 to 4294967295"},
    {"indices i 32 { }\n", "2:16", "expected index before it"},
    {"buffer b half { 1 }\n", "2:10", "expected a type of values: float, u16, u32, color"},
    {"mesh m cube\n", "2:8", "expected a mesh: file, bezier, box, grid, sphere, cylinder, torus, shadow"},
    {"mesh m grid 0 4\n", "2:13", "from 1 to 1024"},
    {"mesh m sphere 3 1\n", "2:17", "from 2 to 1024"},
    {"mesh m torus 0 4 4\n", "2:14", "found a radius of 0, expected more than 0"},
    {"mesh m box center\n", "2:12", "found 'center', expected repeat, or the end of the line"},
    {"mesh m box repeat 2\n", "2:20", "expected a number (repetition)"},
    {"mesh m box\nmesh s shadow n\n", "3:15", "expected the name of a mesh defined before"},
    {"mesh m box\nmesh s shadow m spot 0 0 0 1\n", "3:17", "expected directional or point"},
    {"mesh m box\nmesh s shadow m point 0 0 0 1 repeat 1 1\n", "3:31",
     "found 'repeat', expected the end of the line"},
    {"mesh m grid 1 1\nmesh s shadow m directional 0 1 0 1\n", "3:15", "s: no triangles"},
    {"mesh m bezier \"a.bez\"\n", "2:22", "expected subdivisions N"},
    {"mesh m bezier \"a.bez\" subdivisions 65\n", "2:36", "from 1 to 64"},
    {"mesh m bezier \"a.bez\" subdivisions 4 normals flat\n", "2:38",
     "found 'normals', expected texcoords, repeat, center"},
    {"mesh m bezier \"a.bez\" subdivisions 4\n", "2:15", "a.bez: cannot open"},
    {"mesh m file \"a.obj\" fit 0\n", "2:25", "found a size of 0, expected more than 0"},
    {"mesh m file \"a.obj\" normals hard\n", "2:29", "expected a kind of normals: smooth, flat"},
    {"mesh m file \"a.obj\"\n", "2:13", "a.obj: cannot open"},

    /* Binding and drawing */
    {"bind texture t\n", "2:14", "found 't', expected the name of a texture, or none, defined before"},
    {"indices i 16 { 1 }\nbind texture i\n", "3:14", "expected the name of a texture"},
    {"bind shader s\n", "2:6", "expected texture, vertices, indices, element or stream"},
    {"buffer b float { 1 }\nbind indices b\n", "3:14",
     "found a buffer of other values, expected one of u16 or u32"},
    {"buffer b float { 1 2 }\nbind element position float2 b 4 4\n", "3:1",
     "expected them inside the buffer of 8"},
    {"buffer b bytes { 1 }\n", "2:18", "pairs of hexadecimal digits"},
    {"buffer b bytes { 0g }\n", "2:18", "pairs of hexadecimal digits"},
    {"buffer b bytes {\n}\n", "3:1", "expected bytes before it"},
    {"buffer b bytes { 0011 }\nbind indices b\n", "3:15", "expected 16 or 32 bits"},
    {"buffer b float { bits:7fc0000 }\n", "2:18", "expected a number"},
    {"state fogend bits:7f800000\n", "2:14", "expected a number"},
    {"declare texcoord.16:float1\n", "2:9", "expected ATTRIBUTE:FORMAT"},
    {"declare texcoord.0:float1 texcoord:float2\n", "2:27", "expected each attribute once"},
    {"texture t 1 1 { ffffffff }\nbind texture t\nrelease t\n", "4:1", "found 't' bound as a texture"},
    {"texture t 1 1 { ffffffff }\nrelease t\nbind texture t\n", "4:1", "found 't', which was released"},
    {"buffer b bytes { 00 }\ntexture t 1 1 { ffffffff }\ntexels t b\n", "4:1",
     "found 1 bytes in b, expected 4"},
    {"buffer b bytes { 00 }\ntarget 1 1\ncontents b\n", "4:1", "found 1 bytes in b, expected 8"},
    {"buffer b bytes { 00 }\ncontents b\n", "3:1", "found no target"},
    {"mesh m data position:float3 {\n0 0 0\n} 16 { 0 0 }\n", "4:13", "three indices a triangle"},
    {"mesh m data position:float3 {\n0 0 0\n} 16 { 0 0 1 }\n", "4:15", "found index 1 in a mesh"},
    {"buffer b float { 1 2 }\nbind element position float1 b 0 65540\n", "3:34",
     "expected an integer (stride)"},
    {"buffer b color { ffffffff }\nbind element normal float2 b 0 4\n", "3:1", "8 bytes at offset 0"},

    /* Shaders */
    {"shader s\n", "2:9", "expected the path of a file in double quotes, or {"},
    {"shader none {\n}\n", "2:8", "expected a name"},
    {"shader s { vs_1_1\n}\n", "2:12", "expected the end of the line before the text of the shader"},
    {"shader s {\nvs_1_1\n", "2:11", "found a block without an end, expected a line that begins with }"},
    {"shader s {", "2:11", "found the end of the file, expected the end of the line"},
    {"shader s {\n}\n", "2:10", "s:1:1: found the end of the text, expected a version"},
    {"shader s {\n  vs_1_1\n  mov oPos, q0\n}\n", "2:10", "s:2:13: found 'q0', expected a register"},
    {"shader s {\nvs_1_1\nmov oPos, r0\n}\n", "2:10", "s:2:11: found r0"},
    {"shader s {\nps_2_0\nmov oC0, c0\n} x\n", "5:3", "found 'x', expected the end of the line"},
    {"shader s \"missing.vsa\"\n", "2:10", "missing.vsa: cannot open"},
    {"shader s \"tests/stream/errors.c\"\n", "2:10", "tests/stream/errors.c:"},
    {"shader s {\nps_2_0\nmov oC0, c0\n}\nshader s {\n}\n", "6:8", "expected a name that is not in use"},
    {"sequence q\nshader s {\n", "3:1", "found 'shader', expected a call of a sequence"},
    {"vertexshader s\n", "2:14", "expected the name of a vertex shader, or none, defined before"},
    {"shader s {\nps_2_0\nmov oC0, c0\n}\nvertexshader s\n", "6:14",
     "found a shader of model ps_2_0, expected a vertex shader"},
    {"mesh m box\npixelshader m\n", "3:13", "expected the name of a pixel shader, or none, defined before"},
    {"vertexconstant 8192 0 0 0 0\n", "2:16", "expected an integer (constant) from 0 to 8191"},
    {"vertexconstant 8191 0 0 0 0 1\n", "2:29",
     "found '1', expected the end of the line behind constant 8191"},
    {"pixelconstant 0\n", "2:16", "expected a number (constant X Y Z W)"},
    {"pixelconstant 0 1 2 3 4 5\n", "2:26", "found the end of the line, expected a number"},
    {"pixelconstant 0 1 2 3 nan\n", "2:23", "expected a number"},
    {"vertexinteger 2048 0 0 0\n", "2:15", "expected an integer (constant) from 0 to 2047"},
    {"vertexinteger 0 1 2\n", "2:20", "expected an integer (constant COUNT START STEP)"},
    {"vertexinteger 0 1 2 3 4 5\n", "2:25", "found '5', expected the end of the line"},
    {"pixelinteger 0 1 2 2147483648\n", "2:20", "to 2147483647"},
    {"vertexboolean 0\n", "2:16", "expected true or false"},
    {"vertexboolean 0 1\n", "2:17", "found '1', expected true or false"},
    {"pixelboolean 15 true true\n", "2:22", "expected the end of the line behind constant 15"},
    {"vertexconstant 0 transform\n", "2:27", "expected identity, matrix"},
    {"vertexconstant 0 transform turn\n", "2:28", "expected identity, matrix"},
    {"vertexconstant 0 transform world turn\n", "2:34", "expected a transform: world"},
    {"vertexconstant 0 transform world view projection texture 0 world\n", "2:60", "at most 4 transforms"},
    {"vertexconstant 0 transform world transposed inverse\n", "2:45",
     "expected inverse, transposed, count N"},
    {"vertexconstant 0 transform world count 5\n", "2:40", "expected an integer (count) from 1 to 4"},
    {"vertexconstant 8190 transform world\n", "2:36", "found constants up to 8193, expected at most 8191"},
    {"vertexconstant 0 transform scale 0 1 1 inverse\n", "2:28",
     "found constants that are not finite, expected a matrix with an inverse"},
    {"transform world scale 0 1 1\nvertexconstant 0 transform world inverse\n", "3:1",
     "found constants that are not finite, expected transforms with an inverse"},
    {"target 8 8\nshader s {\nvs_2_0\ndcl_position v0\nmov r0, v0\nrep i1\nadd r0, r0, v0\nendrep\nmov "
     "oPos, r0\n}\nvertexshader s\nvertexinteger 1 -1 0 0\ndraw triangles 0 1\n",
     "14:1", "i1"},

    /* Declarations and streams */
    {"declare 16 position:float3\n", "2:9", "expected an integer (stream) from 0 to 15"},
    {"declare position:float3 1 position:float2\n", "2:27", "expected each attribute once"},
    {"declare position:float3@2\n", "2:9", "expected a multiple of 4 up to 65532 behind @"},
    {"declare position:float3@\n", "2:9", "expected a multiple of 4 up to 65532 behind @"},
    {"declare position:float3@65532 tangent:float3\n", "2:31",
     "an element does not fit behind the one before"},
    {"bind element tangent float3 b 0 4\n", "2:14",
     "found 'tangent', expected an attribute, or declare for what only shaders read"},
    {"target 8 8\nbuffer b float { 1 2 }\ndeclare position:float2 1 binormal1:float3\nbind stream 0 b 0 "
     "0\nbind "
     "stream 1 b 0 0\ndraw triangles 0 1\n",
     "7:1", "found binormal1 at bytes up to 12, expected at most 8, those of b"},
    {"target 8 8\nvertices v position:float2 tangent:float1 {\n0 0 0\n1 1 0\n}\nbind vertices v\ndraw "
     "triangles 0 "
     "1\n",
     "8:1", "found vertex 2 drawn, expected at most 1, the last position in v"},
    {"declare position:float3@65536\n", "2:9", "expected a multiple of 4 up to 65532 behind @"},
    {"declare position:float3@1x\n", "2:9", "expected an offset up to 65532 behind @"},
    {"declare position\n", "2:9", "expected ATTRIBUTE:FORMAT"},
    {"fvf\n", "2:4", "expected parts of a vertex format"},
    {"fvf xyz xyzrhw\n", "2:9", "expected one part of its kind"},
    {"fvf normal\n", "2:1", "expected one kind of position"},
    {"fvf xyz tex1 size3_1\n", "2:1", "sizes of more sets of texture coordinates than 1"},
    {"fvf xyz normals\n", "2:9", "found 'normals', expected parts of a vertex format"},
    {"bind stream 16 none\n", "2:13", "expected an integer (stream) from 0 to 15"},
    {"bind stream 0 b 0 4\n", "2:15", "expected the name of a buffer, vertices or a mesh, or none"},
    {"buffer b float { 1 2 }\nbind stream 0 b 8 4\n", "3:1", "inside the buffer of 8 bytes"},
    {"buffer b float { 1 2 }\nbind stream 0 b 0 2\n", "3:19", "found '2', expected a multiple of 4"},
    {"frequency 0 often 1\n", "2:13", "expected a frequency: vertex, indexed, instance"},
    {"frequency 0 instance 1\n", "2:1", "expected it of streams 1 to 15"},
    {"frequency 1 instance 0\n", "2:1", "frequency with count 0, expected 1 to"},
    {"frequency 1 vertex 2\n", "2:1", "expected 1 to 1"},
    {"target 8 8\ndeclare position:float2\ndraw triangles 0 1\n", "4:1",
     "found position in stream 0 with nothing bound, expected bind stream before it"},
    {"target 8 8\nbuffer b float { 1 2 3 4 5 6 }\ndeclare position:float2\nbind stream 0 b 0 8\ndraw "
     "triangles 1 1\n",
     "6:1", "found vertex 3 drawn, expected at most 2, the last position in b"},
    {"target 8 8\nbuffer b float { 1 2 }\ndeclare position:float2@4\nbind stream 0 b 0 0\ndraw triangles 0 "
     "1\n",
     "6:1", "found position at bytes up to 12, expected at most 8, those of b"},
    {"target 8 8\nbuffer b float { 1 2 }\nindices i 16 { 0 0 0 }\nbind indices i\ndeclare position:float2 1 "
     "diffuse:color\nbind stream 0 b 0 8\nbind stream 1 b 0 4\nfrequency 0 indexed 5\nfrequency 1 instance "
     "2\n"
     "draw-indexed triangles 0 0 1\n",
     "11:1", "found vertex 2 drawn, expected at most 1, the last diffuse in b"},
    {"target 8 8\nbuffer b float { 1 2 }\nfvf xyzrhw\nbind stream 0 b 0 0\nfrequency 0 indexed 2\ndraw "
     "triangles 0 1\n",
     "7:1", "found stream 0 stepping by instance, expected frequency 0 vertex 1 or an indexed draw"},
    {"target 8 8\ndraw triangles 0 1\n", "3:1", "found no position bound, expected bind vertices before it"},
    {"target 8 8\ndraw quads 0 1\n", "3:6", "expected a primitive, or mesh NAME: triangles, strip, fan"},
    {"target 8 8\nvertices v position:float1 {\n1\n2\n3\n}\nbind vertices v\ndraw triangles 1 1\n", "9:1",
     "found vertex 3 drawn, expected at most 2, the last position in v"},
    {"target 8 8\nvertices v position:float1 {\n1\n2\n3\n}\nbind vertices v\ndraw-indexed fan 0 0 1\n", "9:1",
     "found no indices bound"},
    {"target 8 8\nvertices v position:float1 {\n1\n}\nindices i 16 { 0 0 0 }\nbind vertices v\nbind indices "
     "i\n"
     "draw-indexed triangles 0 1 1\n",
     "9:1", "found index 3 drawn, expected at most 2, the last in i"},
    {"target 8 8\nvertices v position:float1 {\n1\n}\nindices i 16 { 0 0 0 }\nbind vertices v\nbind indices "
     "i\n"
     "draw-indexed triangles -1 0 1\n",
     "9:1", "found vertex -1 drawn"},
    {"target 8 8\nvertices v position:float1 {\n1\n}\nindices i 32 { 0 0 9 0 0 0 }\nbind vertices v\nbind "
     "indices i\n"
     "draw-indexed triangles 0 3 1\ndraw-indexed triangles 0 0 1\n",
     "10:1", "found vertex 9 drawn, expected at most 0"},
    {"draw mesh m\n", "2:11", "expected the name of a mesh defined before"},

    /* Sequences */
    {"sequence s\nframe\n", "4:1", "found the end of the file, expected the end of sequence s"},
    {"end\n", "2:1", "found 'end', expected a call"},
    {"sequence s\nindices i 16 { 1 }\nend\n", "3:1", "found 'indices', expected a call of a sequence"},
    {"sequence s\nsequence t\nend\nend\n", "3:1", "found 'sequence', expected a call of a sequence"},
    {"sequence s\nplay s\nend\n", "3:6", "found 's' playing itself"},
    {"play s\n", "2:6", "expected the name of a sequence defined before"},
    {"sequence s\ndraw triangles 0 1\nend\ntarget 8 8\nplay s\n", "3:1", "found no position bound"},
};

static void expect_bad(const char *text, size_t bytes, const struct bad *bad)
{
    struct stream *stream = (struct stream *)&error;
    char place[64];
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(-1, stream_parse("dir/a.tri", text, bytes, &stream, &error), text);
    TEST_ASSERT_NULL(stream);
    int length = snprintf(place, sizeof place, "dir/a.tri:%s: ", bad->place);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(place, error.text, (size_t)length, error.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, bad->part), error.text);
    TEST_ASSERT_NULL_MESSAGE(strchr(error.text, '\n'), error.text);
}

static void a_text_that_is_no_stream_is_refused_at_its_place(void)
{
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        expect_bad(whole[i].text, strlen(whole[i].text), &whole[i]);
}

static void every_bad_line_is_refused_at_its_place(void)
{
    static char text[1024];
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        int length = snprintf(text, sizeof text, "triptych 1\n%s", lines[i].text);
        expect_bad(text, (size_t)length, &lines[i]);
    }
}

static void a_zero_byte_is_no_text(void)
{
    static const struct bad bad = {"", "2:6", "found control character 0x00"};
    expect_bad("triptych 1\nframe\0\n", 18, &bad);
}

static void long_words_are_shown_cut_and_long_paths_from_their_end(void)
{
    static char path[3000], text[2000];
    struct stream *stream;
    memset(path, 'p', sizeof path - 1);
    strcpy(text, "triptych 1\n");
    memset(text + strlen(text), 'w', 1500);
    TEST_ASSERT_EQUAL_INT(-1, stream_parse(path, text, strlen(text), &stream, &error));
    TEST_ASSERT_EQUAL_STRING_LEN("...ppp", error.text, 6);
    TEST_ASSERT_NOT_NULL(strstr(error.text, "p:2:1: found 'wwww"));
    TEST_ASSERT_NOT_NULL(strstr(error.text, "w...', expected a call"));
}

/* --- Limits -----------------------------------------------------------------------------------------------
 */

/* Repeats `part` in a text that the caller frees. */
static char *repeat(const char *before, const char *part, size_t count, const char *after)
{
    size_t length = strlen(part);
    char *text = malloc(strlen(before) + length * count + strlen(after) + 1), *at = stpcpy(text, before);
    for (size_t i = 0; i < count; i++)
        at = stpcpy(at, part);
    strcpy(at, after);
    return text;
}

static void expect_limit(char *text, const struct bad *bad)
{
    expect_bad(text, strlen(text), bad);
    free(text);
}

static void limits_hold(void)
{
    expect_limit(repeat("triptych 1\n", " ", LIMIT_LINE_BYTES + 1, "frame\n"),
                 &(struct bad){"", "2:65537", "found a longer line, expected at most 65536 bytes"});
    expect_limit(repeat("triptych 1\ntexture ", "n", LIMIT_NAME_BYTES + 1, " 1 1 { ffffffff }\n"),
                 &(struct bad){"", "2:9", "expected a name"});
    expect_limit(repeat("triptych 1\ntexture n file \"", "p", LIMIT_PATH_BYTES + 1, "\"\n"),
                 &(struct bad){"", "2:16", "found a path of 1025 bytes, expected 1 to 1024"});
    expect_limit(repeat("triptych 1\ntransform world", " identity", LIMIT_OPERATIONS + 1, "\n"),
                 &(struct bad){"", "2:305", "expected at most 32 operations"});
    expect_limit(repeat("triptych 1\n", "texture a 1 1 { 00000000 }\n", 2, ""),
                 &(struct bad){"", "3:9", "not in use"});
    expect_limit(repeat("triptych 1\ntarget 1 1\n", "frame\n", LIMIT_FRAMES + 1, ""),
                 &(struct bad){"", "65539:1", "found one more frame, expected at most 65536"});
}

static void a_line_of_the_limit_is_read(void)
{
    struct stream *stream;
    char *text = repeat("triptych 1\nstate lighting false\n#", " ", LIMIT_LINE_BYTES - 1, "\n");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("a", text, strlen(text), &stream, &error), error.text);
    stream_free(stream);
    free(text);
}

/* Eight sequences, each playing the one before `plays` times. */
static char *nest(int sequences, int plays)
{
    char *text = malloc(1 << 20), *at = stpcpy(text, "triptych 1\nsequence s0\nstate lighting false\nend\n");
    for (int s = 1; s < sequences; s++) {
        at += sprintf(at, "sequence s%d\n", s);
        for (int i = 0; i < plays; i++)
            at += sprintf(at, "play s%d\n", s - 1);
        at = stpcpy(at, "end\n");
    }
    sprintf(at, "play s%d\n", sequences - 1);
    return text;
}

static void sequences_cannot_explode(void)
{
    struct stream *stream;
    char *deepest = nest(LIMIT_DEPTH, 2);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse("a", deepest, strlen(deepest), &stream, &error),
                                  error.text);
    TEST_ASSERT_EQUAL_UINT(128, stream->executed_count);
    stream_free(stream);
    free(deepest);
    expect_limit(nest(LIMIT_DEPTH + 1, 1),
                 &(struct bad){"", "27:6", "found sequences 9 deep, expected at most 8"});
    expect_limit(nest(LIMIT_DEPTH, 100),
                 &(struct bad){"", "314:1", "found more calls with sequences played"});
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_text_that_is_no_stream_is_refused_at_its_place);
    RUN_TEST(every_bad_line_is_refused_at_its_place);
    RUN_TEST(a_zero_byte_is_no_text);
    RUN_TEST(long_words_are_shown_cut_and_long_paths_from_their_end);
    RUN_TEST(limits_hold);
    RUN_TEST(a_line_of_the_limit_is_read);
    RUN_TEST(sequences_cannot_explode);
    return UNITY_END();
}
