#!/usr/bin/env python3
"""Draws the picture of cube.c with Python's ctypes, and writes it as a PNG file.

    LD_LIBRARY_PATH=PREFIX/lib python3 cube.py specialize cube.png

A binding needs the functions of the header and a few structures. It does not need the enumerations of states
and their values: the library's tables contain their names. docs/library.md explains the calls.
"""
import ctypes
import struct
import sys
import zlib
from ctypes import POINTER, Structure, byref
from ctypes import c_char_p, c_double, c_float, c_int, c_size_t, c_uint, c_uint32, c_void_p

SIDE, TEXTURE_SIDE, FACES = 256, 64, 6

VERTEX_SHADER = b"""vs_2_0
dcl_position v0
dcl_normal v1
dcl_texcoord v2
dp4 oPos.x, v0, c0
dp4 oPos.y, v0, c1
dp4 oPos.z, v0, c2
dp4 oPos.w, v0, c3
dp3 oT1.x, v1, c4
dp3 oT1.y, v1, c5
dp3 oT1.z, v1, c6
mov oT0.xy, v2
"""

PIXEL_SHADER = b"""ps_2_0
def c1, 0.25, 0.75, 0, 0
dcl t0.xy
dcl t1.xyz
dcl_2d s0
nrm r1.xyz, t1
dp3_sat r1.x, r1, c0
mad r1.x, r1.x, c1.y, c1.x
texld r0, t0, s0
mul r0.xyz, r0, r1.x
mov oC0, r0
"""

# --- The library --------------------------------------------------------------------------------------------


class Options(Structure):
    _fields_ = [("engine", c_char_p), ("threads", c_uint), ("cache_bytes", c_size_t), ("measure", c_int),
                ("debug", c_char_p), ("log", c_void_p), ("log_user", c_void_p)]


class Kind(Structure):
    _fields_ = [("name", c_char_p), ("notation", c_int), ("first", c_double), ("last", c_double),
                ("prefix", c_char_p)]


class StateRow(Structure):
    _fields_ = [("number", c_uint), ("name", c_char_p), ("kind", POINTER(Kind)), ("units", c_char_p),
                ("support", c_int), ("test", c_char_p), ("meaning", c_char_p)]


class Element(Structure):
    _fields_ = [("stream", c_uint), ("offset", c_size_t), ("format", c_int), ("usage", c_int),
                ("usage_index", c_uint)]


class TextureDescription(Structure):
    _fields_ = [("type", c_int), ("format", c_int), ("width", c_uint), ("height", c_uint), ("depth", c_uint),
                ("levels", c_uint)]


library = ctypes.CDLL("libtriptych.so")
library.triptych_version.restype = c_char_p
library.triptych_error.restype = c_char_p
library.triptych_state_at.restype = POINTER(StateRow)
library.triptych_value_number.argtypes = [POINTER(Kind), c_char_p, POINTER(c_uint32)]
library.triptych_texture_update.argtypes = [c_void_p, c_void_p, c_uint, c_uint, c_void_p, c_void_p, c_size_t,
                                            c_size_t]
library.triptych_clear.argtypes = [c_void_p, POINTER(c_float), c_float]

SAMPLER_STATES = 1  # enum triptych_state_table
TRIANGLE_LIST, VERTEX, PIXEL = 0, 0, 1
FLOAT2, FLOAT3 = 2, 3  # enum triptych_format
POSITION, NORMAL, TEXCOORD = 0, 3, 5  # enum triptych_usage
A8B8G8R8 = 32  # enum triptych_surface_format, Direct3D 9's number

device = c_void_p()


def call(name, *arguments):
    """Calls a function of the device. A failure ends the program with the reason."""
    if getattr(library, "triptych_" + name)(device, *arguments):
        sys.exit("cube.py: %s: %s" % (name, library.triptych_error(device).decode()))


def make(name, *arguments):
    """Calls a function that creates an object, and returns it."""
    made = c_void_p()
    call(name, *arguments, byref(made))
    return made


def set_sampler(sampler, state, word):
    """Sets a sampler state by its name and the word of its value."""
    row, value = 0, c_uint32()
    while library.triptych_state_at(SAMPLER_STATES, row).contents.name.decode() != state:
        row += 1
    kind = library.triptych_state_at(SAMPLER_STATES, row).contents.kind
    if library.triptych_value_number(kind, word.encode(), byref(value)):
        sys.exit("cube.py: %s has no value %s" % (state, word))
    call("set_sampler_state", sampler, row, value)


def floats(values):
    values = list(values)
    return (c_float * len(values))(*values)


