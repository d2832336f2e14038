#!/usr/bin/env python3
"""Writes the tables of OpenGL ES's commands and constants from the Khronos registry.

    registry.py [--registry gl.xml] [FOLDER]

FOLDER, by default that of this file, gets core.def, extension.def and constant.def. Debian's package khronos-api
has the registry. A row keeps its first word, `own` or `none`, which is the only part that is edited by hand: new
rows are `none`. tests/registry.sh runs this program and compares.
"""
import argparse
import os
import re
import sys
import xml.etree.ElementTree

WIDTH = 110
APIS = {"gles1": "GL_ES1", "gles2": "GL_ES2"}
CORE = {"gles1": "GL_VERSION_ES_CM_1_0", "gles2": "GL_ES_VERSION_2_0"}

# Extensions with commands or constants, each for the interfaces of the registry that have it.
EXTENSIONS = """
GL_KHR_debug GL_EXT_debug_marker GL_EXT_debug_label GL_KHR_robustness GL_EXT_robustness
GL_OES_framebuffer_object GL_OES_vertex_array_object GL_OES_mapbuffer GL_EXT_map_buffer_range
GL_OES_EGL_image GL_OES_EGL_image_external GL_EXT_discard_framebuffer GL_EXT_multisampled_render_to_texture
GL_ANGLE_framebuffer_blit GL_ANGLE_framebuffer_multisample GL_EXT_texture_storage
GL_ANGLE_instanced_arrays GL_EXT_instanced_arrays GL_EXT_draw_buffers GL_EXT_occlusion_query_boolean
GL_EXT_disjoint_timer_query GL_NV_fence GL_OES_get_program_binary GL_EXT_multi_draw_arrays
GL_OES_blend_equation_separate GL_OES_blend_func_separate GL_OES_blend_subtract GL_OES_draw_texture
GL_OES_fixed_point GL_OES_matrix_palette GL_OES_point_size_array GL_OES_query_matrix GL_OES_single_precision
GL_OES_texture_cube_map GL_EXT_blend_minmax GL_EXT_texture_filter_anisotropic GL_EXT_texture_format_BGRA8888
GL_EXT_read_format_bgra GL_EXT_texture_compression_dxt1 GL_EXT_texture_compression_s3tc
GL_EXT_texture_lod_bias GL_EXT_texture_rg GL_EXT_sRGB GL_EXT_shader_texture_lod GL_EXT_shadow_samplers
GL_EXT_texture_border_clamp GL_NV_read_depth GL_OES_blend_equation_separate GL_OES_compressed_ETC1_RGB8_texture
GL_OES_compressed_paletted_texture GL_OES_depth24 GL_OES_depth32 GL_OES_depth_texture
GL_OES_element_index_uint GL_OES_matrix_get GL_OES_packed_depth_stencil GL_OES_point_sprite GL_OES_rgb8_rgba8
GL_OES_required_internalformat GL_OES_standard_derivatives GL_OES_stencil1 GL_OES_stencil4 GL_OES_stencil8
GL_OES_stencil_wrap GL_OES_surfaceless_context GL_OES_texture_3D GL_OES_texture_float
GL_OES_texture_float_linear GL_OES_texture_half_float GL_OES_texture_half_float_linear
GL_OES_texture_mirrored_repeat GL_OES_texture_npot GL_OES_vertex_half_float GL_OES_vertex_type_10_10_10_2
GL_EXT_texture_type_2_10_10_10_REV GL_EXT_unpack_subimage GL_IMG_texture_compression_pvrtc GL_OES_texture_env_crossbar
GL_NV_draw_buffers GL_NV_fbo_color_attachments GL_EXT_clip_control GL_KHR_blend_equation_advanced
GL_KHR_blend_equation_advanced_coherent GL_EXT_blend_func_extended
""".split()


class Registry:
    def __init__(self, path):
        self.root = xml.etree.ElementTree.parse(path).getroot()
        self.commands = {c.findtext("proto/name"): c for c in self.root.findall("commands/command")}
        self.values = {}
        for constant in self.root.findall("enums/enum"):
            if constant.get("api") in (None, "gles1", "gles2"):
                self.values.setdefault(constant.get("name"), constant.get("value"))

    def features(self, api):
        names = {}
        feature = self.root.find(f"feature[@name='{CORE[api]}']")
        for require in feature.findall("require"):
            for child in require:
                names.setdefault(child.get("name"), child.tag)
        return names

    def extension(self, name):
        found = self.root.find(f"extensions/extension[@name='{name}']")
        if found is None:
            sys.exit(f"registry.py: the registry has no {name}")
        apis = [api for api in APIS if api in found.get("supported").split("|")]
        names = {}
        for require in found.findall("require"):
            if require.get("api") in (None, "gles1", "gles2"):
                for child in require:
                    names.setdefault(child.get("name"), child.tag)
        return apis, names


