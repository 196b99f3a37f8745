"""Drives the editor's real window by mouse and keyboard on a virtual display.

Usage: editor_window_test.py FARFIELD SCENE
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from editor_driver import PATIENCE, Display, Editor, Failure, check, check_seen, run_test, start


def read_code(editor, program, scene):
    """The code panel shows what `farfield glsl` prints, and selects as the tree does."""
    text = subprocess.run([program, "glsl", str(scene)], check=True, capture_output=True, text=True).stdout.splitlines()

    def first_line_of(name):
        return next(i for i, line in enumerate(text, 1) if line.endswith("// " + name))

    editor.click("menu/View")
    editor.click("menu/View/code")
    report = editor.wait(f"a code of {len(text)} lines", lambda r: "code" in r and r["code"]["lines"] == len(text))
    check(len(report["code"]["inside"]) > 20, "the whole scene is in what is selected first")
    editor.click("tree/short block")
    report = editor.wait("marked lines", lambda r: r["selection"] == "short block" and r["code"]["selected"])
    lines = report["code"]["selected"]
    check(lines[0] == first_line_of("short block"), f"marked are the lines of the short block, not {lines}")
    check(not report["code"]["inside"], "a shape has nothing in it")
    editor.wait("its line in sight", lambda r: f"code/line/{lines[0]}" in r["controls"])
    editor.click(f"code/line/{first_line_of('tall block')}")
    editor.wait("the line's node", lambda r: r["selection"] == "tall block")
    editor.wait("its lines", lambda r: r["code"]["selected"][:1] == [first_line_of("tall block")])

    # What is copied can be pasted: a word of the code becomes a name.
    line = first_line_of("short block")
    editor.click("code/live")
    editor.wait("the other text", lambda r: r["code"]["lines"] != len(text))
    editor.click("code/literals")
    editor.wait("the first text", lambda r: r["code"]["lines"] == len(text))
    editor.wait("its line", lambda r: f"code/line/{line}" in r["controls"])
    editor.point_at(f"code/line/{line}", across=0.25)
    editor.display.xdotool("click", "--repeat", 2, "--delay", 40, 1)
    editor.key("ctrl+c")
    editor.click("inspector/name")
    editor.wait("a text field", lambda r: r["typing"])
    editor.key("ctrl+a", "ctrl+v", "Return")
    report = editor.wait("another name", lambda r: not r["saved"])
    check(report["selection"] in re.findall(r"\w+", text[line - 1]), f"a word of the line: {report['selection']}")
    editor.key("ctrl+z")
    editor.wait("the old name", lambda r: r["saved"])
    editor.key("F4")
    editor.wait("no code", lambda r: "code" not in r)


def click_shapes(editor):
    """A click selects what is seen there, another one the group around it."""
    editor.click("tree/short block")
    editor.wait("the short block", lambda r: r["selection"] == "short block")
    editor.click("viewport")
    editor.wait("what is in the middle", lambda r: r["selection"] in ("back wall", "tall block"))
    editor.click("viewport")
    editor.wait("the scene around it", lambda r: r["selection"] == "scene")


def frame(editor):
    """F and Home bring the selection and everything into the picture; each is one step of undo."""
    editor.click("tree/short block")
    report = editor.wait("the block", lambda r: r["selection"] == "short block")
    first = report["revision"]
    for keys in ("f", "Home", "shift+f"):

        def press():
            before = editor.report()["revision"]
            editor.key(keys)
            editor.wait(f"the camera moves by {keys}", lambda r: r["revision"] > before)
            editor.settled()

        check_seen(editor, press, f"what {keys} frames")
        editor.key("ctrl+z")
        editor.wait(f"{keys} taken back", lambda r: r["revision"] == first)
    editor.key("f")
    moved = editor.wait("the camera moves", lambda r: r["revision"] > first)["revision"]
    editor.key("shift+Home")
    editor.wait("the camera is back", lambda r: r["revision"] > moved)
    editor.key("ctrl+z", "ctrl+z")
    report = editor.wait("all taken back", lambda r: r["saved"])
    check(report["revision"] == first, "framing leaves one step each")


def search_kinds(editor):
    """The list of kinds has the keyboard at once; Enter takes the first that is found, arrows another."""
    editor.click("tree/scene")
    editor.wait("the union is selected", lambda r: r["selection"] == "scene")
    for open_key, typed, extra, name in (("a", "tor", (), "Torus"), ("shift+a", "round sub", (), "Round subtract"),
                                         ("a", "capped", ("Down",), "Capped cone")):
        editor.key(open_key)
        editor.wait("the list", lambda r: "add/search" in r["controls"] and r["typing"])
        editor.type(typed)
        editor.wait("what is found", lambda r: "add/sphere" not in r["controls"])
        editor.key(*extra, "Return")
        editor.wait(f"the {name}", lambda r: r["selection"] == name and not r["saved"])
        editor.key("ctrl+z")
        editor.wait("it is gone", lambda r: r["saved"])
        editor.click("tree/scene")
        editor.wait("the union is selected", lambda r: r["selection"] == "scene")
    editor.key("a")
    editor.type("zzz")
    editor.key("Return", "Escape")
    report = editor.wait("no list", lambda r: "add/search" not in r["controls"])
    check(report["saved"], "what is not found adds nothing")


def audit(editor):
    """An audit runs while the picture goes on, and a node that never shows is marked."""
    editor.click("tree/tall block")
    editor.wait("the block", lambda r: r["selection"] == "tall block")
    editor.point_at("inspector/scale")
    editor.display.xdotool("click", "--repeat", 10, "--delay", 40, 5)  # what is below comes into sight
    editor.click("inspector/audit")
    editor.wait("a slope", lambda r: "inspector/slope" in r["controls"])
    editor.click("tree/scene")
    editor.click("tree_panel/add")
    editor.click("add/mirror")
    editor.wait("a mark", lambda r: "tree_warning/Mirror" in r["controls"])
    editor.key("ctrl+z")
    editor.wait("no mark", lambda r: r["saved"] and "tree_warning/Mirror" not in r["controls"])


def measure(editor):
    """The chart of the view grows while it is measured; a click on a point is an edit of the settings."""
    editor.key("F6")
    editor.click("measure/run")
    editor.wait("the first points", lambda r: "measure/point/2" in r["controls"])
    editor.click("measure/run")
    report = editor.wait("it has stopped", lambda r: "measure/Draft" in r["controls"])
    first = report["revision"]
    editor.click("measure/point/0")
    editor.wait("other settings", lambda r: r["revision"] > first)
    editor.key("ctrl+z")
    editor.wait("the old settings", lambda r: r["revision"] == first)
    editor.key("F6")
    editor.wait("no chart", lambda r: "measure/run" not in r["controls"])
    editor.settled()


def type_without_traces(editor):
    """Opening a number's text changes nothing, Escape leaves no step, and what is typed is one step."""
    editor.click("tree/short block")
    editor.wait("the block", lambda r: r["selection"] == "short block")
    for control in ("inspector/scale", "settings/exposure"):
        before = editor.report()["revision"]
        editor.click(control, times=2)
        editor.type("1.25")
        editor.key("Escape")
        report = editor.wait("no text", lambda r: not r["typing"])
        check(report["revision"] == before, f"Escape leaves {control} as it was")
        editor.click(control, times=2)
        editor.enter("1.25")
        editor.wait("the number", lambda r: not r["typing"] and r["revision"] > before)
        editor.key("ctrl+z")
        report = editor.wait("undo", lambda r: r["saved"])
        check(report["revision"] == before, f"what is typed into {control} is one step of undo")


