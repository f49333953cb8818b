"""Renders surfaces as water in a tank. Blender runs it: blender --background --python in_blender.py -- settings.json

The settings: `box` [[low], [high]] of the grid, z upward [m], `eye` [azimuth, elevation] in degrees, `size`
[width, height] in pixels, `samples` per pixel, and `pictures`, each with a `water`, an NPZ file of points and
triangles, the `picture` to be made, a PNG, and `bodies`, pairs of points and triangles.
"""

import json
import math
import sys

import bpy
import numpy as np
from mathutils import Euler, Vector

WATER = (0.04, 0.50, 0.76, 1)  # what is left of white light behind a depth of `CLEAR` of the tank
CLEAR = 0.12
FLOOR = ((0.80, 0.80, 0.79, 1), (0.76, 0.76, 0.755, 1), (0.42, 0.43, 0.45, 1))  # two kinds of tiles, the joints
TILES = 12  # along the tank
BODY = (0.80, 0.16, 0.04, 1)


def material(name):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    return made, made.node_tree.nodes, made.node_tree.links


def water(size):
    """Clear, smooth, and bluer with depth."""
    made, nodes, links = material("water")
    surface = nodes["Principled BSDF"]
    surface.inputs["Transmission"].default_value = 1
    surface.inputs["Roughness"].default_value = 0.0
    surface.inputs["IOR"].default_value = 1.333
    surface.inputs["Base Color"].default_value = (1, 1, 1, 1)
    # Light falls straight through: else the floor beneath would be dark but for what happens to be found by chance.
    straight = nodes.new("ShaderNodeBsdfTransparent")
    straight.inputs["Color"].default_value = (0.72, 0.90, 0.97, 1)
    choice = nodes.new("ShaderNodeMixShader")
    path = nodes.new("ShaderNodeLightPath")
    links.new(path.outputs["Is Shadow Ray"], choice.inputs[0])
    links.new(surface.outputs["BSDF"], choice.inputs[1])
    links.new(straight.outputs["BSDF"], choice.inputs[2])
    links.new(choice.outputs["Shader"], nodes["Material Output"].inputs["Surface"])
    absorption = nodes.new("ShaderNodeVolumeAbsorption")
    absorption.inputs["Color"].default_value = WATER
    absorption.inputs["Density"].default_value = 1 / (CLEAR * size)
    links.new(absorption.outputs["Volume"], nodes["Material Output"].inputs["Volume"])
    return made


def tiles(size):
    """The floor: squares, whose lines show how the water bends light."""
    made, nodes, links = material("tiles")
    surface = nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = 0.45
    brick = nodes.new("ShaderNodeTexBrick")
    brick.offset = 0
    for name, colour in zip(("Color1", "Color2", "Mortar"), FLOOR):
        brick.inputs[name].default_value = colour
    for name, value in (("Scale", 1), ("Mortar Size", 0.0012 * size), ("Brick Width", size / TILES),
                        ("Row Height", size / TILES)):
        brick.inputs[name].default_value = value
    place = nodes.new("ShaderNodeNewGeometry")
    links.new(place.outputs["Position"], brick.inputs["Vector"])
    links.new(brick.outputs["Color"], surface.inputs["Base Color"])
    return made


def plain(name, colour, roughness):
    made, nodes, _ = material(name)
    nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
    nodes["Principled BSDF"].inputs["Roughness"].default_value = roughness
    return made


def mesh_of(name, points, triangles, look, sharp):
    """A thing that is smooth but where it turns by more than `sharp` degrees."""
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(points, np.float32).ravel())
    mesh.loops.add(3 * len(triangles))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(triangles, np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), bool))
    mesh.update(calc_edges=True)
    mesh.use_auto_smooth = True
    mesh.auto_smooth_angle = math.radians(sharp)
    mesh.materials.append(look)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(made)
    return made


def solid(points, triangles, look):
    """A body, a little into the water, whose surface lies on it."""
    points = np.array(points)
    middle = points.mean(axis=0)
    return mesh_of("body", middle + 1.004 * (points - middle), triangles, look, 40)


def edge(a, b, radius, look):
    """A thin bar between two corners of the tank."""
    way = b - a
    bpy.ops.mesh.primitive_cylinder_add(radius=radius, depth=way.length, location=(a + b) / 2)
    bar = bpy.context.object
    bar.rotation_euler = way.to_track_quat("Z", "Y").to_euler()
    bar.data.materials.append(look)


