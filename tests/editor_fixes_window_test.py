"""Warnings in the editor and what mends them, by mouse and keyboard on a virtual display.

Usage: editor_fixes_window_test.py FARFIELD
"""
import json
import sys
import tempfile
from pathlib import Path

from editor_driver import Display, Editor, check, run_test

SCENE = {
    "farfield": 1,
    "lights": {"lamp": {"kind": "point", "position": [2, 3, 2], "intensity": [20, 20, 20]}},
    "camera": {"position": [0, 1, 4], "target": [0, 0, 0]},
    "root": {"kind": "union", "name": "scene", "children": [
        {"kind": "plane", "translate": [0, -1, 0]},
        {"kind": "shell", "name": "skin", "thickness": 0.00001, "children": [{"kind": "sphere"}]}]},
}


def thickness(editor, file):
    editor.key("ctrl+s")
    editor.wait("it is saved", lambda r: r["saved"])
    skin = json.loads(file.read_text())["root"]["children"][1]
    return skin["thickness"]


def main():
    with tempfile.TemporaryDirectory(prefix="farfield-test-") as folder, Display() as display:
        file = Path(folder) / "skin.json"
        file.write_text(json.dumps(SCENE))
        with Editor(display, sys.argv[1], file, Path(folder) / "report.json") as editor:
            try:
                editor.wait("a mark", lambda r: "tree_warning/skin" in r["controls"])
                editor.click("tree/skin")
                editor.wait("the skin", lambda r: r["selection"] == "skin")
                editor.point_at("inspector/scale")
                editor.display.xdotool("click", "--repeat", 10, "--delay", 40, 5)
                editor.wait("what is below", lambda r: "inspector/delete" in r["controls"])
                editor.settled()
                # Too thin for rays; when that is mended, too thin for pixels.
                for step in (1, 2):
                    editor.click("inspector/fix")
                    editor.wait("one step", lambda r: r["step"] == step)
                editor.wait("no mark", lambda r: "tree_warning/skin" not in r["controls"])
                check(0.002 < thickness(editor, file) < 0.02, "the skin is as thick as a pixel")
                editor.key("ctrl+z", "ctrl+z")
                editor.wait("the mark again", lambda r: "tree_warning/skin" in r["controls"] and r["step"] == 0)
            except Exception:
                display.save("editor_fixes_window_failure.png")
                raise


if __name__ == "__main__":
    run_test(main)
