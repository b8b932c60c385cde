"""Writes the damaged scenes of this folder, each a small change to one good scene.

usage: make.py [FOLDER]    (default: the folder of this script)

Names of files say what is wrong. Files named warn-*.gltf are odd but load, with a warning.
"""
import base64
import copy
import json
import math
import pathlib
import struct
import sys

POSITIONS = [0, 0, 0, 1, 0, 0, 0, 1, 0]
NORMALS = [0, 0, 1] * 3
UVS = [0, 0, 1, 0, 0, 1]
INDICES = [0, 1, 2]
TIMES = [0, 1]
MOVES = [0, 0, 0, 1, 0, 0]


def data_uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(data).decode()


def png(width, height):
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + b"\x80\x40\x20" * width for _ in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Scene:
    """A good scene: a textured triangle, a camera, a light, an animation."""

    def __init__(self):
        self.data = b""
        self.json = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [
                {"name": "triangle", "mesh": 0},
                {"name": "camera", "camera": 0, "translation": [0, 0, 3]},
                {"name": "light", "extensions": {"KHR_lights_punctual": {"light": 0}}},
            ],
            "meshes": [{"name": "triangle", "primitives": [
                {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
            "materials": [{"name": "paint", "pbrMetallicRoughness": {
                "metallicFactor": 0, "baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0, "sampler": 0}],
            "samplers": [{"magFilter": 9729, "wrapS": 10497}],
            "images": [{"uri": "data:image/png;base64," + base64.b64encode(png(2, 2)).decode()}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
            "animations": [{"name": "move", "channels": [
                {"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                "samplers": [{"input": 4, "output": 5, "interpolation": "LINEAR"}]}],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        }
        self.add("f", "VEC3", 5126, POSITIONS, 3)
        self.add("f", "VEC3", 5126, NORMALS, 3)
        self.add("f", "VEC2", 5126, UVS, 2)
        self.add("H", "SCALAR", 5123, INDICES, 1)
        self.add("f", "SCALAR", 5126, TIMES, 1)
        self.add("f", "VEC3", 5126, MOVES, 3)

    def add(self, code, kind, component, values, components):
        data = struct.pack("<%d%s" % (len(values), code), *values)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.json["accessors"].append({"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component,
                                       "type": kind, "count": len(values) // components})
        self.data += data + b"\0" * (-len(data) % 4)

    def text(self):
        document = copy.deepcopy(self.json)
        if not document["buffers"]:
            document["buffers"] = [{"byteLength": len(self.data), "uri": data_uri(self.data)}]
        return json.dumps(document)

    def glb(self):
        document = dict(self.json, buffers=[{"byteLength": len(self.data)}])
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self.data)
        return (b"glTF" + struct.pack("<II", 2, size) + struct.pack("<II", len(text), 0x4E4F534A) + text
                + struct.pack("<II", len(self.data), 0x004E4942) + self.data)

    def replace_floats(self, accessor, values):
        offset = self.json["bufferViews"][accessor]["byteOffset"]
        packed = struct.pack("<%df" % len(values), *values)
        self.data = self.data[:offset] + packed + self.data[offset + len(packed):]


CHANGES = {}


def change(name):
    def register(function):
        CHANGES[name] = function
        return function
    return register


def setting(name, path, value):
    """Registers a change that sets the member at the path, or removes it where the value is None."""
    def apply(scene):
        *parents, last = [int(key) if key.isdigit() else key for key in path.split("/")]
        target = scene.json
        for key in parents:
            target = target[key]
        if value is None:
            del target[last]
        elif isinstance(target, list) and last == len(target):
            target.append(value)
        else:
            target[last] = value
    CHANGES[name] = apply


setting("asset-missing", "asset", None)
setting("asset-version-1", "asset/version", "1.0")
setting("required-extension-unknown", "extensionsRequired", ["EXT_unheard_of"])
setting("scene-out-of-range", "scene", 7)
setting("scene-node-negative", "scenes/0/nodes/0", -1)
setting("scenes-not-an-array", "scenes", {"nodes": [0]})
setting("nodes-missing", "nodes", [])
setting("extras-shadows-unknown", "scenes/0/extras", {"probebench": {"schema": 1, "shadows": "soft"}})
setting("extras-environment-twice", "scenes/0/extras",
        {"probebench": {"schema": 1, "environment": {"constant": 1, "faces": [0, 0, 0, 0, 0, 0]}}})
setting("node-cycle", "nodes/0/children", [0])
setting("node-child-out-of-range", "nodes/0/children", [99])
setting("node-child-not-an-integer", "nodes/0/children", ["1"])
setting("node-mesh-out-of-range", "nodes/0/mesh", 3)
setting("node-matrix-of-15", "nodes/0/matrix", [1] * 15)
setting("node-matrix-projective", "nodes/0/matrix", [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
setting("node-translation-too-large", "nodes/0/translation", [1e200, 0, 0])
setting("node-scale-too-large", "nodes/0/scale", [1e30, 1e30, 1e30])
setting("node-matrix-too-large", "nodes/2/matrix", [1e30, 0, 0, 0, 0, 1e30, 0, 0, 0, 0, 1e30, 0, 0, 0, 0, 1])
setting("node-rotation-zero", "nodes/0/rotation", [0, 0, 0, 0])
setting("node-probe-not-a-position", "nodes/0/extras", {"probe": {"position": [1, 2]}})
setting("node-light-out-of-range", "nodes/2/extensions/KHR_lights_punctual/light", 5)
setting("mesh-attributes-missing", "meshes/0/primitives/0/attributes", None)
setting("mesh-attribute-out-of-range", "meshes/0/primitives/0/attributes/NORMAL", 77)
setting("mesh-attribute-of-other-length", "meshes/0/primitives/0/attributes/NORMAL", 5)
setting("mesh-position-of-two-components", "meshes/0/primitives/0/attributes/POSITION", 2)
setting("mesh-indices-floats", "meshes/0/primitives/0/indices", 4)
setting("mesh-material-out-of-range", "meshes/0/primitives/0/material", 1)
setting("mesh-indices-not-triples", "accessors/3/count", 2)
setting("primitives-not-an-array", "meshes/0/primitives", 5)
setting("accessor-count-negative", "accessors/0/count", -3)
setting("accessor-count-zero", "accessors/0/count", 0)
setting("accessor-count-huge", "accessors/0/count", 2**40)
setting("accessor-count-beyond-integers", "accessors/0/count", 2**63)
setting("accessor-count-beyond-buffer", "accessors/0/count", 4)
setting("accessor-count-a-string", "accessors/0/count", "3")
setting("accessor-type-unknown", "accessors/0/type", "VEC9")
setting("accessor-matrix", "accessors/0/type", "MAT3")
setting("accessor-component-type-unknown", "accessors/0/componentType", 5124)
setting("accessor-offset-beyond-view", "accessors/0/byteOffset", 1000000)
setting("accessor-view-out-of-range", "accessors/0/bufferView", 9)
setting("view-buffer-out-of-range", "bufferViews/0/buffer", 2)
setting("view-offset-beyond-buffer", "bufferViews/0/byteOffset", 4096)
setting("view-length-beyond-buffer", "bufferViews/0/byteLength", 2**33)
setting("view-stride-below-element", "bufferViews/0/byteStride", 4)
setting("buffer-file-missing", "buffers", [{"byteLength": 200, "uri": "nowhere.bin"}])
setting("buffer-is-a-folder", "buffers", [{"byteLength": 200, "uri": ".."}])
setting("buffer-length-huge", "buffers", [{"byteLength": 2**39, "uri": data_uri(b"0123")}])
setting("buffer-without-data", "buffers", [{"byteLength": 200}])
setting("buffer-base64-damaged", "buffers", [{"byteLength": 200, "uri": "data:application/octet-stream;base64,!!!!"}])
setting("image-file-missing", "images/0/uri", "nowhere.png")
setting("image-truncated", "images/0/uri", "data:image/png;base64," + base64.b64encode(png(2, 2)[:40]).decode())
setting("image-no-image", "images/0/uri", data_uri(b"these are words"))
setting("image-absurdly-large", "images/0/uri", data_uri(b"PF\n1000000 1000000\n-1.0\n"))
setting("image-view-out-of-range", "images/0", {"bufferView": 50, "mimeType": "image/png"})
setting("image-without-data", "images/0", {"name": "nothing"})
setting("texture-image-out-of-range", "textures/0/source", 1)
setting("texture-without-image", "textures/0", {"sampler": 0})
setting("texture-sampler-out-of-range", "textures/0/sampler", 1)
setting("sampler-filter-unknown", "samplers/0/magFilter", 12345)
setting("material-texture-out-of-range", "materials/0/pbrMetallicRoughness/baseColorTexture/index", -2)
setting("material-color-of-two", "materials/0/pbrMetallicRoughness/baseColorFactor", [1, 1])
setting("material-metallic-out-of-range", "materials/0/pbrMetallicRoughness/metallicFactor", -0.5)
setting("material-alpha-mode-unknown", "materials/0/alphaMode", "GLASS")
setting("material-alpha-cutoff-negative", "materials/0/alphaCutoff", -1)
for extension, member, value in [
        ("ior", "ior", -1.5), ("transmission", "transmissionFactor", 2), ("volume", "thicknessFactor", -1),
        ("volume", "attenuationDistance", -1), ("volume", "attenuationColor", [1, 2, 1]),
        ("dispersion", "dispersion", -0.1), ("specular", "specularFactor", 3)]:
    setting("material-%s-out-of-range" % member, "materials/0/extensions", {"KHR_materials_" + extension: {member: value}})
setting("material-conductor-without-k", "materials/0/extras", {"probebench": {"eta": [1, 1, 1]}})
setting("material-conductor-zero", "materials/0/extras", {"probebench": {"eta": [0, 0, 0], "k": [0, 0, 0]}})
setting("material-roughness-out-of-range", "materials/0/pbrMetallicRoughness/roughnessFactor", 20)
setting("material-transform-not-numbers", "materials/0/pbrMetallicRoughness/baseColorTexture/extensions",
        {"KHR_texture_transform": {"scale": ["a", "b"]}})
setting("camera-field-of-view-negative", "cameras/0/perspective/yfov", -1)
setting("camera-field-of-view-too-wide", "cameras/0/perspective/yfov", math.pi)
setting("camera-near-plane-zero", "cameras/0/perspective/znear", 0)
setting("camera-perspective-missing", "cameras/0/perspective", None)
setting("light-type-unknown", "extensions/KHR_lights_punctual/lights/0/type", "area")
setting("light-intensity-negative", "extensions/KHR_lights_punctual/lights/0/intensity", -1)
setting("light-cone-inside-out", "extensions/KHR_lights_punctual/lights/0",
        {"type": "spot", "spot": {"innerConeAngle": 0.9, "outerConeAngle": 0.5}})
setting("animation-sampler-out-of-range", "animations/0/channels/0/sampler", 3)
setting("animation-node-out-of-range", "animations/0/channels/0/target/node", 30)
setting("animation-counts-differ", "accessors/4/count", 1)
setting("animation-values-of-wrong-type", "animations/0/samplers/0/output", 2)
setting("animation-interpolation-unknown", "animations/0/samplers/0/interpolation", "WOBBLY")
setting("animation-of-a-matrix", "nodes/0/matrix", [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
setting("extras-environment-damaged", "scenes/0/extras", {"probebench": {"schema": 1, "environment": {"sky": 3}}})
setting("extras-schema-unknown", "scenes/0/extras", {"probebench": {"schema": 99}})
setting("extras-faces-out-of-range", "scenes/0/extras", {"probebench": {
    "schema": 1, "environment": {"name": "x", "ambient": [], "faces": [0, 1, 2, 3, 4, 1000]}}})
setting("draco-data-damaged", "meshes/0/primitives/0/extensions",
        {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}})
setting("draco-view-out-of-range", "meshes/0/primitives/0/extensions",
        {"KHR_draco_mesh_compression": {"bufferView": 100, "attributes": {"POSITION": 0}}})
setting("draco-attributes-missing", "meshes/0/primitives/0/extensions", {"KHR_draco_mesh_compression": {"bufferView": 0}})
setting("sparse-index-out-of-range", "accessors/0/sparse",
        {"count": 3, "indices": {"bufferView": 0, "componentType": 5125, "byteOffset": 4},
         "values": {"bufferView": 1}})
setting("sparse-count-huge", "accessors/0/sparse",
        {"count": 2**31 + 5, "indices": {"bufferView": 3, "componentType": 5123}, "values": {"bufferView": 1}})
setting("sparse-zeros-huge", "accessors/0", {"componentType": 5126, "type": "VEC3", "count": 2**36})
setting("mode-points-only", "meshes/0/primitives/0/mode", 0)


@change("node-two-parents")
def _(scene):
    scene.json["nodes"][0]["children"] = [2]
    scene.json["nodes"][1]["children"] = [2]


@change("node-long-cycle")
def _(scene):
    count = 50
    scene.json["nodes"] += [{"children": [3 + (i + 1) % count]} for i in range(count)]


@change("index-out-of-range")
def _(scene):
    offset = scene.json["bufferViews"][3]["byteOffset"]
    scene.data = scene.data[:offset] + struct.pack("<3H", 0, 1, 9) + scene.data[offset + 6:]


@change("position-nan")
def _(scene):
    scene.replace_floats(0, [math.nan] + POSITIONS[1:])


@change("position-infinite")
def _(scene):
    scene.replace_floats(0, [math.inf] + POSITIONS[1:])


@change("normal-nan")
def _(scene):
    scene.replace_floats(1, [math.nan] * 9)


@change("triangles-without-area")
def _(scene):
    scene.replace_floats(0, [1.0] * 9)


@change("animation-times-unsorted")
def _(scene):
    scene.replace_floats(4, [1, 0])


@change("animation-times-nan")
def _(scene):
    scene.replace_floats(4, [0, math.nan])


@change("animation-rotation-zero")
def _(scene):
    scene.json["animations"][0]["channels"][0]["target"]["path"] = "rotation"
    scene.add("f", "VEC4", 5126, [0.0] * 8, 4)
    scene.json["animations"][0]["samplers"][0]["output"] = 6


@change("node-scales-multiply-too-large")
def _(scene):
    scene.json["nodes"][0].update({"scale": [1e7] * 3, "children": [3]})
    scene.json["nodes"].append({"name": "product", "mesh": 0, "scale": [1e7] * 3})


@change("node-scales-multiply-to-infinity")
def _(scene):
    scene.json["nodes"] += [{"name": "link %d" % i, "scale": [1e9] * 3, "children": [4 + i]} for i in range(6)]
    scene.json["nodes"].append({"name": "infinite", "mesh": 0})
    scene.json["scenes"][0]["nodes"].append(3)


def animate_scale(scene, values):
    scene.json["animations"][0]["channels"][0]["target"]["path"] = "scale"
    scene.replace_floats(5, values)


@change("animation-scale-too-large")
def _(scene):
    animate_scale(scene, [1, 1, 1, 1, 1, 1e10])


@change("animation-scale-nan")
def _(scene):
    animate_scale(scene, [1, 1, 1, 1, math.nan, 1])


@change("warn-node-scaled-to-nothing")
def _(scene):
    scene.json["nodes"][0].update({"scale": [1e-6] * 3, "children": [3]})
    scene.json["nodes"].append({"name": "product", "mesh": 0, "scale": [1e-6, 1e-6, 1]})


@change("warn-deep-hierarchy")
def _(scene):
    scene.json["nodes"] += [{"children": [4 + i]} for i in range(3000)] + [{"mesh": 0}]
    scene.json["scenes"][0]["nodes"].append(3)
    scene.json["extensionsUsed"].append("EXT_unheard_of")


@change("warn-orthographic-camera")
def _(scene):
    scene.json["cameras"][0] = {"type": "orthographic",
                                "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10}}


@change("warn-some-triangles-without-area-and-points")
def _(scene):
    scene.json["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 0})


setting("warn-morph-targets-of-colors", "meshes/0/primitives/0/targets", [{"POSITION": 0, "COLOR_0": 0}])
setting("morph-target-accessor-out-of-range", "meshes/0/primitives/0/targets", [{"POSITION": 99}])
setting("morph-targets-number", "meshes/0/primitives/0/targets", 3)
setting("morph-target-of-scalars", "meshes/0/primitives/0/targets", [{"POSITION": 3}])
setting("morph-weights-text", "meshes/0/weights", ["much"])
setting("skin-joint-out-of-range", "skins", [{"joints": [99]}])
setting("skin-without-joints", "skins", [{"name": "bones"}])
setting("wave-period-zero", "nodes/0/extras", {"probebench": {"wave": {"periodSeconds": 0}}})
setting("environment-changes-not-increasing", "scenes/0/extras",
        {"probebench": {"schema": 1, "environmentChanges": [{"fromSeconds": 2, "environment": {"constant": 1}},
                                                            {"fromSeconds": 2, "environment": {"constant": 0}}]}})
setting("warn-skin", "skins", [{"joints": [0]}])
setting("warn-extension-used", "extensionsUsed", ["EXT_unheard_of"])
setting("warn-extras-member-unknown", "scenes/0/extras", {"probebench": {"schema": 1, "shadow": "none"}})
setting("warn-material-ior-below-one", "materials/0/extensions", {"KHR_materials_ior": {"ior": 0.5}})
setting("warn-material-ior-absurd", "materials/0/extensions", {"KHR_materials_ior": {"ior": 1e30}})
setting("warn-material-attenuation-distance-zero", "materials/0/extensions",
        {"KHR_materials_volume": {"attenuationDistance": 0}})
setting("warn-material-color-above-one", "materials/0/pbrMetallicRoughness/baseColorFactor", [2, 1, 1, 1])
setting("warn-material-glass-not-closed", "materials/0/extensions",
        {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}})


def bare_files():
    good = Scene()
    glb = good.glb()
    yield "empty.gltf", b""
    yield "words.gltf", b"these are words"
    yield "null.gltf", b"null"
    yield "array.gltf", b"[1, 2]"
    yield "unclosed.gltf", good.text().encode()[:-30]
    yield "number-too-large.gltf", b'{"asset": {"version": "2.0"}, "scene": 1e999}'
    yield "not-utf8.gltf", b'{"asset": {"version": "2.0", "generator": "\xff\xfe"}}'
    yield "deeply-nested.gltf", b'{"extras": ' + b"[" * 20000 + b"]" * 20000 + b"}"
    yield "nothing-but-a-version.gltf", b'{"asset": {"version": "2.0"}}'
    yield "header-only.glb", glb[:12]
    yield "truncated-json.glb", glb[:200]
    yield "truncated-data.glb", glb[:-8]
    yield "version-1.glb", glb[:4] + struct.pack("<I", 1) + glb[8:]
    yield "chunk-length-huge.glb", glb[:12] + struct.pack("<I", 0xFFFFFFF0) + glb[16:]
    yield "length-huge.glb", glb[:8] + struct.pack("<I", 0xFFFFFFFF) + glb[12:]
    yield "no-json-chunk.glb", glb[:16] + b"JUNK" + glb[20:]
    json_end = 20 + struct.unpack("<I", glb[12:16])[0]
    data_missing = glb[:8] + struct.pack("<I", json_end) + glb[12:json_end]
    yield "data-chunk-missing.glb", data_missing


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent
    for name, apply in CHANGES.items():
        scene = Scene()
        if name == "warn-skin":
            scene.json["nodes"][0]["skin"] = 0
        apply(scene)
        (folder / (name + ".gltf")).write_text(scene.text() + "\n")
    for name, data in bare_files():
        (folder / name).write_bytes(data)


main()