def add_sphere_under_union(editor):
    editor.click("tree/scene")
    editor.wait("the union is selected", lambda r: r["selection"] == "scene")
    compiles = editor.report()["structural_compiles"]
    editor.click("tree_panel/add")
    editor.click("add/sphere")
    editor.wait("the sphere is there and selected", lambda r: r["selection"] == "Sphere" and not r["saved"])
    editor.wait("its program", lambda r: r["structural_compiles"] > compiles)
    report = editor.settled()
    check(report["structural_compiles"] == compiles + 1, "one added node is one structural compile")


def type_values(editor):
    """Into the open, where the camera sees it."""

    def type_all():
        for control, text in (("radius", "0.7"), ("translate/y", "1.5"), ("translate/z", "2.5")):
            revision = editor.report()["revision"]
            editor.click("inspector/" + control, times=2)
            editor.enter(text)
            editor.wait(f"the typed {control}", lambda r: r["revision"] > revision and not r["typing"])
        editor.settled()

    check_seen(editor, type_all, "the sphere")


def drag_radius(editor):
    report = editor.settled()
    compiles, revision = report["structural_compiles"], report["revision"]

    def drag():
        editor.drag("inspector/radius", by=60)
        editor.wait("a larger radius", lambda r: r["revision"] > revision)
        editor.settled()

    check_seen(editor, drag, "the larger sphere")
    report = editor.report()
    check(report["structural_compiles"] == compiles, "a dragged parameter compiles nothing")
    dragged = report["revision"]
    editor.key("ctrl+z")
    editor.wait("undo", lambda r: r["revision"] < dragged)
    check(editor.report()["revision"] == revision, "one drag is one step of undo")
    editor.key("ctrl+shift+z")
    editor.wait("redo", lambda r: r["revision"] == dragged)
    editor.settled()


