"""Renders a .glb with Blender's Cycles as the reference does, to compare the two (docs/other-renderers.md).

  blender -b --factory-startup --python-exit-code 3 --python scripts/cycles.py -- SCENE.glb -o OUT.exr [options]

Blender's importer leaves out what this adds: KHR_materials_specular, the strength of emission, the constant sky in
scenes[0].extras.skyRadiance or of an exported built-in scene. Matte materials (specular factor 0) become Lambert's, because Blender's Principled material
has Burley's diffuse lobe. Box filter, no clamping, no denoising, no adaptive sampling.
"""
import argparse
import json
import struct
import sys

import bpy
import numpy

parser = argparse.ArgumentParser()
parser.add_argument("scene")
parser.add_argument("-o", dest="output", required=True)
parser.add_argument("--size", default="640x360")
parser.add_argument("--spp", type=int, default=64)
parser.add_argument("--seed", type=int, default=0)
parser.add_argument("--bounces", type=int, default=64, help="of any kind")
parser.add_argument("--diffuse-depth", type=int, default=None, help="diffuse bounces")
options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])

with open(options.scene, "rb") as file:
    header = file.read(20)
    document = json.loads(file.read(struct.unpack("<I", header[12:16])[0]))

for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
if not hasattr(numpy, "bool"):
    numpy.bool = bool  # the importer of Blender 3.4 wants a numpy older than Debian's
bpy.ops.import_scene.gltf(filepath=options.scene, import_shading="NORMALS")


def sky_radiance(extras):
    sky = extras.get("probebench", {}).get("environment", {}).get("sky")
    if sky is None:
        return extras.get("skyRadiance", [0.0, 0.0, 0.0])
    if not sky["horizon"] == sky["zenith"] == sky["below"] or any(sky["glow"]):
        sys.exit("only a constant sky can be rendered with Cycles")
    return sky["horizon"]


def is_matte(source):
    extensions = source.get("extensions", {})
    return (source.get("pbrMetallicRoughness", {}).get("metallicFactor", 1.0) == 0.0
            and extensions.get("KHR_materials_specular", {}).get("specularFactor", 1.0) == 0.0
            and "KHR_materials_transmission" not in extensions)


def make_lambert(tree, principled):
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    color = principled.inputs["Base Color"]
    diffuse.inputs["Color"].default_value = color.default_value
    for link in color.links:
        tree.links.new(link.from_socket, diffuse.inputs["Color"])
    for link in list(principled.outputs[0].links):
        tree.links.new(diffuse.outputs[0], link.to_socket)


for source in document.get("materials", []):
    material = bpy.data.materials.get(source["name"])
    if material is None or not material.use_nodes:
        continue
    extensions = source.get("extensions", {})
    emits = any(source.get("emissiveFactor", [0.0]))
    for node in [n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED"]:
        # 0.5 stands for an F0 of 0.04.
        node.inputs["Specular"].default_value = 0.5 * extensions.get("KHR_materials_specular", {}).get("specularFactor", 1.0)
        strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
        node.inputs["Emission Strength"].default_value = strength
        if is_matte(source) and not emits:
            make_lambert(material.node_tree, node)

scene = bpy.context.scene
scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
sky = sky_radiance(document["scenes"][0].get("extras", {}))
scene.world = bpy.data.worlds.new("sky")
scene.world.use_nodes = True
background = scene.world.node_tree.nodes["Background"]
background.inputs["Color"].default_value = (*sky, 1.0)
background.inputs["Strength"].default_value = 1.0

render = scene.render
render.engine = "CYCLES"
render.resolution_x, render.resolution_y = (int(side) for side in options.size.split("x"))
render.resolution_percentage = 100
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_depth = "32"
render.image_settings.color_mode = "RGB"
render.use_compositing = render.use_sequencer = False
render.filepath = options.output
cycles = scene.cycles
cycles.device = "CPU"
cycles.samples, cycles.seed = options.spp, options.seed
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = options.bounces
cycles.transparent_max_bounces = options.bounces
cycles.diffuse_bounces = options.bounces if options.diffuse_depth is None else options.diffuse_depth
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
cycles.light_sampling_threshold = 0.0
cycles.caustics_reflective = cycles.caustics_refractive = True
cycles.pixel_filter_type = "BOX"
bpy.ops.render.render(write_still=True)