def declared(element):
    """A parameter as C text, without its name, and its name."""
    name = element.findtext("name")
    text = re.sub(r"\s+", " ", "".join(element.itertext())).strip()
    return text, name


def wrapped(head, items, tail):
    lines, line = [], head
    for i, item in enumerate(items):
        piece = item + (", " if i + 1 < len(items) else tail)
        if len((line + piece).rstrip()) > WIDTH:
            lines.append(line.rstrip())
            line = "           "
        line += piece
    lines.append((line if items else line + tail).rstrip())
    return "\n".join(lines)


def row(registry, word, apis, name, listed):
    command = registry.commands[name]
    result = re.sub(r"\s+", " ", "".join(command.find("proto").itertext())).replace(name, "").strip()
    parameters = [declared(p) for p in command.findall("param")]
    alias = command.find("alias")
    maker = alias.get("name") if alias is not None and alias.get("name") in listed else name
    head = f"GL_COMMAND({word}, {' | '.join(APIS[a] for a in apis)}, {result}, {name[2:]}, {maker[2:]}, ("
    text = wrapped(head, [p[0] for p in parameters], "), (")
    start, last = text.rsplit("\n", 1) if "\n" in text else ("", text)
    text = wrapped(last, [p[1] for p in parameters], "))")
    return (start + "\n" if start else "") + text


def words_of(path):
    """The first words of existing rows, by name."""
    if not os.path.exists(path):
        return {}
    with open(path) as file:
        text = re.sub(r"\s+", " ", file.read())
    return {"gl" + n: w for w, n in re.findall(r"GL_COMMAND\((\w+), [^,]*, [^,]*, (\w+),", text)}


def collect(registry):
    """Lists (title, [(name, apis)]) of core.def and of extension.def, and the names of all constants."""
    core, constants = {}, []
    for api in APIS:
        for name, tag in registry.features(api).items():
            if tag == "command":
                core.setdefault(name, []).append(api)
            elif tag == "enum":
                constants.append(name)
    titles = {("gles1", "gles2"): "OpenGL ES 1.1 and 2.0.", ("gles1",): "OpenGL ES 1.1.", ("gles2",): "OpenGL ES 2.0."}
    cores = [(title, [(n, a) for n, a in sorted(core.items()) if tuple(a) == key]) for key, title in titles.items()]
    extensions, seen = [], set(core)
    for extension in dict.fromkeys(EXTENSIONS):
        apis, names = registry.extension(extension)
        if not apis:
            sys.exit(f"registry.py: {extension} is not an extension of OpenGL ES")
        commands = sorted(n for n, tag in names.items() if tag == "command" and n not in seen)
        constants += [n for n, tag in names.items() if tag == "enum"]
        seen.update(commands)
        if commands:
            extensions.append((f"{extension}.", [(n, apis) for n in commands]))
    return cores, extensions, constants


def write(path, head, body):
    with open(path, "w") as file:
        file.write("/* " + head + " */\n" + body)


def write_commands(registry, folder, kept, name, head, groups, listed):
    text = ""
    for title, commands in groups:
        text += f"\n/* {title} */\n"
        for command, apis in commands:
            text += row(registry, kept.get(command, "none"), apis, command, listed) + "\n"
    write(os.path.join(folder, name), head, text)


def write_constants(registry, folder, names):
    """One name for each value: that of the core interface, or of the first extension. Values below 16 have many
    meanings, and the bits of masks are not single values."""
    chosen = {}
    for name in names:
        value = int(registry.values[name], 16 if registry.values[name].startswith("0x") else 10)
        if value >= 16 and not name.endswith("_BIT") and "_BIT_" not in name and value < 0x10000:
            chosen.setdefault(value, name)
    text = "".join(f"GL_CONSTANT(0x{value:04X}, {name})\n" for value, name in sorted(chosen.items()))
    write(os.path.join(folder, "constant.def"),
          "GL_CONSTANT(value, name): constants of OpenGL ES for messages. Written by registry.py.", "\n" + text)


ROW = ("GL_COMMAND(state, interfaces, result, name, maker, (parameters), (arguments)): {}. Written by\n"
       " * registry.py from the Khronos registry, except for `state`: `own` if the function gl_MAKER exists, `none` if\n"
       " * eglGetProcAddress returns null for the command. Commands with one maker have one meaning.")


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--registry", default="/usr/share/khronos-api/gl.xml")
    parser.add_argument("folder", nargs="?", default=here)
    options = parser.parse_args()
    registry = Registry(options.registry)
    cores, extensions, constants = collect(registry)
    listed = {name for _, commands in cores + extensions for name, _ in commands}
    kept = {**words_of(os.path.join(here, "core.def")), **words_of(os.path.join(here, "extension.def"))}
    write_commands(registry, options.folder, kept, "core.def", ROW.format("the core commands"), cores, listed)
    write_commands(registry, options.folder, kept, "extension.def", ROW.format("of extensions"), extensions,
                   listed)
    write_constants(registry, options.folder, constants)


if __name__ == "__main__":
    main()