def move_slider(editor, name, to, keeps_samples):
    # With a few samples accumulated, a reset would be seen.
    editor.wait("some samples", lambda r: r["frames"] >= 4)
    report = editor.report()
    revision, compiles = report["revision"], report["structural_compiles"]
    editor.seen.clear()
    editor.drag(f"settings/{name}", to=to)
    editor.wait(f"a new {name}", lambda r: r["revision"] > revision)
    report = editor.settled()
    if keeps_samples:
        check(editor.seen == sorted(editor.seen), f"{name} keeps the accumulated samples, which went {editor.seen}")
        samples = report["samples"]
        editor.wait("more samples", lambda r: r["samples"] > samples)
    check(report["structural_compiles"] == compiles, f"{name} compiles nothing")


def save(editor, scene, original):
    editor.key("ctrl+s")
    editor.wait("saved", lambda r: r["saved"])
    saved = json.loads(scene.read_text())
    sphere = [node for node in saved["root"]["children"] if node["kind"] == "sphere"]
    check(len(sphere) == 1, "the saved file has the sphere")
    check(sphere[0].get("radius", 0) > 0.7, f"the saved sphere has the dragged radius, not {sphere[0]}")
    for name in ("samples", "blur_levels", "ao_radius"):
        old, new = original.get("settings", {}).get(name), saved["settings"].get(name)
        check(new is not None and new != old, f"the saved {name} is a new one: {old} and {new}")


def reload(editor, scene, copy):
    """Opens the saved file through menu and dialog, saves it elsewhere, and finds the same bytes."""
    editor.click("tree_panel/add")
    editor.click("add/box")
    changed = editor.wait("an unsaved change", lambda r: not r["saved"])["revision"]
    editor.click("menu/File")
    editor.click("menu/File/open")
    editor.click("unsaved/discard")
    editor.place("dialog/path")
    editor.enter(str(scene))
    report = editor.wait("the file is open again", lambda r: r["saved"] and r["revision"] > changed)
    check(report["selection"] == "scene" and report["error"] == "", "an opened file begins afresh")
    editor.key("ctrl+shift+s")
    editor.place("dialog/path")
    editor.wait("a text field", lambda r: r["typing"])
    editor.key("ctrl+a")
    editor.type(str(copy))
    editor.click("dialog/ok")
    editor.wait("saved elsewhere", lambda r: r["file"] == str(copy))
    check(copy.read_bytes() == scene.read_bytes(), "a file that was opened and saved is the same file")


def define_and_free(editor):
    editor.click("tree/Sphere")
    editor.wait("the sphere is selected", lambda r: r["selection"] == "Sphere")
    editor.key("ctrl+i")
    report = editor.wait("an instance is selected", lambda r: r["selection"] == "instance of Sphere")
    editor.place("tree/Sphere")  # below, among the definitions
    editor.click("inspector/go_to_definition")
    editor.wait("the definition is selected", lambda r: r["selection"] == "Sphere")
    editor.click("tree_panel/add")
    editor.click("add/Instance of Sphere")
    editor.wait("a second instance", lambda r: r["selection"] == "instance of Sphere" and r["revision"] > report["revision"])
    editor.key("ctrl+shift+i")
    report = editor.wait("a copy", lambda r: r["selection"] == "Sphere 2")
    check(report["error"] == "", f"no error, not: {report['error']}")
    editor.key("ctrl+s")
    editor.wait("saved", lambda r: r["saved"])


def show_error(editor, bad):
    bad.write_text('{"farfield": 1, "root": {"kind": "union", "children": [{"kind": "sphere", "radius": -1}]}}')
    before = editor.report()
    editor.key("ctrl+o")
    editor.place("dialog/path")
    editor.enter(str(bad))
    report = editor.wait("an error message", lambda r: "radius" in r["error"])
    check(report["file"] == before["file"] and report["revision"] == before["revision"], "the last good scene stays")
    editor.click("message/dismiss")
    editor.wait("no message", lambda r: r["error"] == "")