# --- The cube -----------------------------------------------------------------------------------------------


def corner(face, i):
    """Position, normal and texture coordinates of corner i of a face."""
    axis, sign = face // 2, -1 if face % 2 else 1
    u, v = i % 2, i // 2
    position, normal = [0] * 3, [0] * 3
    position[axis] = normal[axis] = sign
    position[(axis + 1) % 3] = sign * (2 * u - 1)
    position[(axis + 2) % 3] = 2 * v - 1
    return position + normal + [u, v]


def set_geometry():
    data = floats(number for face in range(FACES) for i in range(4) for number in corner(face, i))
    index = struct.pack("<36H", *(4 * face + i for face in range(FACES) for i in (0, 1, 2, 2, 1, 3)))
    elements = (Element * 3)(Element(0, 0, FLOAT3, POSITION, 0), Element(0, 12, FLOAT3, NORMAL, 0),
                             Element(0, 24, FLOAT2, TEXCOORD, 0))
    vertices = make("buffer_create", data, c_size_t(ctypes.sizeof(data)))
    indices = make("buffer_create", index, c_size_t(len(index)))
    call("set_declaration", elements, 3)
    call("set_stream", 0, vertices, c_size_t(0), c_size_t(32))
    call("set_indices", indices, 16)


def set_texture():
    side = range(TEXTURE_SIDE)
    words = (0xff3060e0 if (x // 8 + y // 8) % 2 else 0xfff0f0f0 for y in side for x in side)
    texels = struct.pack("<%dI" % TEXTURE_SIDE ** 2, *words)
    texture = make("texture_define", byref(TextureDescription(0, A8B8G8R8, TEXTURE_SIDE, TEXTURE_SIDE, 1, 0)))
    call("texture_update", texture, 0, 0, None, texels, 4 * TEXTURE_SIDE, 0)
    call("texture_generate_mips", texture)
    call("set_texture", 0, texture)
    for state in ("minfilter", "magfilter", "mipfilter"):
        set_sampler(0, state, "linear")


def set_shaders():
    for stage, text in (("vertex", VERTEX_SHADER), ("pixel", PIXEL_SHADER)):
        call("set_%s_shader" % stage, make("shader_assemble", stage.encode(), text, c_size_t(len(text))))


# --- The camera ---------------------------------------------------------------------------------------------


def multiply(a, b):
    product = [[0.0] * 4 for _ in range(4)]
    for row in range(4):
        for column in range(4):
            for i in range(4):
                product[row][column] += a[row][i] * b[i][column]
    return product


def set_columns(first, count, matrix):
    columns = floats(matrix[row][i] for i in range(count) for row in range(4))
    call("set_shader_floats", VERTEX, first, columns, count)


def set_camera():
    about_y = [[0.8, 0, -0.6, 0], [0, 1, 0, 0], [0.6, 0, 0.8, 0], [0, 0, 0, 1]]
    about_x = [[1, 0, 0, 0], [0, 0.8, -0.6, 0], [0, 0.6, 0.8, 0], [0, 0, 0, 1]]
    projection = [[2.6, 0, 0, 0], [0, 2.6, 0, 0], [0, 0, 1.125, 1], [0, 0, 5 * 1.125 - 1.125, 5]]
    world = multiply(about_y, about_x)
    set_columns(0, 4, multiply(world, projection))
    set_columns(4, 3, world)
    call("set_shader_floats", PIXEL, 0, floats([0.36, 0.48, -0.8, 0]), 1)


# --- The program --------------------------------------------------------------------------------------------


def write_png(path, pixels):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = b"".join(b"\0" + pixels[4 * SIDE * y:4 * SIDE * (y + 1)] for y in range(SIDE))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 8, 6, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def main():
    engine, path = (sys.argv + ["specialize", "cube.png"][len(sys.argv) - 1:])[1:3]
    reason = ctypes.create_string_buffer(512)
    options = Options(engine=engine.encode())
    if library.triptych_device_create(byref(options), byref(device), reason, c_size_t(512)):
        sys.exit("cube.py: " + reason.value.decode())
    call("set_target", SIDE, SIDE)
    set_geometry()
    set_texture()
    set_shaders()
    set_camera()
    call("clear", floats([0.1, 0.1, 0.15, 1]), 1)
    call("draw_indexed", TRIANGLE_LIST, 0, 0, 2 * FACES)
    pixels = ctypes.create_string_buffer(4 * SIDE * SIDE)
    call("read_color", pixels, c_size_t(4 * SIDE * SIDE))
    call("end_frame")
    library.triptych_device_destroy(device)
    write_png(path, pixels.raw)


main()
