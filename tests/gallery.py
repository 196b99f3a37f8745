"""Takes the screenshots of the README's gallery: pictures of the real window, in ten situations.

Usage: gallery.py FARFIELD FOLDER [NAME...]

Writes FOLDER/NAME.jpg, all or the named ones. Some minutes without a GPU: the pictures wait for their light.
"""
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from editor_driver import Display, Editor

SCENES = Path(__file__).resolve().parent.parent / "scenes"
PATIENCE = 900.0


def lit(editor, samples):
    editor.wait(f"{samples} samples", lambda r: r["samples"] >= samples and r["specialised"], PATIENCE)


def at(editor, across, down):
    """A point of the picture."""
    x, y, width, height = editor.place("viewport")
    editor.display.xdotool("mousemove", int(x + across * width), int(y + down * height))


def select(editor, name):
    editor.key("ctrl+f")
    editor.enter(name)
    editor.wait(name, lambda r: r["selection"] == name)
    editor.key("Escape")


def still_life(editor):
    editor.click("tree/fruit bowl")
    lit(editor, 16)


def code(editor):
    editor.key("F4")
    editor.wait("the code", lambda r: "code" in r)
    editor.click("tree/gyroid")
    lit(editor, 16)


def split(editor):
    editor.key("v")
    lit(editor, 8)


def measure(editor):
    editor.key("F6")
    editor.click("measure/run")
    editor.wait("a chart", lambda r: "measure/Draft" in r["controls"], PATIENCE)


def palette(editor):
    editor.click("tree/tiers")
    lit(editor, 16)
    editor.key("a")
    editor.wait("the list", lambda r: "add/search" in r["controls"])
    editor.type("cy")


def arrange(editor):
    editor.click("tree/boss")
    x, y = editor.point_at("tree/base")
    editor.display.xdotool("keydown", "ctrl", "click", 1, "keyup", "ctrl")
    lit(editor, 16)
    editor.display.xdotool("mousemove", x, y, "click", 3)


def history(editor):
    for action in (lambda: editor.click("tree/instance of bishop"), lambda: editor.key("ctrl+d"),
                   lambda: editor.drag("gizmo/z", by=-90), lambda: editor.key("ctrl+b"),
                   lambda: editor.drag("settings/exposure", across=0.55, to=0.6), lambda: editor.click("lights/lamp"),
                   lambda: editor.key("ctrl+z"), lambda: editor.key("ctrl+h")):
        action()
        time.sleep(1.5)
    lit(editor, 8)


def files(editor):
    lit(editor, 8)
    editor.key("ctrl+o")
    editor.place("dialog/path")
    time.sleep(2.0)


def lights(editor):
    editor.click("light/lamp")
    lit(editor, 16)


def steps(editor):
    editor.key("9")
    lit(editor, 4)


PICTURES = {
    "still_life": ("still_life", still_life),
    "code": ("gyroid", code),
    "split": ("colonnade", split),
    "measure": ("cornell", measure),
    "palette": ("primitives", palette),
    "arrange": ("csg_part", arrange),
    "history": ("chess", history),
    "lights": ("two_rooms", lights),
    "steps": ("gyroid", steps),
    "files": ("helix", files),  # the last, when there are small pictures of the others
}


def main():
    program, folder, names = Path(sys.argv[1]).resolve(), Path(sys.argv[2]), sys.argv[3:] or list(PICTURES)
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="farfield-gallery-") as work, Display("1440x900") as display:
        for kind in ("CONFIG", "CACHE", "STATE"):
            display.environment[f"XDG_{kind}_HOME"] = work
        (Path(work) / "farfield").mkdir()
        (Path(work) / "farfield" / "editor.json").write_text('{"window": {"size": [1440, 900]}, "statistics": false}')
        shutil.copytree(SCENES, Path(work) / "scenes")
        for name in names:
            scene, pose = PICTURES[name]
            start = time.monotonic()
            with Editor(display, program, Path(work) / "scenes" / f"{scene}.json", Path(work) / f"{name}.report.json") as editor:
                editor.wait("a picture", lambda r: r["pictures"] >= 2)
                windows = display.xdotool("search", "--onlyvisible", "--name", "Farfield").split()
                display.xdotool("windowfocus", windows[0])
                pose(editor)
                time.sleep(1.0)
                display.save(str(Path(work) / "screen.png"))
            subprocess.run(["convert", Path(work) / "screen.png", "-quality", "88", folder / f"{name}.jpg"], check=True)
            print(f"{name}: {time.monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