def custom_code(editor, foreign, trusted):
    """Code from elsewhere is asked about and can wait; code that is written here shows its errors, its shape and values."""
    foreign.write_text(json.dumps({"farfield": 1, "sky": {"zenith": [1, 1, 1]}, "root": {"kind": "union", "children": [
        {"kind": "custom", "name": "blob", "code": ["float sdf(vec3 p) {", "    return length(p) - 0.75;", "}"]}]}}))

    def open_foreign():
        editor.wait("no dialog", lambda r: "foreign/cancel" not in r["controls"])
        editor.key("ctrl+o")
        editor.place("dialog/path")
        editor.enter(str(foreign))
        editor.place("foreign/cancel")

    before = editor.report()
    open_foreign()
    editor.click("foreign/cancel")
    report = editor.wait("no dialog", lambda r: "foreign/cancel" not in r["controls"])
    check(report["file"] == before["file"] and report["revision"] == before["revision"], "Cancel leaves the scene")
    open_foreign()
    editor.click("foreign/without")
    editor.wait("the file", lambda r: r["file"] == str(foreign))
    editor.settled()
    editor.click("tree/blob")
    editor.place("inspector/run_code")
    check(not trusted.exists(), "nothing was accepted so far")
    compiles = editor.report()["structural_compiles"]

    def run():
        editor.click("inspector/run_code")
        editor.wait("its program", lambda r: r["structural_compiles"] > compiles)
        editor.settled()

    check_seen(editor, run, "the shape of the code")
    check("inspector/run_code" not in editor.report()["controls"], "what runs needs no button")
    check(len(trusted.read_text().split()) == 1, "what was accepted is remembered")

    editor.click("inspector/edit_code")
    revision = editor.report()["revision"]

    def write(code):
        editor.click("code_editor/text")
        editor.wait("a text field", lambda r: r["typing"])
        editor.key("ctrl+a")
        editor.type(code)

    write("float sdf(vec3 p) { return radus; }")
    editor.place("code_editor/error/1")
    editor.key("ctrl+Return")
    editor.settled()
    check(editor.report()["revision"] == revision, "code with errors changes nothing")
    write("uniform float size = 0.4; /* [0, 1] m */ float sdf(vec3 p) { return length(p) - size; }")
    editor.wait("no error", lambda r: "code_editor/error/1" not in r["controls"])
    editor.key("ctrl+Return")
    changed = editor.wait("new code", lambda r: r["revision"] > revision and "inspector/size" in r["controls"])
    check(changed["typing"], "one can go on writing")
    editor.key("Escape")
    editor.wait("no text", lambda r: not r["typing"])
    check(len(trusted.read_text().split()) == 2, "what was written here is remembered")
    editor.drag("inspector/size", to=0.9)
    editor.wait("a dragged value", lambda r: r["revision"] > changed["revision"])
    editor.key("ctrl+z", "ctrl+z")
    editor.wait("the old code", lambda r: r["saved"] and "inspector/size" not in r["controls"])
    editor.key("F4")
    editor.wait("no code", lambda r: "code" not in r)


def main():
    program, bundled = sys.argv[1], Path(sys.argv[2])
    with tempfile.TemporaryDirectory(prefix="farfield-test-") as folder, Display() as display:
        display.environment["XDG_CONFIG_HOME"] = display.environment["XDG_CACHE_HOME"] = folder
        scene = Path(folder) / "scene.json"
        shutil.copyfile(bundled, scene)
        original = json.loads(scene.read_text())
        with Editor(display, program, scene, Path(folder) / "report.json") as editor:
            steps = [
                lambda: start(editor),
                lambda: read_code(editor, program, scene),
                lambda: click_shapes(editor),
                lambda: frame(editor),
                lambda: search_kinds(editor),
                lambda: audit(editor),
                lambda: measure(editor),
                lambda: type_without_traces(editor),
                lambda: add_sphere_under_union(editor),
                lambda: type_values(editor),
                lambda: drag_radius(editor),
                lambda: move_slider(editor, "samples", 0.1, keeps_samples=False),
                lambda: move_slider(editor, "blur_levels", 0.9, keeps_samples=True),
                lambda: move_slider(editor, "ao_radius", 0.4, keeps_samples=True),
                lambda: save(editor, scene, original),
                lambda: reload(editor, scene, Path(folder) / "copy.json"),
                lambda: define_and_free(editor),
                lambda: show_error(editor, Path(folder) / "bad.json"),
                lambda: custom_code(editor, Path(folder) / "foreign.json", Path(folder) / "farfield" / "trusted"),
            ]
            names = ["start", "read the code", "click shapes", "frame", "search kinds", "audit", "measure", "type without traces", "add a sphere under a union", "type values", "drag a radius", "sample count",
                     "blur levels", "AO radius", "save", "reload", "define and free", "an error in a file", "custom code"]
            for name, step in zip(names, steps):
                print(f"{name} ...", flush=True)
                try:
                    step()
                except Failure:
                    display.save("editor_window_failure.png")  # where ctest runs: the build folder
                    raise
            editor.key("ctrl+q")
            check(editor.process.wait(PATIENCE) == 0, "the editor ends with status 0")
    print("all steps passed")


if __name__ == "__main__":
    run_test(main)
