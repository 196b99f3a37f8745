"""Renders the scenes of cycles_gl_test with Blender's Cycles, as an independent witness:

    blender -b --factory-startup -P tests/cycles/make.py -- SCENE.json... [--samples N]

writes SCENE.exr beside this script: linear, half float, 128 x 128. Made with Blender 3.4.1; the test needs no Blender.

The scene files are read as they are; boxes, balls and cylinders at the root become meshes. Farfield's y is Blender's z.
A point light of intensity I (W/sr) is one of 4 pi I watts in Blender, a directional one of irradiance E a sun of strength E.

Bounces: Farfield meets emitting surfaces and the sky by its hemisphere rays only, Cycles samples them at every vertex too,
one surface further. So k bounces are the sum of two pictures: lights with k bounces, emission and sky with k - 1.

    blender -b --factory-startup -P tests/cycles/make.py -- SCENE.json --samples N --picture FILE.exr [--size N]

makes one picture of all light with the scene's own number of bounces, on two cores, to compare times with.
"""
import argparse
import json
import math
import pathlib
import sys
import tempfile

import bpy
import numpy
from mathutils import Euler, Matrix, Vector

LIGHTS, EMISSION = {"lights"}, {"emission"}
UP = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))  # Farfield's frame to Blender's


def cylinder(radius, half_height, sides=512):
    ring = [(radius * math.cos(a), radius * math.sin(a)) for a in (2 * math.pi * i / sides for i in range(sides))]
    vertices = [(x, -half_height, z) for x, z in ring] + [(x, half_height, z) for x, z in ring]
    faces = [(i, (i + 1) % sides, sides + (i + 1) % sides, sides + i) for i in range(sides)]
    return vertices, faces + [tuple(range(sides)), tuple(range(sides, 2 * sides))]


def box(half):
    vertices = [(x * half[0], y * half[1], z * half[2]) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return vertices, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def sphere(radius, rings=256):
    """Flat facets, so that normals and shadows agree; 1e-4 of the radius off at most."""
    def at(i, j):
        polar, azimuth = math.pi * i / rings, math.pi * j / rings
        return (radius * math.sin(polar) * math.cos(azimuth), radius * math.cos(polar),
                radius * math.sin(polar) * math.sin(azimuth))
    around = 2 * rings
    vertices = [at(i, j) for i in range(rings + 1) for j in range(around)]
    return vertices, [(i * around + j, i * around + (j + 1) % around, (i + 1) * around + (j + 1) % around,
                       (i + 1) * around + j) for i in range(rings) for j in range(around)]


def diffuse_material(name, values, emitting):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")  # roughness 0: Lambert
    diffuse.inputs["Color"].default_value = (*values.get("albedo", (0.8, 0.8, 0.8)), 1)
    surface = diffuse
    if emitting and "emission" in values:
        emission = nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (*values["emission"], 1)
        surface = nodes.new("ShaderNodeAddShader")
        links.new(diffuse.outputs[0], surface.inputs[0])
        links.new(emission.outputs[0], surface.inputs[1])
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def add_shape(node, materials, first_material):
    kind = node["kind"]
    if kind == "box":
        vertices, faces = box(node["half_size"])
    elif kind == "sphere":
        vertices, faces = sphere(node["radius"])
    elif kind == "capped_cylinder":
        vertices, faces = cylinder(node["radius"], node["half_height"])
    else:
        sys.exit(f"make.py: no mesh for the kind {kind}")
    turn = Euler([math.radians(a) for a in node.get("rotate", (0, 0, 0))], "XYZ").to_matrix()
    at = Vector(node.get("translate", (0, 0, 0)))
    mesh = bpy.data.meshes.new(kind)
    mesh.from_pydata([UP @ (turn @ Vector(v) + at) for v in vertices], [], faces)
    mesh.materials.append(materials[node.get("material", first_material)])
    bpy.context.collection.objects.link(bpy.data.objects.new(kind, mesh))


def add_light(name, values):
    kind = {"point": "POINT", "directional": "SUN"}[values["kind"]]
    light = bpy.data.lights.new(name, kind)
    light.color = values["intensity"]
    if kind == "POINT":
        light.energy = 4 * math.pi
        light.shadow_soft_size = 0
    else:
        light.energy = 1
        light.angle = 0
    object = bpy.data.objects.new(name, light)
    bpy.context.collection.objects.link(object)
    object.location = UP @ Vector(values.get("position", (0, 0, 0)))
    if kind == "SUN":
        direction = UP @ Vector(values["direction"])
        object.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()


def set_sky(sky):
    """Radiance horizon at and below y = 0, zenith straight up, linear in y between."""
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    background = nodes["Background"]
    parts = nodes.new("ShaderNodeSeparateXYZ")
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], parts.inputs[0])
    mix = nodes.new("ShaderNodeMixRGB")  # clamps the factor
    links.new(parts.outputs["Z"], mix.inputs["Fac"])
    mix.inputs[1].default_value = (*sky.get("horizon", (0, 0, 0)), 1)
    mix.inputs[2].default_value = (*sky.get("zenith", (0, 0, 0)), 1)
    links.new(mix.outputs[0], background.inputs["Color"])
    world.cycles.sampling_method = "MANUAL"
    world.cycles.sample_map_resolution = 1024


