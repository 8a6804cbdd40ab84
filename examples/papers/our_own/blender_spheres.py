#!/usr/bin/env python3
"""Compares Blender's spheres of GGX models, from the shader and the glTF file of `gonio fit`, with gonio's.

  gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/blender_spheres.py \\
    -o spheres.png satin_purple.binary ...

It needs `pip install bpy` and the module gonio.
"""

import argparse
import pathlib
import tempfile

import bpy  # before _cycles, which bpy provides
import _cycles
import mathutils
import numpy as np

import gonio
from seen_spheres import LIGHTS, SIZE, WHITE, GonioSphere, delta_e, luminance


def new_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.shading_system = "CYCLES", True
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 64, False, 1
    scene.cycles.pixel_filter_type, scene.render.filter_size = "BOX", 1.0
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale, camera.location = "ORTHO", 2, (0, 0, 4)
    scene.collection.objects.link(camera)
    scene.camera = camera
    for direction in LIGHTS:
        light = bpy.data.objects.new("light", bpy.data.lights.new("light", "SUN"))
        light.data.angle, light.data.energy = 0, 1
        light.rotation_euler = mathutils.Vector(direction).to_track_quat("-Z", "Y").to_euler()
        scene.collection.objects.link(light)
    return scene


def rendered(scene, folder):
    scene.render.filepath = str(folder / "sphere.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.array(image.pixels[:]).reshape(SIZE, SIZE, 4)[::-1, :, :3]
    bpy.data.images.remove(image)
    return pixels


def of_nodes(folder, add):
    """Renders a finely divided sphere. `add` makes the node of its surface, and returns the node's output."""
    scene = new_scene()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=512, ring_count=256, radius=1)
    sphere = bpy.context.object
    for polygon in sphere.data.polygons:
        polygon.use_smooth = True
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    tree.links.new(add(tree.nodes), tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    sphere.data.materials.append(material)
    return rendered(scene, folder)


def white(nodes):
    node = nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value, node.inputs["Roughness"].default_value = (1, 1, 1, 1), 0
    return node.outputs["BSDF"]


def shader(file):
    def add(nodes):
        if not _cycles.osl_compile(str(file), str(file.with_suffix(".oso"))):
            raise SystemExit(f"{file} does not compile")
        node = nodes.new("ShaderNodeScript")
        node.mode, node.filepath = "EXTERNAL", str(file)
        return node.outputs.new("NodeSocketShader", "BSDF")

    return add


def of_gltf(folder, file):
    scene = new_scene()
    bpy.ops.import_scene.gltf(filepath=str(file))
    return rendered(scene, folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("materials", nargs="+", type=pathlib.Path, help="MERL files")
    parser.add_argument("-o", "--output", required=True, help="picture of all spheres (.png)")
    arguments = parser.parse_args()
    by_gonio = GonioSphere(gonio.render_sphere)
    rows, shown = [], []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        exposure = WHITE / luminance(of_nodes(folder, white))
        for file in arguments.materials:
            table = gonio.read_merl(file)
            model = gonio.fit_model(table, "ggx").model
            osl, gltf = folder / "paint.osl", folder / "paint.gltf"
            osl.write_text(model.osl())
            gltf.write_text(model.gltf())
            expected = by_gonio(model)
            spheres = [exposure * of_nodes(folder, shader(osl)), exposure * of_gltf(folder, gltf), by_gonio(table)]
            differences = [delta_e(sphere, expected) for sphere in spheres]
            cells = [f"{np.median(d):.2f}, {np.quantile(d, 0.99):.2f}" for d in differences]
            rows.append(f"| {file.stem} | " + " | ".join(cells) + " |")
            shown.append(np.concatenate([spheres[2], expected, *spheres[:2]], axis=1))
    print(f"\nBlender {bpy.app.version_string}, Cycles. Delta E from the model in gonio, median and 99th percentile.\n")
    print("| | `--osl` | `--gltf` | the table itself |\n|---|---|---|---|\n" + "\n".join(rows))
    gonio.write_png(arguments.output, np.ascontiguousarray(np.concatenate(shown), dtype=np.float32))


if __name__ == "__main__":
    main()
