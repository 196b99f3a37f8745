"""Measures how soon the editor shows an edit and how long its own frames take: a benchmark, not a test.

Usage: edit_latency.py FARFIELD [NODES]

Makes a scene of so many nodes (200), opens it and reads the program's own statistics: the time from a change of the
scene to the first picture of it, for primitives that are duplicated, each right after it was selected and while other
programs may still be made, and for one that is dragged; and the time that 95 % of the user interface's frames take at
most, meanwhile. Measure with MESA_SHADER_CACHE_DISABLE=true.
"""
import json
import random
import statistics
import sys
import tempfile
import time
from pathlib import Path

from editor_driver import Display, Editor

EDITS = 8


def primitive(name):
    kind = random.choice(["sphere", "box", "torus", "capped_cylinder", "rounded_box"])
    place = [round(random.uniform(-3, 3), 2), round(random.uniform(0, 2), 2), round(random.uniform(-3, 3), 2)]
    turn = [random.randrange(-90, 90) for _ in range(3)] if random.random() < 0.5 else [0, 0, 0]
    return {"kind": kind, "name": name, "material": random.choice("abc"), "translate": place, "rotate": turn,
            "scale": 0.4}


def scene_of(nodes):
    """Groups of a few primitives on a floor, some of them cut or blended."""
    random.seed(5)
    children, count = [{"kind": "plane", "name": "floor"}], 2
    while count < nodes:
        size = min(random.randrange(2, 9), nodes - count - 1)
        if size < 2:
            children.append(primitive(f"part {count}"))
            count += 1
            continue
        kind = random.choice(["union", "union", "union", "subtract", "intersect"])
        parts = [primitive(f"part {count + 1 + i}") for i in range(size)]
        if kind == "intersect":  # where they overlap
            for part in parts:
                part["translate"] = parts[0]["translate"]
        children.append({"kind": kind, "name": f"group {count}", "radius": random.choice([0, 0.05]), "children": parts})
        count += 1 + size
    albedo = {"a": [0.6, 0.2, 0.1], "b": [0.2, 0.4, 0.6], "c": [0.6, 0.6, 0.5]}
    return {"farfield": 1, "camera": {"position": [6, 4, 7], "target": [0, 1, 0]},
            "materials": {name: {"albedo": color} for name, color in albedo.items()},
            "lights": {"lamp": {"kind": "point", "position": [2, 6, 3], "intensity": [90, 90, 90]}},
            "root": {"kind": "union", "name": "scene", "children": children}}


def shown(times):
    most = sorted(times)[int(0.95 * len(times))]
    return f"median {statistics.median(times):.0f} ms, 95 % within {most:.0f} ms, largest {max(times):.0f} ms of {len(times)}"


def main():
    program, nodes = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
    with tempfile.TemporaryDirectory(prefix="farfield-latency-") as folder, Display() as display:
        file = Path(folder) / "scene.json"
        file.write_text(json.dumps(scene_of(nodes)))
        with Editor(display, program, file, Path(folder) / "report.json") as editor:
            editor.wait("a first picture", lambda r: r["pictures"] >= 2 and r["specialised"])
            interface = []  # from the second edit on, after a good number of frames

            def select(i):
                in_sight = [key for key in editor.report()["controls"] if key.startswith("tree/part ")]
                name = in_sight[i % len(in_sight)]
                editor.click(name)
                editor.wait("the selection", lambda r: "tree/" + r["selection"] == name)
                time.sleep(0.3 * i)  # while programs for the selected node are made, and after

            def next_picture(before):
                after = editor.wait("a picture of the edit", lambda r: r["revision"] != before["revision"]
                                    and r["edit_milliseconds"] != before["edit_milliseconds"])
                interface.append(after["ui_milliseconds"])
                return after["edit_milliseconds"]

            structure, parameter = [], []
            for i in range(EDITS):
                select(i)
                before = editor.report()
                editor.key("ctrl+d")
                structure.append(next_picture(before))
                editor.key("ctrl+z")
                editor.settled()
            del interface[:2]
            for i in range(EDITS):
                select(i)
                x, y = editor.point_at("inspector/translate/x")
                display.xdotool("mousedown", 1)
                for step in range(12):
                    before = editor.report()
                    display.xdotool("mousemove", x + 3 * step + 6, y)
                    time.sleep(0.1)
                    after = editor.report()
                    if after["edit_milliseconds"] != before["edit_milliseconds"]:
                        parameter.append(after["edit_milliseconds"])
                        interface.append(after["ui_milliseconds"])
                display.xdotool("mouseup", 1)
                editor.key("ctrl+z")
                editor.settled()
            print(f"{nodes} nodes, edit to first picture: structure {shown(structure)}; parameter {shown(parameter)}; "
                  f"95 % of the interface's frames within {max(interface):.0f} ms")
            print("structure", [round(t) for t in structure], "parameter", [round(t) for t in parameter])


if __name__ == "__main__":
    main()