def set_camera(values):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(values["field_of_view"])
    object = bpy.data.objects.new("camera", camera)
    bpy.context.collection.objects.link(object)
    bpy.context.scene.camera = object
    object.location = UP @ Vector(values["position"])
    forward = UP @ Vector(values["target"]) - object.location
    object.rotation_euler = forward.to_track_quat("-Z", "Y").to_euler()


def render(scene, light, bounces, samples, size, file):
    """Of LIGHTS, of EMISSION, which has the sky, or of both."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    materials = {name: diffuse_material(name, values, "emission" in light) for name, values in scene["materials"].items()}
    for node in scene["root"]["children"]:
        add_shape(node, materials, next(iter(materials)))
    if "lights" in light:
        for name, values in scene.get("lights", {}).items():
            add_light(name, values)
    set_sky(scene.get("sky", {}) if "emission" in light else {})
    set_camera(scene["camera"])

    settings = bpy.context.scene
    settings.render.engine = "CYCLES"
    settings.render.resolution_x = settings.render.resolution_y = size
    settings.render.resolution_percentage = 100
    settings.render.threads_mode = "FIXED"
    settings.render.threads = 2
    settings.render.image_settings.file_format = "OPEN_EXR"
    settings.render.image_settings.color_depth = "32"
    cycles = settings.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = bounces
    settings.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)


def pixels(scene, light, bounces, samples, size):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "part.exr"
        render(scene, light, bounces, samples, size, file)
        return numpy.array(bpy.data.images.load(str(file)).pixels[:], dtype=numpy.float32)


def main():
    parser = argparse.ArgumentParser(prog="make.py")
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--samples", type=int, default=2048)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--picture", type=pathlib.Path)
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    for file in options.scenes:
        scene = json.loads(file.read_text())
        if options.picture:
            bounces = scene.get("settings", {}).get("bounces", 1)
            render(scene, LIGHTS | EMISSION, bounces, options.samples, options.size, options.picture.absolute())
            continue
        bounces = 4  # as in the test
        sum_of_parts = (pixels(scene, LIGHTS, bounces, options.samples, options.size)
                        + pixels(scene, EMISSION, bounces - 1, options.samples, options.size))
        result = bpy.data.images.new("sum", options.size, options.size, float_buffer=True, alpha=False)
        result.colorspace_settings.name = "Linear"
        result.pixels = sum_of_parts
        settings = bpy.context.scene.render.image_settings
        settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR", "16", "ZIP"
        settings.color_mode = "RGB"
        result.save_render(str(pathlib.Path(__file__).parent / (file.stem + ".exr")))


main()
