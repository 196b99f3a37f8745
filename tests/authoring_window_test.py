"""A scene from nothing to a saved file by mouse and keyboard alone, as someone would build it: a still life of a dozen
nodes with materials and two lights. Each thing done is one step; undo of all of them is the start, redo of all of them
is the saved file, byte for byte, and so is what another process opens.

Usage: authoring_window_test.py FARFIELD
"""
import json
import sys
import tempfile
import time
from pathlib import Path

from editor_driver import PATIENCE, Display, Editor, Failure, check, run_test, start


class Author:
    """Someone at the editor who checks that each thing done is one step."""

    def __init__(self, editor):
        self.editor = editor

    def one_step(self, what, action, condition=lambda report: True):
        before = self.editor.report()["step"]
        action()
        report = self.editor.wait(what, lambda r: r["step"] > before and not r["typing"] and condition(r))
        check(report["step"] == before + 1, f"{what} is one step, not {report['step'] - before}")
        check(report["error"] == "", f"{what} goes well, not: {report['error']}")

    def ctrl_click(self, control):
        self.editor.point_at(control)
        self.editor.display.xdotool("keydown", "ctrl", "sleep", 0.1, "click", 1, "sleep", 0.1, "keyup", "ctrl")

    def select(self, *names):
        for i, name in enumerate(names):
            if i == 0:
                self.editor.click(f"tree/{name}")
            else:
                self.ctrl_click(f"tree/{name}")
            self.editor.wait(f"{name} selected", lambda r: r["selected"] == list(names[:i + 1]))

    def palette(self, search, kind):
        """What A opens, by its search."""
        def add():
            self.editor.key("a")
            self.editor.wait("the list", lambda r: "add/search" in r["controls"] and r["typing"])
            self.editor.enter(search)
        self.one_step(f"{kind} added", add, lambda r: r["selection"] == kind)

    def button(self, key, kind):
        """What + Add opens, by a click."""
        def add():
            self.editor.click("tree_panel/add")
            self.editor.click(f"add/{key}")
        self.one_step(f"{kind} added", add, lambda r: r["selection"] == kind)

    def rename(self, name):
        def rename():
            self.editor.key("F2")
            self.editor.wait("a text field", lambda r: r["typing"])
            self.editor.key("ctrl+a")
            self.editor.enter(name)
        self.one_step(f"the name {name}", rename, lambda r: r["selection"] == name)

    def number(self, control, text):
        def type_it():
            self.ctrl_click(f"inspector/{control}")
            self.editor.enter(text)
        self.one_step(f"{text} typed into {control}", type_it)

    def drag_number(self, control, by):
        self.one_step(f"{control} dragged", lambda: self.editor.drag(f"inspector/{control}", by=by))

    def handle(self, tool, handle, by):
        """Drags a handle in the picture."""
        editor = self.editor
        editor.key(tool)

        def drag():
            x, y, width, height = editor.place(f"gizmo/{handle}")
            x, y = x + width // 2, y + height // 2
            editor.display.xdotool("mousemove", x, y, "sleep", 0.2, "mousedown", 1)
            for i in range(1, 11):
                editor.display.xdotool("mousemove", x + by[0] * i // 10, y + by[1] * i // 10)
                time.sleep(0.03)
            editor.display.xdotool("mouseup", 1)
        self.one_step(f"{handle} of {tool} dragged", drag)

    def drop(self, node, onto):
        """Drags a node of the tree onto another."""
        editor = self.editor

        def drag():
            _, y, _, height = editor.place(f"tree/{onto}")
            x, from_y = editor.point_at(f"tree/{node}")
            editor.display.xdotool("mousedown", 1)
            for i in range(1, 13):
                editor.display.xdotool("mousemove", x, from_y + (y + height // 2 - from_y) * i // 12)
                time.sleep(0.04)
            editor.display.xdotool("sleep", 0.2, "mouseup", 1)
        self.one_step(f"{node} dropped onto {onto}", drag)

    def wrap(self, node, kind):
        def choose():
            self.editor.point_at(f"tree/{node}")
            self.editor.display.xdotool("click", 3)
            self.editor.click("context/Wrap in")
            self.editor.click(f"wrap/{kind}")
        self.one_step(f"{node} wrapped in {kind}", choose)

    def assign(self, material):
        def choose():
            self.editor.click("inspector/material")
            self.editor.click(f"material/{material}")
        self.one_step(f"{material} assigned", choose)

    def add_object(self, button, name):
        self.one_step(button, lambda: self.editor.click(f"objects/{button}"))
        self.rename(name)


def begin(author):
    """An empty scene from the menu, in place of what was tried before."""
    editor = author.editor
    author.button("sphere", "Sphere")
    editor.click("menu/File")
    editor.click("menu/File/new")
    editor.click("unsaved/discard")
    editor.wait("an empty scene", lambda r: r["file"] == "" and r["step"] == 0 and r["saved"] and
                [c for c in r["controls"] if c.startswith("tree/")] == ["tree/scene"])
    for _ in range(2):  # a picture that comes soon
        editor.click("tools/resolution")


def build_shapes(author):
    author.palette("plane", "Plane")
    author.rename("floor")
    author.select("scene")
    author.button("box", "Box")
    author.rename("pedestal")
    for control, text in (("half_size/x", "1.2/3"), ("half_size/y", "2*0.3"), ("half_size/z", "0.4"), ("translate/y", "1-0.4")):
        author.number(control, text)
    author.wrap("pedestal", "twist")
    author.rename("column")
    author.select("scene")
    author.palette("smooth", "Union")
    author.rename("fruit")
    author.number("radius", ".05")
    author.palette("sphere", "Sphere")
    author.rename("apple")
    author.number("radius", "0.3")
    author.drag_number("radius", 12)
    author.palette("torus", "Torus")
    author.rename("rim")


def arrange(author):
    editor = author.editor
    author.select("fruit")
    author.number("translate/y", "1.2 + 0.3")
    author.select("apple")
    author.handle("w", "x", (50, 0))
    author.one_step("a second apple", lambda: editor.key("ctrl+d"), lambda r: r["selection"] == "apple 2")
    author.handle("w", "y", (0, -40))
    author.one_step("a third apple", lambda: editor.key("ctrl+d"), lambda r: r["selection"] == "apple 3")
    author.handle("w", "z", (-30, 25))
    author.select("rim")
    author.handle("e", "x", (30, 40))
    author.handle("r", "view", (25, -10))
    editor.key("w")
    # A box beside it goes into the fruit by drag and drop, two nodes into a group.
    author.select("scene")
    author.palette("rounded box", "Rounded box")
    author.drop("Rounded box", "fruit")
    author.select("scene")
    author.button("cone", "Cone")
    author.number("translate/x", "-(0.5+0.7)")
    author.button("capsule", "Capsule")
    author.number("translate/x", "1.2")
    author.select("Cone", "Capsule")
    author.one_step("a group", lambda: editor.key("ctrl+g"), lambda r: r["selected"] == ["group"])
    author.rename("things beside")
    author.one_step("moved up", lambda: editor.key("alt+Up"))


def colour_and_light(author):
    for name, values in (("stone", ("0.5", "0.48", "0.4")), ("red", ("1-0.35", "0.05", "0.04"))):
        author.add_object("add_material", name)
        for axis, text in zip("xyz", values):
            author.number(f"albedo/{axis}", text)
    for node, material in (("column", "stone"), ("floor", "stone"), ("fruit", "red")):
        author.select(node)
        author.assign(material)
    author.add_object("add_light", "lamp")
    for axis, text in zip("xyz", ("1.5", "2*1.4", "2")):
        author.number(f"position/{axis}", text)
    author.select("scene")
    author.one_step("another exposure", lambda: author.editor.drag("settings/exposure", by=25))


def save_as(editor, file):
    editor.key("ctrl+shift+s")
    editor.place("dialog/path")
    editor.wait("a text field", lambda r: r["typing"])
    editor.key("ctrl+a")
    editor.enter(str(file))
    editor.wait(f"{file.name} saved", lambda r: r["file"] == str(file) and r["saved"])
    return file.read_bytes()


def step_to(editor, key, end):
    """Presses `key` for each step, until it is the step `end`."""
    while (step := editor.report()["step"]) != end:
        editor.key(key)
        editor.wait("a step for each key", lambda r: r["step"] == step + (1 if end > step else -1))


def compare_with_file(author, folder, first):
    """Undo all is the start, redo all the file; whoever opens it has the same."""
    editor = author.editor
    steps = editor.report()["step"]
    saved = save_as(editor, folder / "still life.json")
    scene = json.loads(saved)

    def nodes(node):
        return [node] + [below for child in node.get("children", []) for below in nodes(child)]

    everything = nodes(scene["root"])[1:]
    check(len(everything) >= 12, f"a dozen nodes, not {len(everything)}")
    check(len(scene["lights"]) == 2 and {"stone", "red"} <= set(scene["materials"]), "two lights and both materials")
    named = {node["name"]: node for node in everything if "name" in node}
    check(named["pedestal"]["half_size"] == [0.4, 0.6, 0.4], f"arithmetic is done: {named['pedestal']}")
    check(named["apple"]["radius"] > 0.3 and any(named["rim"]["rotate"]) and named["rim"]["scale"] > 1, "what was dragged")
    check([named[n].get("material") for n in ("column", "floor", "fruit")] == ["stone", "stone", "red"], "materials")
    inside = [child["kind"] for child in named["fruit"]["children"]]
    check(sorted(inside) == ["rounded_box", "sphere", "sphere", "sphere", "torus"], f"what is in the fruit: {inside}")

    step_to(editor, "ctrl+z", 0)
    check(save_as(editor, folder / "undone.json") == first, "undo of all steps is the start")
    step_to(editor, "ctrl+shift+z", steps)
    check(save_as(editor, folder / "redone.json") == saved, "redo of all steps is the file")
    editor.key("ctrl+q")
    check(editor.process.wait(PATIENCE) == 0, "the editor ends with status 0")
    with Editor(editor.display, sys.argv[1], folder / "still life.json", folder / "report2.json") as other:
        start(other)
        check(save_as(other, folder / "again.json") == saved, "another process opens and saves the same")
        other.key("ctrl+q")
        check(other.process.wait(PATIENCE) == 0, "the editor ends with status 0")


def main():
    with tempfile.TemporaryDirectory(prefix="farfield-test-") as name, Display("1280x720") as display:
        folder = Path(name)
        display.environment["XDG_CONFIG_HOME"] = display.environment["XDG_CACHE_HOME"] = name
        with Editor(display, sys.argv[1], None, folder / "report.json") as editor:
            author = Author(editor)
            try:
                start(editor)
                begin(author)
                first = save_as(editor, folder / "start.json")
                build_shapes(author)
                arrange(author)
                colour_and_light(author)
                compare_with_file(author, folder, first)
            except Failure:
                display.save("authoring_window_failure.png")  # where ctest runs: the build folder
                raise
    print("all steps passed")


if __name__ == "__main__":
    run_test(main)