def tank(low, high, size):
    """Bars along the edges, around the water, which would show bars inside of it too thick."""
    steel = plain("steel", (0.03, 0.03, 0.035, 1), 0.35)
    low, high = low - 0.004 * size, high + 0.004 * size
    corners = [Vector([(high if k >> d & 1 else low)[d] for d in range(3)]) for k in range(8)]
    for a in range(8):
        for bit in (1, 2, 4):
            if not a & bit:
                edge(corners[a], corners[a | bit], 0.003 * size, steel)


def lamp(middle, way, width, energy, size):
    """A bright square that looks at the tank; `energy` for a tank of 1 m. [W]"""
    bpy.ops.object.light_add(type="AREA", location=middle + Vector(way) * size)
    made = bpy.context.object
    made.data.energy = energy * size * size
    made.data.size = width * size
    made.rotation_euler = (middle - made.location).to_track_quat("-Z", "Y").to_euler()


def light(middle, size, azimuth):
    """A lamp behind the tank, which makes water shine, a weaker one before it, and a sky."""
    world = bpy.data.worlds["World"]
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    ramp, place, up = (nodes.new(f"ShaderNode{kind}") for kind in ("ValToRGB", "TexCoord", "SeparateXYZ"))
    links.new(place.outputs["Generated"], up.inputs[0])
    links.new(up.outputs["Z"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], nodes["Background"].inputs["Color"])
    ramp.color_ramp.elements[0].color = (0.95, 0.96, 0.97, 1)
    ramp.color_ramp.elements[1].color = (0.16, 0.34, 0.62, 1)
    ramp.color_ramp.elements[1].position = 0.55
    nodes["Background"].inputs["Strength"].default_value = 0.9
    turn = Euler((0, 0, math.radians(azimuth))).to_matrix()
    lamp(middle, turn @ Vector((-1.1, 1.3, 1.9)), 0.8, 75, size)


def camera(corners, eye, aspect):
    """Looks at the tank from the front, `eye` degrees to the right and above, and has all of it in sight."""
    azimuth, elevation = (math.radians(angle) for angle in eye)
    bpy.ops.object.camera_add(rotation=(math.pi / 2 - elevation, 0, azimuth))
    made = bpy.context.object
    made.data.angle = math.radians(30)
    # Else nothing that is nearer than 0.1 m is seen: no drop.
    made.data.clip_start = min(0.1, 0.01 * max((a - b).length for a in corners for b in corners))
    bpy.context.scene.camera = made
    bpy.context.view_layer.update()
    middle = sum(corners, Vector()) / len(corners)
    wide = [middle + 1.03 * (corner - middle) for corner in corners]
    made.location = made.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), [x for c in wide for x in c])[0]


def prepare(scene, settings):
    """Everything but water and bodies."""
    low, high = (np.array(corner) for corner in settings["box"])
    size = float((high - low).max())
    middle = Vector((low + high) / 2)
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = settings["samples"]
    scene.cycles.seed = 1
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 32
    scene.cycles.transmission_bounces = 32
    scene.cycles.diffuse_bounces = 2
    scene.cycles.sample_clamp_indirect = 1.5
    scene.cycles.blur_glossy = 1
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.look = "High Contrast"
    scene.render.resolution_x, scene.render.resolution_y = settings["size"]
    # A little above the lower side of the water, so that there is no air between them.
    bpy.ops.mesh.primitive_plane_add(size=60 * size, location=(middle[0], middle[1], low[2] + 0.001 * size))
    bpy.context.object.data.materials.append(tiles(size))
    tank(low, high, size)
    light(middle, size, settings["eye"][0])
    corners = [Vector([(high if k >> d & 1 else low)[d] for d in range(3)]) for k in range(8)]
    camera(corners, settings["eye"], settings["size"][0] / settings["size"][1])
    return water(size), plain("body", BODY, 0.4)


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        settings = json.load(file)
    scene = bpy.context.scene
    liquid, coat = prepare(scene, settings)
    for picture in settings["pictures"]:
        with np.load(picture["water"]) as surface:
            shown = [mesh_of("water", surface["points"], surface["triangles"], liquid, 60)]
        shown += [solid(points, triangles, coat) for points, triangles in picture["bodies"]]
        scene.render.filepath = picture["picture"]
        bpy.ops.render.render(write_still=True)
        for thing in shown:
            bpy.data.objects.remove(thing, do_unlink=True)


main()
