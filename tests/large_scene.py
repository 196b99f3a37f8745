"""Writes a large scene to standard output, for measurements: python3 large_scene.py molecule|city NODES

molecule: spheres in a ball, smaller the more there are, so that they cover about as much of the picture.
city: houses on a square, each a few primitives, some cut or blended, half of them turned.
"""
import json
import random
import sys


def number(low, high):
    return round(random.uniform(low, high), 4)


def molecule(nodes):
    spheres = []
    while len(spheres) < nodes:
        place = [random.uniform(-1, 1) for _ in range(3)]
        if sum(v * v for v in place) < 1:
            place = [round(place[0], 4), round(place[1] + 1.2, 4), round(place[2], 4)]
            spheres.append({"kind": "sphere", "radius": round(0.62 * nodes ** (-1 / 3), 4), "translate": place})
    return spheres, {"position": [0, 1.8, 4.2], "target": [0, 1.1, 0], "field_of_view": 45}


def house(width, depth, height):
    parts = [{"kind": "box", "half_size": [width, height / 2, depth], "translate": [0, height / 2, 0],
              "material": random.choice(["stone", "brick", "glass"])}]
    if random.random() < 0.6:
        parts.append({"kind": "rounded_box", "half_size": [0.6 * width, 0.2 * height, 0.6 * depth],
                      "radius": 0.1 * width, "translate": [0, 1.1 * height, 0], "material": "stone"})
    if random.random() < 0.5:
        parts.append({"kind": "capped_cylinder", "radius": 0.3 * width, "half_height": 0.1 * height,
                      "translate": [0.4 * width, 1.05 * height, 0.3 * depth], "material": "metal"})
    if random.random() < 0.3:
        parts.append({"kind": "union", "radius": 0.2 * width, "material": "metal", "children": [
            {"kind": "sphere", "radius": 0.5 * width, "translate": [0, height, 0]},
            {"kind": "capped_cylinder", "radius": 0.2 * width, "half_height": 0.2 * height,
             "translate": [0, 1.2 * height, 0]}]})
    if random.random() < 0.4:
        parts.append({"kind": "subtract", "material": "brick", "children": [
            {"kind": "box", "half_size": [1.1 * width, 0.05 * height, 1.1 * depth], "translate": [0, 0.05 * height, 0]},
            {"kind": "box", "half_size": [0.5 * width, 0.1 * height, 2 * depth], "translate": [0, 0.05 * height, 0]}]})
    return parts


def city(nodes):
    houses, count = [], 0
    side = max(2, int((nodes / 6.1) ** 0.5))
    cell = 8 / side
    while count < nodes:
        at = len(houses)
        parts = house(cell * number(0.25, 0.4), cell * number(0.25, 0.4), cell * number(0.3, 2.2))
        place = [cell * (at % side + 0.5) - 4, 0, cell * (at // side + 0.5) - 4]
        houses.append({"kind": "union", "children": parts, "translate": place})
        if random.random() < 0.5:
            houses[-1]["rotate"] = [0, number(-30, 30), 0]
        count += 1 + sum(1 + len(part.get("children", [])) for part in parts)
    return houses, {"position": [0, 4.5, 9], "target": [0, 0.3, 0], "field_of_view": 42}


if len(sys.argv) != 3 or sys.argv[1] not in ("molecule", "city"):
    sys.exit(__doc__)
random.seed(2)
content, camera = globals()[sys.argv[1]](int(sys.argv[2]))
json.dump({
    "farfield": 1, "camera": camera,
    "sky": {"horizon": [0.85, 0.82, 0.78], "zenith": [0.35, 0.5, 0.75]},
    "materials": {"white": {"albedo": [0.7, 0.7, 0.7]}, "stone": {"albedo": [0.7, 0.7, 0.65]},
                  "brick": {"albedo": [0.6, 0.3, 0.2]}, "glass": {"albedo": [0.3, 0.45, 0.6]},
                  "metal": {"albedo": [0.5, 0.5, 0.5]}},
    "lights": {"sun": {"kind": "directional", "direction": [-1, -1.4, -0.8], "intensity": [3, 2.8, 2.5]}},
    "root": {"kind": "union", "children": [{"kind": "plane"}] + content}}, sys.stdout)
